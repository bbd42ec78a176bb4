"""Pictures as files in a folder."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, TypedDict

from articad.errors import ArticadError, did_you_mean
from articad.export.names import file_names
from articad.processes import scratch
from articad.render.camera import VIEWS
from articad.render.pictures import Renderer, clean_motion, filmstrip, motion_gif, png, render_clean, render_motion, render_views

if TYPE_CHECKING:
    from articad.assembly import Assembly


class PictureOptions(TypedDict):
    """Options that labelled and clean pictures share."""

    only: Sequence[str] | None
    section: str | None
    explode: float
    show_overlaps: bool


_STRIP_FRAMES = 8
_ANIMATION_FRAMES = 24


def write_views(
    assembly: Assembly,
    views: Sequence[str],
    folder: Path,
    *,
    size: int | tuple[int, int] = 512,
    only: Sequence[str] | None = None,
    section: str | None = None,
    explode: float = 0.0,
    renderer: Renderer = "embree",
    show_overlaps: bool = False,
    clean: bool = False,
    transparent: bool = False,
) -> list[Path]:
    """Write `<view>.png` for each view; `clean` and `transparent` as in `render_clean`, `size` then may be a width and a height.

    Raises:
        ArticadError: If there is no such view, part or section.
    """
    _require_known("view", views, VIEWS)
    _require_known("part", only or (), assembly.parts)
    try:
        width, height = (size, size) if isinstance(size, int) else size
        options: PictureOptions = {"only": only, "section": section, "explode": explode, "show_overlaps": show_overlaps}
        if clean:
            pictures = render_clean(assembly, views, size=(width, height), transparent=transparent, **options)
        else:
            pictures = render_views(assembly, views, size=width, renderer=renderer, **options)
    except ValueError as error:
        raise ArticadError(str(error), stage="render") from error
    return [_written(folder / f"{view}.png", png(image)) for view, image in pictures.items()]


def write_motion(assembly: Assembly, joint: str, folder: Path, *, size: int | tuple[int, int] = 320, clean: bool = False) -> list[Path]:
    """Write `<joint>.png`, a filmstrip, and `<joint>.gif`, an animation, into the folder; `clean` as in `render_clean`.

    A number follows the joint's name if its files would have the names of another joint's, or of a view's.

    Raises:
        UnknownJointError: If the joint does not drive anything.
    """
    width, height = (size, size) if isinstance(size, int) else size
    if clean:
        frames = clean_motion(assembly, joint, frames=_ANIMATION_FRAMES, size=(width, height))
        strip, animation = filmstrip(frames[:: _ANIMATION_FRAMES // _STRIP_FRAMES]), motion_gif(frames)
    else:
        strip = filmstrip(render_motion(assembly, joint, frames=_STRIP_FRAMES, size=width))
        animation = motion_gif(render_motion(assembly, joint, frames=_ANIMATION_FRAMES, size=width))
    stem = file_names(assembly.mechanism.driving_joints, VIEWS)[joint]  # a view's picture may lie in the same folder
    return [_written(folder / f"{stem}.png", png(strip)), _written(folder / f"{stem}.gif", animation)]


def _require_known(kind: str, names: Sequence[str], known: Iterable[str]) -> None:
    listed = list(known)
    for name in names:
        if name not in listed:
            raise ArticadError(f"No {kind} {name!r}.{did_you_mean(name, listed)} There are {', '.join(listed)}.", stage="render")


def _written(path: Path, content: bytes) -> Path:
    scratch.write(path, content)
    return path
