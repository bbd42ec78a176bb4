"""What an element of URDF, SDFormat or MJCF states about a body in its link's frame, in the forms that articad's writers use.

Inertias are reduced to numbers that do not depend on the frame in which they are stated, and shapes to placed meshes, so that files can be
compared whose writers chose other frames and shapes for the same body.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from typing import Any, Final

import numpy as np

from articad.arrays import FloatArray
from articad.connectors.se3 import SE3
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Primitive
from articad.geometry.shapes import primitive_mesh
from articad.importers.mjcf_carried import CARRIED
from articad.importers.reading import MM_PER_M

__all__ = ["Meshes", "collides", "inertia", "is_primitive", "placed", "same_extents"]

Meshes = Callable[[str], TriMesh | None]
"""Returns a mesh in the unit of its file [mm] by its name in the elements; None if its file is not there."""

_BODIES: Final = frozenset({"body", "worldbody"})
_GEOM: Final = CARRIED["geom"] | {"class", "type", "mesh", "size", "pos", "quat", "name", "material"}
_SIZES: Final = {"box": 3, "cylinder": 2, "capsule": 2, "sphere": 1, "ellipsoid": 3}  # how many numbers state the size of a primitive
_MOMENTS: Final = {"ixx": (0, 0), "ixy": (0, 1), "ixz": (0, 2), "iyy": (1, 1), "iyz": (1, 2), "izz": (2, 2)}
_FULL: Final = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))  # order of MJCF's `fullinertia`
_DIRECTIONS: Final = 64
_OUTWARD: Final = 0.01  # of the diagonal: visual meshes of built parts, which records name, are simplified by up to 0.8 %
_ROUNDED: Final = 1e-6  # of the diagonal
_INWARD, _INWARD_MM = 0.05, 1.0  # pieces lie inside the shapes; the share is of the diagonal


# ---------------------------------------------------------------------- inertia


def inertia(element: Any) -> dict[str, str | None]:
    """Return mass, centre, radius of gyration and moments over the trace of an `<inertial>`, in the link's frame [kg, m], as texts.

    Raises:
        ValueError: If it states no inertia, or not in a form that articad writes.
    """
    T, mass, tensor = _mjcf_inertial(element) if element.get("mass") else _linked_inertial(element)
    about_com = T.rotation @ tensor @ T.rotation.T
    trace = float(np.trace(about_com))
    if not (mass > 0 and trace > 0 and math.isfinite(trace)):
        raise ValueError("not the inertia of a body")
    numbers: dict[str, Iterable[float]] = {
        "mass": [mass],
        "com": T.translation,
        "gyration": [math.sqrt(trace / mass)],
        "moments": [about_com[at] / trace for at in _MOMENTS.values()],
    }
    return {name: " ".join(repr(float(value)) for value in values) for name, values in numbers.items()}


def _mjcf_inertial(element: Any) -> tuple[SE3, float, FloatArray]:
    """Return pose [m], mass and tensor: `diaginertia` about principal axes, or `fullinertia`."""
    if not {"pos", "mass"} <= set(element.attrib) <= {"pos", "quat", "mass", "diaginertia", "fullinertia"} or len(element):
        raise ValueError("another form")
    full = element.get("fullinertia")
    tensor = np.diag(_numbers(element.get("diaginertia", ""), 3)) if full is None else _symmetric(_numbers(full, 6), _FULL)
    return _wxyz_pose(element), _numbers(element.get("mass"), 1)[0], tensor


def _linked_inertial(element: Any) -> tuple[SE3, float, FloatArray]:
    """Return pose [m], mass and tensor of URDF or SDFormat."""
    mass, moments = _only(element, "mass"), _only(element, "inertia")
    values = [moments.get(name, moments.findtext(name)) for name in _MOMENTS]
    tensor = _symmetric([_numbers(value, 1)[0] for value in values], tuple(_MOMENTS.values()))
    return _pose(element), _numbers(mass.get("value", mass.text), 1)[0], tensor


def _symmetric(values: Sequence[float], places: Sequence[tuple[int, int]]) -> FloatArray:
    tensor = np.zeros((3, 3))
    for (i, j), value in zip(places, values, strict=True):
        tensor[i, j] = tensor[j, i] = value
    return tensor


# ---------------------------------------------------------------------- shapes


def collides(element: Any) -> bool:
    """Return whether an element is a collision shape of a link or a body that an assembly holds; planes, for example, are not."""
    if element.tag == "collision":
        return all(shape.tag in {"mesh", *_SIZES} for shape in element.iterfind("geometry/*"))
    if element.tag != "geom":
        return False
    if element.getparent().tag not in _BODIES or element.get("class") not in {None, "collision"} or _kind(element) not in {"mesh", *_SIZES}:
        return False
    return element.get("class") == "collision" or not (element.get("contype") == "0" == element.get("conaffinity"))


def is_primitive(element: Any) -> bool:
    """Return whether a collision shape is a box, a cylinder and the like."""
    return _kind(element) != "mesh" if element.tag == "geom" else element.find("geometry/mesh") is None


def _kind(geom: Any) -> str:
    """Return the type of a geom: of the class `collision` it is a mesh by default, as articad writes that class."""
    stated: str = geom.get("type") or ("mesh" if geom.get("class") == "collision" else "sphere")
    return stated


def placed(element: Any, meshes: Meshes) -> TriMesh | None:
    """Return the mesh of a collision shape in the frame of its link [mm]; None if its file is not there.

    Raises:
        ValueError: If it is not in a form that articad writes.
        ArticadError: If a size is not a positive length.
    """
    if element.tag == "geom":
        if not set(element.attrib) <= _GEOM or len(element):
            raise ValueError("another form")
        T = _wxyz_pose(element)
        kind, size = _kind(element), [MM_PER_M * value for value in _numbers(element.get("size", ""))]
        mesh = meshes(element.get("mesh", "")) if kind == "mesh" else primitive_mesh(_half_sized(kind, size))
    else:
        T, (shape,) = _pose(element), _only(element, "geometry")
        mesh = _scaled(shape, meshes) if shape.tag == "mesh" else primitive_mesh(_sized(shape))
    if mesh is not None and not len(mesh.vertices):
        raise ValueError("another form")
    return None if mesh is None else mesh.transformed(SE3.from_quaternion(T.quaternion, T.translation * MM_PER_M))


def _scaled(shape: Any, meshes: Meshes) -> TriMesh | None:
    """Return the mesh that a `<mesh>` of URDF or SDFormat names."""
    if not {below.tag for below in shape} <= {"uri", "scale"}:
        raise ValueError("another form")
    if not (name := (shape.get("filename") or shape.findtext("uri") or "").strip()):
        raise ValueError("no name of a file")
    mesh = meshes(name)
    scale = np.array(_numbers(shape.get("scale") or shape.findtext("scale") or "1 1 1", 3)) * MM_PER_M
    return None if mesh is None else TriMesh(mesh.vertices * scale, mesh.triangles)


def _sized(shape: Any) -> Primitive:
    """Return the primitive of URDF or SDFormat."""
    size = [
        MM_PER_M * value
        for name in ("size", "radius", "length", "radii")
        for value in _numbers(shape.get(name) or shape.findtext(name) or "")
    ]
    return _primitive(shape.tag, size)


def _half_sized(kind: str, size: list[float]) -> Primitive:
    """Return the primitive of a geom, whose lengths are halves."""
    if kind == "box":
        return _primitive(kind, [2 * value for value in size])
    return _primitive(kind, [size[0], 2 * size[1]] if kind in {"cylinder", "capsule"} and len(size) == 2 else size)


def _primitive(kind: Any, size: list[float]) -> Primitive:
    if _SIZES.get(kind) != len(size):
        raise ValueError("another form")
    return Primitive(kind, tuple(size))


def same_extents(stated: Sequence[TriMesh], own: Sequence[TriMesh], *, exact: bool) -> bool:
    """Return whether shapes can stand for others: pieces inside them, their hulls, or they themselves.

    Such shapes reach as far as the others in every direction, or a little less.

    Args:
        stated: Shapes in the frame of a link.
        own: The shapes for which they may stand, in the same frame.
        exact: True if all of these are primitives, which writers leave as they are.
    """
    if not stated or not own:
        return not stated and not own
    outward, inward, inward_mm = (_ROUNDED, _ROUNDED, 0.0) if exact else (_OUTWARD, _INWARD, _INWARD_MM)
    corners = np.concatenate([mesh.vertices for mesh in own])
    diagonal = float(np.linalg.norm(np.ptp(corners, axis=0)))
    beyond = _reach(np.concatenate([mesh.vertices for mesh in stated])) - _reach(corners)
    return bool((beyond <= outward * diagonal).all() and (beyond >= -max(inward * diagonal, inward_mm)).all())


def _reach(points: FloatArray) -> FloatArray:
    """Return how far points extend in fixed directions, which are spread over the sphere on a spiral."""
    z = 1 - (2 * np.arange(_DIRECTIONS) + 1) / _DIRECTIONS
    angle = np.arange(_DIRECTIONS) * math.pi * (3 - math.sqrt(5))
    around = np.sqrt(1 - z * z)
    return np.array([(points @ direction).max() for direction in np.stack([around * np.cos(angle), around * np.sin(angle), z], axis=1)])


# ---------------------------------------------------------------------- numbers


def _pose(element: Any) -> SE3:
    """Return the pose of `<origin>` or `<pose>` [m]."""
    origin, pose = element.findall("origin"), element.findall("pose")
    if len(origin) + len(pose) > 1 or any(set(one.attrib) - {"xyz", "rpy"} for one in origin) or any(one.attrib for one in pose):
        raise ValueError("another form")
    text = next((f"{one.get('xyz', '0 0 0')} {one.get('rpy', '0 0 0')}" for one in origin), "0 0 0 0 0 0")
    x, y, z, roll, pitch, yaw = _numbers(next((one.text for one in pose), text), 6)
    return SE3.trans(x, y, z) @ SE3.rot_z(yaw) @ SE3.rot_y(pitch) @ SE3.rot_x(roll)


def _wxyz_pose(element: Any) -> SE3:
    """Return the pose that attributes of MJCF state [m]."""
    w, x, y, z = _numbers(element.get("quat", "1 0 0 0"), 4)
    return SE3.from_quaternion([x, y, z, w], _numbers(element.get("pos", "0 0 0"), 3))


def _only(element: Any, tag: str) -> Any:
    """Return the one child with a tag."""
    (found,) = element.findall(tag)
    return found


def _numbers(text: str | None, count: int | None = None) -> list[float]:
    values = [float(word) for word in (text or "").split(None, -1 if count is None else count)]
    if (count is not None and len(values) != count) or not all(map(math.isfinite, values)):
        raise ValueError("not the numbers that belong here")
    return values
