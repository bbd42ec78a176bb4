"""Pictures as files in a folder."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from articad.errors import ArticadError, did_you_mean
from articad.render.camera import VIEWS
from articad.render.pictures import Renderer, filmstrip, motion_gif, png, render_motion, render_views

if TYPE_CHECKING:
    from articad.assembly import Assembly

_STRIP_FRAMES = 8
_ANIMATION_FRAMES = 24


def write_views(
    assembly: Assembly,
    views: Sequence[str],
    folder: Path,
    *,
    size: int = 512,
    only: Sequence[str] | None = None,
    section: str | None = None,
    explode: float = 0.0,
    renderer: Renderer = "embree",
    show_overlaps: bool = False,
) -> list[Path]:
    """Write `<view>.png` for each view.

    Raises:
        ArticadError: If there is no such view, part or section.
    """
    _require_known("view", views, VIEWS)
    _require_known("part", only or (), assembly.parts)
    try:
        pictures = render_views(
            assembly, views, size=size, only=only, section=section, explode=explode, renderer=renderer, show_overlaps=show_overlaps
        )
    except ValueError as error:
        raise ArticadError(str(error), stage="render") from error
    return [_written(folder / f"{view}.png", png(image)) for view, image in pictures.items()]


def write_motion(assembly: Assembly, joint: str, folder: Path, *, size: int = 320) -> list[Path]:
    """Write `<joint>.png`, a filmstrip, and `<joint>.gif`, an animation.

    Raises:
        UnknownJointError: If the joint does not drive anything.
    """
    strip = filmstrip(render_motion(assembly, joint, frames=_STRIP_FRAMES, size=size))
    animation = motion_gif(render_motion(assembly, joint, frames=_ANIMATION_FRAMES, size=size))
    return [_written(folder / f"{joint}.png", png(strip)), _written(folder / f"{joint}.gif", animation)]


def _require_known(kind: str, names: Sequence[str], known: Iterable[str]) -> None:
    listed = list(known)
    for name in names:
        if name not in listed:
            raise ArticadError(f"No {kind} {name!r}.{did_you_mean(name, listed)} There are {', '.join(listed)}.", stage="render")


def _written(path: Path, content: bytes) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content)
    return path
