"""GLB: one node per part, in metres and Y-up, with an animation for every joint that drives."""

from __future__ import annotations

import json
import math
import struct
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from articad.connectors.se3 import SE3
from articad.errors import KinematicsError
from articad.export.bundle import Bundle
from articad.export.losses import Feature, kept_losses, losses_of, refuse
from articad.export.names import Names, valid_name
from articad.geometry.mesh import TriMesh
from articad.kinematics.joints import JointType

if TYPE_CHECKING:
    from articad.assembly import Assembly

FloatArray = NDArray[np.float64]

MM_PER_M = 1000.0
SECONDS = 4.0  # of one animation: there and back
FRAMES = 49  # of one animation; between them viewers go straight and slerp, which is 0.1 % of a turn's chord off
FAR_RAD = math.pi  # an endless angle is shown by one turn
FAR_MM = 100.0
CREASE_COSINE = math.cos(math.radians(30.0))  # faces that meet more steeply are shaded apart
Z_UP_TO_Y_UP = [-math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)]
_FLOAT, _UINT = 5126, 5125


def write_glb(assembly: Assembly, *, strict: bool = False) -> Bundle:
    """Write an assembly as one GLB file in its rest pose, with an animation for every joint that drives.

    The root node turns articad's z-up into glTF's y-up; below it each part is a node of its own name, in metres.

    Args:
        assembly: What to write.
        strict: Refuse losses of motion, mass or shape; glTF holds no joints and no mass, so only a single body passes.

    Returns:
        `<name>.glb` and the losses.

    Raises:
        UnrepresentableError: If `strict` and there is such a loss.
    """
    losses = (*losses_of("glb", _features(assembly)), *kept_losses("glb", assembly.kept))
    if strict:
        refuse(losses)
    buffer = _Buffer()
    names = Names()
    nodes: list[dict[str, Any]] = [
        {"name": valid_name(assembly.name), "rotation": Z_UP_TO_Y_UP, "children": list(range(1, len(assembly.parts) + 1))}
    ]
    rest = assembly.mechanism.rest_poses()
    for name, part in assembly.parts.items():
        node: dict[str, Any] = {"name": names.claim(name), **_placement(rest[name])}
        shapes = part.visuals or part.collisions
        if shapes:
            node["mesh"] = buffer.mesh([(shape.placed, shape.color or part.color) for shape in shapes], node["name"])
        nodes.append(node)
    animations = [animation for joint in _driving(assembly) if (animation := _animation(assembly, joint, buffer)) is not None]
    document = {
        "asset": {"version": "2.0", "generator": "articad"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": nodes,
        **buffer.document(),
        **({"animations": animations} if animations else {}),
    }
    return Bundle({f"{valid_name(assembly.name)}.glb": _glb(document, bytes(buffer.data))}, losses)


class _Buffer:
    """The binary chunk, and what describes it."""

    def __init__(self) -> None:
        self.data = bytearray()
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []
        self.meshes: list[dict[str, Any]] = []
        self.materials: dict[str, int] = {}
        self._geometry: dict[str, dict[str, Any]] = {}

    def document(self) -> dict[str, Any]:
        """Return the glTF arrays; those that are empty are left out, as the format demands."""
        materials = [
            {"name": color, "pbrMetallicRoughness": {"baseColorFactor": _linear(color), "metallicFactor": 0.0, "roughnessFactor": 0.8}}
            for color in self.materials
        ]
        arrays = {"meshes": self.meshes, "materials": materials, "accessors": self.accessors, "bufferViews": self.views}
        found: dict[str, Any] = {name: array for name, array in arrays.items() if array}
        return found | ({"buffers": [{"byteLength": len(self.data)}]} if self.data else {})

    def add(self, array: NDArray[Any], kind: str, *, target: int | None = None, bounds: bool = False) -> int:
        """Append an array and return its accessor."""
        content = np.ascontiguousarray(array).tobytes()
        view: dict[str, Any] = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(content)}
        self.views.append(view | ({} if target is None else {"target": target}))
        self.data += content + b"\0" * (-len(content) % 4)
        accessor: dict[str, Any] = {
            "bufferView": len(self.views) - 1,
            "componentType": _FLOAT if array.dtype == np.float32 else _UINT,
            "count": len(array),
            "type": kind,
        }
        if bounds:
            flat = array.reshape(len(array), -1)
            accessor |= {"min": flat.min(axis=0).tolist(), "max": flat.max(axis=0).tolist()}
        self.accessors.append(accessor)
        return len(self.accessors) - 1

    def mesh(self, shapes: list[tuple[TriMesh, str]], name: str) -> int:
        """Add a mesh of one primitive per shape and return its index."""
        primitives = []
        for mesh, color in shapes:
            material = self.materials.setdefault(color, len(self.materials))
            primitives.append(self._primitive(mesh) | {"material": material})
        self.meshes.append({"name": name, "primitives": primitives})
        return len(self.meshes) - 1

    def _primitive(self, mesh: TriMesh) -> dict[str, Any]:
        """Return a primitive; equal meshes share their data."""
        if mesh.digest not in self._geometry:
            positions, normals, indices = _shaded(mesh)
            self._geometry[mesh.digest] = {
                "attributes": {
                    "POSITION": self.add((positions / MM_PER_M).astype(np.float32), "VEC3", target=34962, bounds=True),
                    "NORMAL": self.add(normals.astype(np.float32), "VEC3", target=34962),
                },
                "indices": self.add(indices.astype(np.uint32), "SCALAR", target=34963),
            }
        return dict(self._geometry[mesh.digest])


