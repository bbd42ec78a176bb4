"""Pictures for models: a part, the result of a failed script, an assembly, its motion, and the place of a fault.

Each is drawn when its bytes are needed, and enters a request's key by its recipe: a replay draws nothing.
"""

from __future__ import annotations

import io
import threading
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from articad.agents.llm import Image
from articad.arrays import FloatArray
from articad.assembly import Assembly
from articad.connectors.se3 import SE3
from articad.findings import Finding
from articad.geometry.part import Part
from articad.interference.freedoms import driver_values, freedoms
from articad.kernels.results import PoisonedError, read_mesh
from articad.runs.run import digest

if TYPE_CHECKING:
    from PIL.Image import Image as Picture

VIEWS: Final = ("iso", "front", "right", "top")
PART_VIEWS: Final = (*VIEWS, "iso_back_left", "iso_below_left")  # hollows, bores and lugs may be on any side
SIZE: Final = 320  # pixels of each view: a feature of a hundredth of the part is still visible
ASSEMBLY_SIZE: Final = 448  # pixels of each view of the whole: the names of parts must be legible
KEYFRAMES: Final = 6  # for each coordinate of a joint
_COLOR = "#c8a46e"
_MESH = "part.npz"
_RECIPE = "articad.picture/4"  # of `articad.render`, which is loaded only where something is drawn; a test compares the two
_SHOT: Final = "seen/1"  # how the view of a motion is chosen
_drawing = threading.Lock()  # one picture at a time: several would only compete for the processor


def partial_picture(folder: Path | None, name: str, build: str) -> Image | None:
    """Draw the solids that a failed script had made, from six sides.

    Args:
        folder: Where the kernel left them; None if there were none.
        name: The part.
        build: Digest of the build that failed; with the views it is the picture's recipe.

    Returns:
        One sheet, or None if there is nothing to draw.
    """
    if folder is None:
        return None
    try:
        mesh = read_mesh((folder / _MESH).read_bytes())
    except (OSError, PoisonedError):
        return None

    def draw() -> list[Picture]:
        from articad.render import Camera, DrawnMesh, DrawnScene, picture  # noqa: PLC0415 - pictures are drawn when something failed, and not before

        scene = DrawnScene((DrawnMesh(name, mesh, SE3.identity(), _COLOR),))
        return [picture(scene, Camera.fit(view, scene.bounds, width=SIZE, height=SIZE), labels=False, title=view) for view in PART_VIEWS]

    return _sheet(draw, 3, {"of": "partial", "build": build, "views": list(PART_VIEWS), "size": SIZE})


def part_picture(part: Part, build: str) -> Image:
    """Draw a part in its own frame, from six sides; `build` is the digest of its build."""

    def draw() -> list[Picture]:
        from articad.render import render_part  # noqa: PLC0415 - as above

        return list(render_part(part, PART_VIEWS, size=SIZE).values())

    return _sheet(draw, 3, {"of": "part", "build": build, "views": list(PART_VIEWS), "size": SIZE})


def assembly_picture(assembly: Assembly, *, only: Sequence[str] = ()) -> Image:
    """Draw an assembly at rest from four sides, with the names of its parts and the axes of its joints; all parts but `only` of glass."""

    def draw() -> list[Picture]:
        shown = tuple(only) or None
        return list(
            assembly.render(VIEWS, size=ASSEMBLY_SIZE, labels="aside", only=shown, glass=bool(only)).values()
        )  # names would hide parts

    recipe = {"of": "assembly", "assembly": assembly_mark(assembly), "views": list(VIEWS), "size": ASSEMBLY_SIZE}
    return _sheet(draw, 2, recipe | ({"through": list(only)} if only else {}))


def motion_picture(assembly: Assembly, joint: str, *, near: bool = False) -> Image:
    """Draw the keyframes of a joint's motion, each with the joint's value; `near` as in `render_motion`."""

    def draw() -> list[Picture]:
        from articad.render import render_motion  # noqa: PLC0415 - as above

        return render_motion(assembly, joint, frames=KEYFRAMES, size=SIZE, near=near)

    recipe = {"of": "motion", "assembly": assembly_mark(assembly), "joint": joint, "frames": KEYFRAMES, "size": SIZE, "shot": _SHOT}
    return _sheet(draw, 3, recipe | ({"near": True} if near else {}))


def offence_picture(assembly: Assembly, finding: Finding) -> Image | None:
    """Draw the place of a finding in its pose: its parts in full, the others faded, their common volume in red."""
    parts = [name for name in finding.parts if name in assembly.parts]
    if not parts:
        return None
    pose = {name: float(f"{value:.6g}") for name, value in (finding.pose or {}).items()}

    def draw() -> list[Picture]:
        q = configuration_at(assembly, pose)
        return list(assembly.render(("iso", "front"), q=q, only=parts, show_overlaps=len(parts) > 1, size=ASSEMBLY_SIZE).values())

    recipe = {"of": "offence", "assembly": assembly_mark(assembly), "parts": parts, "pose": pose, "size": ASSEMBLY_SIZE}
    return _sheet(draw, 2, recipe)


def assembly_mark(assembly: Assembly) -> str:
    """Return the digest of a plan and of everything built from it."""
    builds = {name: dict(realised.digests) or realised.derived_from for name, realised in assembly.realised.items()}
    if assembly.plan is not None:
        return digest({"plan": assembly.plan.dumps(), "parts": builds})
    # Read from a file: identified by its shapes, their poses at rest, and its joints.
    shapes = {name: [shape.digest for shape in part.visuals or part.collisions] for name, part in assembly.parts.items()}
    rest = assembly.poses(assembly.mechanism.rest).data.round(6).tolist()
    return digest({"shapes": shapes, "rest": rest, "joints": [f"{joint.name} {joint.type} {joint.limits}" for joint in assembly.joints]})


def configuration_at(assembly: Assembly, pose: Mapping[str, float]) -> FloatArray:
    """Return `q`, `(nq,)`, with the drivers that a finding's pose names at these values, the others at rest."""
    q = np.array(assembly.mechanism.rest, dtype=np.float64)
    columns = {driver.name: index for index, driver in enumerate(assembly.drivers)}
    for joint in assembly.joints:
        own = freedoms(joint)
        if not any(freedom.name in pose for freedom in own):
            continue
        values = driver_values(joint, [pose.get(freedom.name, freedom.rest) for freedom in own])
        for name, value in zip(joint.column_names, values, strict=True):
            if name in columns:
                q[columns[name]] = value
    return q


def _sheet(draw: Callable[[], Sequence[Picture]], columns: int, recipe: Mapping[str, Any]) -> Image:
    """Return several pictures as one."""

    def content() -> bytes:
        from articad.render import contact_sheet  # noqa: PLC0415 - as above

        with _drawing:
            stream = io.BytesIO()
            contact_sheet(draw(), columns).save(stream, "PNG")
        return stream.getvalue()

    return Image(content, recipe={"recipe": _RECIPE} | dict(recipe))
