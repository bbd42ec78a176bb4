"""The pictures kept in a run: drawn in a process of their own, from light meshes, each content once.

Pictures are not results. They are drawn after every result is on disk, and a drawing process that crashes takes nothing with it.
A picture is cached under the digest of all that it shows, so that a second build of the same product draws nothing.
"""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any, Final, NamedTuple, cast

from articad.assembly import Assembly
from articad.errors import ArticadError
from articad.geometry.part import Part
from articad.kernels.choice import Sandbox
from articad.kernels.kernel import BuildCache
from articad.processes import launcher
from articad.runs.record import assembly_of
from articad.runs.run import Run, digest

_RECIPE: Final = "articad.kept/1"  # changes when the same content would be drawn differently
_PIXELS: Final = 256  # enough to recognise, quick to draw
_COARSE: Final = 0.15  # pixels between the drawn surface and the part's: no eye sees it
_SECONDS: Final = 1800.0  # for all pictures of a run
_NICE: Final = 5  # whatever the user does next goes first


class Drawing(NamedTuple):
    """One set of pictures: the digest of its content, a part or a joint, and the function that draws its files."""

    key: str
    part: str | None
    joint: str | None
    draw: Callable[[], Mapping[str, bytes]]


def record_pictures(run: Run, assembly: Assembly, *, cache: BuildCache | None = None, sandbox: Sandbox = "strict") -> str | None:
    """Save views of every part that has a script, and the motion of every driving joint.

    Args:
        run: A run with all its results, open for writing.
        assembly: The assembly of the run.
        cache: Where parts and pictures are kept; the user's own by default.
        sandbox: Isolation of part scripts, for parts that are no longer in the cache.

    Returns:
        Why some pictures are missing; None if all are there.
    """
    cache = cache or BuildCache()
    wanted = list(drawings(assembly))
    reason = None
    if any(cache.get(drawing.key) is None for drawing in wanted):
        limits = launcher.Limits(seconds=_SECONDS)
        words = [str(run.path.resolve()), str(cache.root.resolve()), sandbox]
        own = launcher.environment(*launcher.OWN)  # it reads the run with its kernel, which may be the user's FreeCAD
        ended = launcher.run(words, module="articad.runs.drawing", limits=limits, environment=own)
        reason = None if ended.code == 0 else ended.last_line
    for drawing in wanted:
        folder = cache.get(drawing.key)
        if folder is None:
            reason = reason or "the cache has lost them"
        elif drawing.part is not None:
            run.save_views(drawing.part, {file.stem: file.read_bytes() for file in sorted(folder.glob("*.png"))})
        elif drawing.joint is not None:
            run.save_motion(drawing.joint, (folder / "strip.png").read_bytes(), (folder / "motion.gif").read_bytes())
    return reason


def drawings(assembly: Assembly) -> Iterator[Drawing]:
    """Yield what is drawn of an assembly: each part that is not derived from another, then each driving joint."""
    for name, realised in assembly.realised.items():
        if realised.derived_from is None:
            part = assembly.parts[name]
            yield Drawing(digest({"recipe": _RECIPE, "name": name, "part": _look(part)}), name, None, lambda part=part: _views(part))  # type: ignore[misc]
    if not assembly.mechanism.driving_joints:
        return
    whole = _content(assembly)
    for joint in assembly.mechanism.driving_joints:
        key = digest({"recipe": _RECIPE, "assembly": whole, "joint": joint})
        yield Drawing(key, None, joint, lambda joint=joint: _motion(assembly, joint))  # type: ignore[misc]


def draw_missing(assembly: Assembly, cache: BuildCache) -> None:
    """Draw everything that the cache lacks, into the cache."""
    for drawing in drawings(assembly):
        if cache.get(drawing.key) is None:
            files = drawing.draw()
            with cache.writing(drawing.key) as folder:
                for name, content in files.items():
                    (folder / name).write_bytes(content)


def _look(part: Part) -> list[Any]:
    """Return all that a picture shows of a part."""
    return [[shape.mesh.digest, shape.frame.data.tolist(), shape.color or part.color] for shape in part.visuals or part.collisions]


def _content(assembly: Assembly) -> dict[str, Any]:
    """Return all that decides how an assembly looks and moves."""
    mechanism = assembly.mechanism
    joints = [
        [joint.name, str(joint.type), joint.parent, joint.child, str(joint.mate), joint.lead, repr(joint.limits)]
        + [frame.data.tolist() for frame in (joint.T_parent_connector, joint.T_child_connector)]
        for joint in assembly.joints
    ]
    return {
        "parts": {name: _look(part) for name, part in assembly.parts.items()},
        "joints": joints,
        "couplings": [repr(coupling) for coupling in mechanism.couplings],
        "ground": [assembly.ground, mechanism.T_ground.data.tolist()],
        "rest": [float(value) for value in mechanism.rest],
    }


def _views(part: Part) -> dict[str, bytes]:
    from articad.render import png, render_part  # noqa: PLC0415 - only the process that draws needs it

    return {f"{view}.png": png(image) for view, image in render_part(part, size=_PIXELS, coarse=_COARSE).items()}


def _motion(assembly: Assembly, joint: str) -> dict[str, bytes]:
    from articad.render import filmstrip, motion_gif, png, render_motion  # noqa: PLC0415 - as above

    frames = render_motion(assembly, joint, size=_PIXELS, supersample=1, coarse=_COARSE)
    return {"strip.png": png(filmstrip(frames)), "motion.gif": motion_gif(frames)}


def main(words: list[str]) -> int:
    """Draw the pictures of a run: RUN CACHE SANDBOX."""
    path, root, sandbox = words
    with contextlib.suppress(OSError, AttributeError):  # Windows has no nice
        os.nice(_NICE)
    cache = BuildCache(Path(root))
    try:
        draw_missing(assembly_of(Run.view(path), cache=cache, sandbox=cast("Sandbox", sandbox)), cache)
    except ArticadError as error:
        sys.stderr.write(error.message.splitlines()[0] if error.message else type(error).__name__)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
