"""GLB: one node per part, in metres and Y-up, with an animation for every driving joint."""

from __future__ import annotations

import math
from collections import Counter
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from articad.arrays import FloatArray
from articad.connectors.mate import flip
from articad.connectors.se3 import SE3
from articad.errors import KinematicsError
from articad.export.bundle import Bundle
from articad.export.features import motion_and_mass
from articad.export.losses import kept_losses, losses_of, refuse
from articad.export.markup import rounded, rounded_quaternion
from articad.export.meshes import drawn_shapes
from articad.export.names import Names, valid_name
from articad.export.product import of_the_product
from articad.geometry.mesh import TriMesh
from articad.geometry.mesh_files import linear_color, packed_glb
from articad.kinematics.joints import Joint

if TYPE_CHECKING:
    from articad.assembly import Assembly


MM_PER_M = 1000.0
SECONDS = 4.0  # of one animation, forwards and back
FRAMES = 49  # of one animation; viewers interpolate linearly and by slerp, with an error of 0.1 % of a turn's chord
FAR_RAD = math.pi  # an endless angle is animated over one turn
FAR_MM = 100.0
CREASE_COSINE = math.cos(math.radians(30.0))  # faces that meet at a larger angle are shaded separately
Z_UP_TO_Y_UP = [-math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)]
_COMPONENTS = {"float32": 5126, "uint32": 5125, "uint16": 5123}
_SHORT = 65535  # vertices that indices of two bytes can name; glTF excludes the largest index


@of_the_product
def write_glb(assembly: Assembly, *, strict: bool = False) -> Bundle:
    """Write an assembly as one GLB file in its rest pose, with an animation for every driving joint.

    The root node converts articad's z-up to glTF's y-up. Below it each part is a node of its own name, in metres, in the node of the
    part that carries it, so that an independent joint animates one node, however much it carries. Meshes of built parts are simplified
    for drawing, as in the other formats (`articad.export.meshes.drawn`).

    Args:
        assembly: What to write.
        strict: Refuse losses of motion, mass or shape; glTF holds no joints and no mass, so only a single body passes.

    Returns:
        `<name>.glb` and the losses.

    Raises:
        UnrepresentableError: If `strict` and there is such a loss.
    """
    losses = (*losses_of("glb", motion_and_mass(assembly)), *kept_losses("glb", assembly.kept))
    if strict:
        refuse(losses)
    buffer = _Buffer()
    names = Names()
    nodes: list[dict[str, Any]] = [
        {"name": valid_name(assembly.name), "rotation": Z_UP_TO_Y_UP, "children": []},
    ]
    tree = _Tree(assembly)
    rest = tree.local(assembly.mechanism.at_rest[None])[0]
    for index, (name, part) in enumerate(assembly.parts.items()):
        node: dict[str, Any] = {"name": names.claim(name), **_placement(rest[index])}
        shapes = drawn_shapes(part)
        if shapes:
            node["mesh"] = buffer.mesh([(shape.placed, shape.color or part.color) for shape in shapes], node["name"])
        nodes.append(node)
    for index, carrier in enumerate(tree.carriers):
        nodes[carrier + 1].setdefault("children", []).append(index + 1)
    animations = [animation for joint in tree.driving if (animation := _animation(tree, joint, buffer)) is not None]
    document = {
        "asset": {"version": "2.0", "generator": "articad"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": nodes,
        **buffer.document(),
        **({"animations": animations} if animations else {}),
    }
    return Bundle({f"{valid_name(assembly.name)}.glb": packed_glb(document, bytes(buffer.data))}, losses)


class _Buffer:
    """The binary chunk, and what describes it."""

    def __init__(self) -> None:
        self.data = bytearray()
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []
        self.meshes: list[dict[str, Any]] = []
        self.materials: dict[str, int] = {}
        self._geometry: dict[str, dict[str, Any]] = {}
        self._times: int | None = None

    def document(self) -> dict[str, Any]:
        """Return the glTF arrays; empty ones are omitted, as the format demands."""
        materials = [
            {
                "name": color,
                "pbrMetallicRoughness": {"baseColorFactor": [*linear_color(color), 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.8},
            }
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
            "componentType": _COMPONENTS[array.dtype.name],
            "count": len(array),
            "type": kind,
        }
        if bounds:
            flat = array.reshape(len(array), -1)
            accessor |= {"min": flat.min(axis=0).tolist(), "max": flat.max(axis=0).tolist()}
        self.accessors.append(accessor)
        return len(self.accessors) - 1

    def times(self) -> int:
        """Return the accessor of the frame times, which all animations share."""
        if self._times is None:
            self._times = self.add(np.linspace(0.0, SECONDS, FRAMES).astype(np.float32), "SCALAR", bounds=True)
        return self._times

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
            positions, normals, indices = shaded(mesh)
            self._geometry[mesh.digest] = {
                "attributes": {
                    "POSITION": self.add((positions / MM_PER_M).astype(np.float32), "VEC3", target=34962, bounds=True),
                    "NORMAL": self.add(normals.astype(np.float32), "VEC3", target=34962),
                },
                "indices": self.add(indices.astype(np.uint32 if len(positions) > _SHORT else np.uint16), "SCALAR", target=34963),
            }
        return dict(self._geometry[mesh.digest])


def shaded(mesh: TriMesh) -> tuple[FloatArray, FloatArray, NDArray[np.int64]]:
    """Return vertices, normals and indices: corners whose faces meet smoothly share a vertex, those at creases get their own."""
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


class _Tree:
    """Which part carries which, and how parts move relative to their carriers.

    Attributes:
        carriers: Index of the part that carries each part; -1 for the ground part.
        driving: Names of the joints that drive.
    """

    def __init__(self, assembly: Assembly) -> None:
        self.assembly = assembly
        mechanism = assembly.mechanism
        place = {name: index for index, name in enumerate(assembly.parts)}
        self.carriers = [-1] * len(place)
        self._edges: dict[str, tuple[int, bool]] = {}
        for edge in mechanism.tree.edges:
            self.carriers[place[edge.part]] = place[edge.parent]
            self._edges[edge.joint.name] = place[edge.part], edge.reversed
        self._joints = {joint.name: joint for joint in mechanism.joints}
        self._columns: dict[str, list[int]] = {}
        for index, driver in enumerate(assembly.drivers):
            self._columns.setdefault(driver.joint, []).append(index)
        self.driving = tuple(mechanism.driving_joints)
        self._tied = _tied(assembly)

    def local(self, poses: SE3) -> SE3:
        """Return the poses of all parts relative to their carriers, `(frames, N)`, from those in the world."""
        carriers = np.array(self.carriers)
        moved = np.flatnonzero(carriers >= 0)
        found = poses.data.copy()
        found[:, moved] = (poses[:, carriers[moved]].inverse() @ poses[:, moved]).data
        return SE3.from_unit_array(found)

    def moved(self, joint: str) -> list[tuple[int, SE3]]:
        """Return the parts that move relative to their carriers while a joint runs through its range and back, and their poses.

        Raises:
            KinematicsError: If a loop does not let it reach its range.
        """
        columns, spec = self._columns[joint], self._joints[joint]
        values = _swept(self.assembly, spec, columns)
        if joint not in self._tied:
            part, is_reversed = self._edges[joint]
            T = spec.T_parent_connector @ spec.motion(values) @ flip(spec.mate) @ spec.T_child_connector.inverse()
            return [(part, T.inverse() if is_reversed else T)]
        q = np.tile(self.assembly.mechanism.rest, (FRAMES, 1))
        q[:, columns] = values
        local = self.local(self.assembly.poses(q))
        return [(index, local[:, index]) for index in range(len(self.carriers))]


def _tied(assembly: Assembly) -> set[str]:
    """Return the joints of couplings, of loops, and those with coordinates that do not drive."""
    mechanism = assembly.mechanism
    owner = {column: joint.name for joint in mechanism.joints for column in joint.column_names}
    tied = {owner[column] for coupling in mechanism.couplings for column in (coupling.a, coupling.b)}
    for joint in mechanism.loop_joints:
        parts = set(mechanism.tree.path(joint.parent, joint.child))
        tied |= {joint.name} | {edge.joint.name for edge in mechanism.tree.edges if {edge.part, edge.parent} <= parts}
    driving = Counter(driver.joint for driver in assembly.drivers)
    return tied | {joint.name for joint in mechanism.joints if driving[joint.name] != len(joint.column_names)}


def _animation(tree: _Tree, joint: str, buffer: _Buffer) -> dict[str, Any] | None:
    """Return the motion of one joint through its range and back, all others at rest; None if it cannot move."""
    try:
        moved = tree.moved(joint)
    except KinematicsError:  # a range that a loop does not allow: `_features` has reported this loss
        return None
    channels, samplers = [], []
    for index, T in moved:
        paths = {"translation": T.translation / MM_PER_M, "rotation": _continuous(T.quaternion)}
        for path, values in paths.items():
            if np.abs(values - values[0]).max() < 1e-9:
                continue
            output = buffer.add(values.astype(np.float32), "VEC3" if path == "translation" else "VEC4")
            samplers.append({"input": buffer.times(), "output": output, "interpolation": "LINEAR"})
            channels.append({"sampler": len(samplers) - 1, "target": {"node": index + 1, "path": path}})
    return {"name": valid_name(joint), "channels": channels, "samplers": samplers} if channels else None


def _swept(assembly: Assembly, spec: Joint, columns: list[int]) -> FloatArray:
    """Return the values of a joint that goes from rest to its upper limit, to its lower one and back, `(frames, coordinates)`."""
    drivers = [assembly.drivers[column] for column in columns]
    phase = np.sin(np.linspace(0.0, math.tau, FRAMES))
    if drivers[0].unit == "1":
        cone = min(spec.limits.cone or math.pi, math.pi / 2)
        return np.asarray((SE3.from_quaternion(spec.rest) @ SE3.rot_x(0.5 * cone * phase)).quaternion)
    values = np.empty((FRAMES, len(columns)))
    for place, driver in enumerate(drivers):
        far = FAR_RAD if driver.unit == "rad" else FAR_MM
        low, high = max(driver.lower, driver.rest - far), min(driver.upper, driver.rest + far)
        # several coordinates of one joint move one after the other, so that each is seen by itself
        own = _wave(len(columns), place)
        values[:, place] = driver.rest + np.where(own > 0, (high - driver.rest) * own, (driver.rest - low) * own)
    return values


def _wave(count: int, place: int) -> FloatArray:
    """Return a whole wave within the `place`-th of `count` intervals of the animation, zero elsewhere."""
    t = np.linspace(0.0, count, FRAMES) - place
    wave: FloatArray = np.where((t >= 0) & (t <= 1), np.sin(math.tau * t), 0.0)
    return wave


def _continuous(quaternions: FloatArray) -> FloatArray:
    """Change signs so that neighbours are in one hemisphere; otherwise viewers would interpolate the long way."""
    signs = np.sign((quaternions[1:] * quaternions[:-1]).sum(axis=1))
    signs[signs == 0] = 1.0
    turned: FloatArray = quaternions * np.concatenate([[1.0], np.cumprod(signs)])[:, None]
    return turned


def _placement(T: SE3) -> dict[str, list[float]]:
    return {"translation": rounded(T.translation / MM_PER_M), "rotation": rounded_quaternion(T)}