def _shaded(mesh: TriMesh) -> tuple[FloatArray, FloatArray, NDArray[np.int64]]:
    """Return vertices, normals and indices: corners whose faces meet smoothly share their vertex, those at creases get their own."""
    twice = mesh.normals_of_twice_area
    flat = twice / np.maximum(np.linalg.norm(twice, axis=1), np.finfo(float).tiny)[:, None]
    index = mesh.triangles.reshape(-1)
    smooth = np.zeros((len(mesh.vertices), 3))
    np.add.at(smooth, index, np.repeat(twice, 3, axis=0))
    smooth /= np.maximum(np.linalg.norm(smooth, axis=1), np.finfo(float).tiny)[:, None]
    corners = np.repeat(flat, 3, axis=0)
    creased = np.flatnonzero((smooth[index] * corners).sum(axis=1) <= CREASE_COSINE)
    used, inverse = np.unique(np.delete(index, creased), return_inverse=True)
    indices = np.empty(len(index), dtype=np.int64)
    indices[np.delete(np.arange(len(index)), creased)] = inverse
    indices[creased] = len(used) + np.arange(len(creased))
    positions = np.concatenate([mesh.vertices[used], mesh.vertices[index[creased]]])
    return positions, np.concatenate([smooth[used], corners[creased]]), indices


def _driving(assembly: Assembly) -> list[str]:
    return list(assembly.mechanism.driving_joints)


def _animation(assembly: Assembly, joint: str, buffer: _Buffer) -> dict[str, Any] | None:
    """Return the motion of one joint through its range and back, all others at rest; None where it cannot move."""
    try:
        poses = assembly.poses(_sweep(assembly, joint))
    except KinematicsError:  # a range that a loop does not let it reach: its motion is a loss that `_features` has told
        return None
    times = buffer.add(np.linspace(0.0, SECONDS, FRAMES).astype(np.float32), "SCALAR", bounds=True)
    channels, samplers = [], []
    for index in range(len(assembly.parts)):
        T = poses[:, index]
        paths = {"translation": T.translation / MM_PER_M, "rotation": _continuous(T.quaternion)}
        for path, values in paths.items():
            if np.abs(values - values[0]).max() < 1e-9:
                continue
            output = buffer.add(values.astype(np.float32), "VEC3" if path == "translation" else "VEC4")
            samplers.append({"input": times, "output": output, "interpolation": "LINEAR"})
            channels.append({"sampler": len(samplers) - 1, "target": {"node": index + 1, "path": path}})
    return {"name": valid_name(joint), "channels": channels, "samplers": samplers} if channels else None


def _sweep(assembly: Assembly, joint: str) -> FloatArray:
    """Return configurations that take one joint from rest to its upper limit, to its lower one and back, `(frames, nq)`."""
    q = np.tile(assembly.mechanism.rest, (FRAMES, 1))
    columns = [index for index, driver in enumerate(assembly.drivers) if driver.joint == joint]
    phase = np.sin(np.linspace(0.0, math.tau, FRAMES))
    if assembly.drivers[columns[0]].unit == "1":
        spec = next(candidate for candidate in assembly.joints if candidate.name == joint)
        cone = min(spec.limits.cone or math.pi, math.pi / 2)
        q[:, columns] = (SE3.from_quaternion(spec.rest) @ SE3.rot_x(0.5 * cone * phase)).quaternion
        return q
    for place, column in enumerate(columns):
        driver = assembly.drivers[column]
        far = FAR_RAD if driver.unit == "rad" else FAR_MM
        low, high = max(driver.lower, driver.rest - far), min(driver.upper, driver.rest + far)
        # several coordinates of one joint go one after the other, so that each is seen by itself
        own = _wave(len(columns), place)
        q[:, column] = driver.rest + np.where(own > 0, (high - driver.rest) * own, (driver.rest - low) * own)
    return q


def _wave(count: int, place: int) -> FloatArray:
    """Return a whole wave within the `place`-th of `count` stretches of the animation, zero elsewhere."""
    t = np.linspace(0.0, count, FRAMES) - place
    wave: FloatArray = np.where((t >= 0) & (t <= 1), np.sin(math.tau * t), 0.0)
    return wave


def _continuous(quaternions: FloatArray) -> FloatArray:
    """Turn signs so that neighbours are on one side, or viewers would go the long way round."""
    signs = np.sign((quaternions[1:] * quaternions[:-1]).sum(axis=1))
    signs[signs == 0] = 1.0
    turned: FloatArray = quaternions * np.concatenate([[1.0], np.cumprod(signs)])[:, None]
    return turned


def _placement(T: SE3) -> dict[str, list[float]]:
    return {"translation": [float(x) / MM_PER_M for x in T.translation], "rotation": [float(x) for x in T.quaternion]}


def _linear(color: str) -> list[float]:
    """Turn "#rrggbb" (sRGB) into the linear factors that glTF wants."""
    channels = [int(color[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    return [*(c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels), 1.0]


def _features(assembly: Assembly) -> list[Feature]:
    features = [Feature("motion", f"joints.{joint.name}") for joint in assembly.joints if joint.type is not JointType.FIXED]
    return features + [Feature("mass", f"parts.{name}") for name, part in assembly.parts.items() if part.mass is not None]


def _glb(document: dict[str, Any], binary: bytes) -> bytes:
    text = json.dumps(document, separators=(",", ":")).encode("ascii")
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    if binary:
        chunks += struct.pack("<I4s", len(binary), b"BIN\0") + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks
