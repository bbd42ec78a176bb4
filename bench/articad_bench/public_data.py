"""Public data sets that users provide; none of them comes with articad.

These layouts are recognised, each by its files:

- CADPrompt: a folder for each sample, with `Ground_Truth.stl` or `.obj` and `Natural_Language_Descriptions_Prompt.txt`.
- PartNet-Mobility: a folder for each object, with `mobility.urdf` and its meshes.
- ACD (of S2O): a folder for each object, with `<id>.glb` and `<id>.art-stk.json`; its Y points up, and is turned so that Z does.
- Fusion 360 Gallery, joint data: files `joint_set_….json` and the bodies' `.obj` beside them, in cm.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from articad.arrays import FloatArray
from articad.assembly import Assembly
from articad.connectors import SE3
from articad.errors import ReadError
from articad.files import PLAN_BYTES, read_file
from articad.geometry import TriMesh, merged, read_mesh
from articad.kinematics.joints import Joint, JointType
from articad_bench.metrics import MovingJoint
from articad_bench.scoring import subject_of
from articad_bench.subject import Subject
from articad_bench.task import Task, read_json

MM_PER_CM: Final = 10.0
SAME_LINE: Final = 1e-3  # by which two axes that are one may differ: of their directions, and of the bodies' size
_TRUTHS: Final = ("Ground_Truth.stl", "Ground_Truth.obj")
_PROMPT: Final = "Natural_Language_Descriptions_Prompt.txt"
_MEASURED: Final = "Natural_Language_Descriptions_Prompt_with_specific_measurements.txt"
_PICTURES: Final = (".png", ".jpg", ".jpeg", ".webp")
_UP: Final = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])  # of glTF: Y up, to Z up
_TYPES: Final[Mapping[str, str]] = {
    "rotation": "revolute",
    "revolute": "revolute",
    "hinge": "revolute",
    "continuous": "revolute",
    "translation": "slider",
    "prismatic": "slider",
    "slider": "slider",
    "RevoluteJointType": "revolute",
    "SliderJointType": "slider",
    "CylindricalJointType": "cylindrical",
    "PinSlotJointType": "pin_slot",
    "PlanarJointType": "planar",
    "BallJointType": "ball",
}


@dataclass(frozen=True)
class ShapeSample:
    """A shape that is asked for by words.

    Attributes:
        name: Of its folder.
        folder: Where it is.
        prompt: The words.
        file: The true shape.
    """

    name: str
    folder: Path
    prompt: str
    file: Path

    def truth(self) -> TriMesh:
        """Return the true shape, in the data's own unit."""
        return read_mesh(self.file)

    def task(self) -> Task:
        """Return the task of making it: one part, whatever it is."""
        checks = [{"kind": "parts", "number": [1, 1]}]
        return Task.model_validate({"name": self.name, "kind": "static", "product": "shape", "prompt": self.prompt, "checks": checks})


@dataclass(frozen=True, eq=False)
class TrueObject:
    """An articulated object as a data set states it: its surface at rest, and its moving joints."""

    mesh: TriMesh
    joints: tuple[MovingJoint, ...]


@dataclass(frozen=True)
class ObjectSample:
    """An articulated object that is asked for by pictures.

    Attributes:
        name: Of its folder or file.
        folder: Where it is.
        images: Pictures of it.
        truth: Reads it.
    """

    name: str
    folder: Path
    images: tuple[str, ...]
    truth: Callable[[], TrueObject]

    def task(self) -> Task:
        """Return the task of making it from its first picture."""
        if not self.images:
            raise _refused(self.folder, f"{self.name} has no picture to make it from: put a .png or .jpg in its folder.")
        checks = [{"kind": "parts", "number": [1, 999]}]
        row = {"name": self.name, "kind": "articulated", "product": "object", "images": self.images[:1], "checks": checks}
        return Task.model_validate(row)


def shapes_in(folder: str | Path, *, measured: bool = False) -> list[ShapeSample]:
    """Return the samples of a copy of CADPrompt.

    Args:
        folder: Where it is.
        measured: Take the prompts that state measurements.

    Raises:
        ReadError: If there are none.
    """
    found = []
    for place in sorted(path for path in Path(folder).iterdir() if path.is_dir()) if Path(folder).is_dir() else ():
        files = [place / name for name in _TRUTHS if (place / name).is_file()]
        words = place / (_MEASURED if measured else _PROMPT)
        if files and words.is_file():
            found.append(
                ShapeSample(place.name, place, read_file(words, PLAN_BYTES, root=place).decode(errors="replace").strip(), files[0])
            )
    if not found:
        raise _refused(Path(folder), f"It holds no sample of CADPrompt, which is a folder with {_TRUTHS[0]} and {_PROMPT}.")
    return found


def objects_in(folder: str | Path) -> list[ObjectSample]:
    """Return the objects of a copy of PartNet-Mobility, of ACD, or of the joints of the Fusion 360 Gallery.

    Raises:
        ReadError: If there are none.
    """
    root = Path(folder)
    found = [ObjectSample(file.stem, root, _beside(file), _reading(_fusion, file)) for file in sorted(root.glob("joint_set_*.json"))]
    for place in sorted(path for path in root.iterdir() if path.is_dir()) if root.is_dir() else ():
        urdf, stk = place / "mobility.urdf", place / f"{place.name}.art-stk.json"
        images = tuple(sorted(file.name for file in place.iterdir() if file.suffix.lower() in _PICTURES))
        if urdf.is_file():
            found.append(ObjectSample(place.name, place, images, _reading(_mobility, urdf)))
        elif stk.is_file():
            found.append(ObjectSample(place.name, place, images, _reading(_acd, stk)))
    if not found:
        message = (
            "It holds no object: a folder with mobility.urdf, a folder with <id>.glb and <id>.art-stk.json, or a file joint_set_….json."
        )
        raise _refused(root, message)
    return found


def object_of(assembly: Assembly) -> TrueObject:
    """Return an assembly in the form of a data set's object: each joint moves its side away from the ground, and all that hangs from it.

    Raises:
        ReadError: If no part has a shape.
    """
    subject = Subject(assembly)
    if not subject.shaped:
        message = "No part of it has a shape."
        raise ReadError(f"{assembly.name}: {message} Look for its meshes.", path=assembly.name)
    placed = {name: part.mesh.transformed(subject.rest[name]) for name, part in assembly.parts.items() if part.mesh is not None}
    joints = [_moving(subject, joint, placed) for joint in assembly.joints if joint.type is not JointType.FIXED]
    return TrueObject(merged(list(placed.values())), tuple(joint for joint in joints if joint is not None))


def _moving(subject: Subject, joint: Joint, placed: Mapping[str, TriMesh]) -> MovingJoint | None:
    """Return a joint in the form of a data set; None where it moves nothing that has a shape."""
    below = {joint.child}
    while more := {other.child for other in subject.assembly.joints if other.parent in below} - below - {subject.assembly.ground}:
        below |= more
    ends = [placed[name].bounds for name in below if name in placed]
    if not ends:
        return None
    center = (np.min([low for low, _ in ends], axis=0) + np.max([high for _, high in ends], axis=0)) / 2
    frame = subject.rest[joint.parent] @ joint.T_parent_connector
    return MovingJoint(str(joint.type), _three(frame.z_axis), _three(frame.translation), _three(center))


# ---------------------------------------------------------------------- layouts


def _reading(read: Callable[[Path], TrueObject], file: Path) -> Callable[[], TrueObject]:
    def truth() -> TrueObject:
        try:
            return read(file)
        except (OSError, ValueError, KeyError, TypeError, IndexError) as error:
            raise _refused(file, f"It does not have the layout of its data set: {type(error).__name__}: {error}.") from error

    return truth


def _mobility(file: Path) -> TrueObject:
    assembly = subject_of(file).assembly
    if missing := [finding.message for finding in assembly.findings if finding.code == "W_IMPORT_MESH"]:
        raise _refused(file, f"It names meshes that are not there: {missing[0]}")
    return object_of(assembly)


def _acd(file: Path) -> TrueObject:
    """Read an object of ACD: triangles by part, and the articulations of parts."""
    stored = read_json(file)
    meshes = _glb(file.with_name(f"{file.parent.name}.glb"))
    parts = {int(part["partInfo"]["partId"]): part["partInfo"]["meshTri"] for part in stored["parts"] if part}
    joints = []
    for row in stored.get("annotation", stored)["articulations"]:
        corners = np.concatenate([_corners(meshes, rows) for rows in parts[int(row["pid"])]])
        center = (corners.min(axis=0) + corners.max(axis=0)) / 2
        axis, origin = (_UP @ np.asarray(row[name], dtype=float) for name in ("axis", "origin"))
        joints.append(MovingJoint(_TYPES[row["type"]], _three(axis), _three(origin), _three(center)))
    return TrueObject(merged(meshes), tuple(joints))


def _glb(file: Path) -> list[TriMesh]:
    """Return the meshes of a GLB in the order of its nodes, placed, Z up."""
    import trimesh  # noqa: PLC0415 - half a second, for one layout

    scene = trimesh.load_scene(file, process=False)
    pieces = []
    for node in scene.graph.nodes_geometry:
        matrix, name = scene.graph[node]
        geometry = scene.geometry[name]
        corners = trimesh.transform_points(geometry.vertices, matrix) @ _UP.T
        pieces.append(TriMesh(np.asarray(corners, dtype=np.float64), np.asarray(geometry.faces, dtype=np.int32)))
    return pieces


def _corners(meshes: Sequence[TriMesh], rows: Mapping[str, Any]) -> FloatArray:
    """Return the corners of triangles of one mesh, `(n, 3)`: single ones, and ranges without their ends."""
    mesh = meshes[int(rows["meshIndex"])]
    chosen = [index for entry in rows["triIndex"] for index in (range(*entry) if isinstance(entry, list) else (entry,))]
    return np.asarray(mesh.vertices[mesh.triangles[chosen].ravel()])


def _fusion(file: Path) -> TrueObject:
    """Read a pair of bodies with the first joint between them: body one moves against body two."""
    stored = read_json(file)
    joint = stored["joints"][0]
    sides = (joint["geometry_or_origin_one"], joint["geometry_or_origin_two"])
    names = (stored["body_one"], stored["body_two"])
    frames = [_frame(side["transform"]) for side in sides]
    bodies = [
        read_mesh(file.with_name(f"{name}.obj"), scale=MM_PER_CM).transformed(frame) for name, frame in zip(names, frames, strict=True)
    ]
    kind = joint["joint_motion"]["joint_type"]
    whole = merged(bodies)
    if kind not in _TYPES:  # rigid
        return TrueObject(whole, ())
    point, direction = _axis(sides, frames, float(np.linalg.norm(np.ptp(whole.bounds, axis=0))))
    return TrueObject(whole, (MovingJoint(_TYPES[kind], _three(direction), _three(point), _three(bodies[0].bounds.mean(axis=0))),))


def _axis(sides: Sequence[Mapping[str, Any]], frames: Sequence[SE3], size: float) -> tuple[FloatArray, FloatArray]:
    """Return point [mm] and direction of the joint's axis in the assembled state.

    Some copies of the data state it there, others in each body's own frame. The reading in which both sides give the same line is used.
    """
    own = [(MM_PER_CM * _vector(side["axis_line"]["origin"]), _vector(side["axis_line"]["direction"])) for side in sides]
    placed = [(frame.apply(point), frame.rotate(direction)) for frame, (point, direction) in zip(frames, own, strict=True)]
    lines = min((own, placed), key=lambda pair: _apart(pair[0], pair[1], size))
    return lines[1]


def _apart(a: tuple[FloatArray, FloatArray], b: tuple[FloatArray, FloatArray], size: float) -> float:
    """Return by how much two lines differ: sine of the angle between them plus their distance over the bodies' size."""
    first, second = (direction / np.linalg.norm(direction) for _, direction in (a, b))
    return float(np.linalg.norm(np.cross(first, second)) + np.linalg.norm(np.cross(b[0] - a[0], first)) / max(size, 1e-9))


def _frame(stored: Mapping[str, Any]) -> SE3:
    axes = np.stack([_vector(stored[name]) for name in ("x_axis", "y_axis", "z_axis")], axis=-1)
    return SE3.from_rotation(axes, MM_PER_CM * _vector(stored["origin"]))


def _vector(stored: Mapping[str, Any]) -> FloatArray:
    return np.array([float(stored[name]) for name in "xyz"])


def _three(vector: FloatArray) -> tuple[float, float, float]:
    return float(vector[0]), float(vector[1]), float(vector[2])


def _beside(file: Path) -> tuple[str, ...]:
    return tuple(path.name for ending in _PICTURES if (path := file.with_suffix(ending)).is_file())


def _refused(path: Path, message: str) -> ReadError:
    return ReadError.at(path, message, "See `articad_bench.public_data` for the layouts that are known.", said=message)
