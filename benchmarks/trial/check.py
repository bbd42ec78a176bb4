"""Check a product of the trial by its files alone: freedoms, loops, overlaps over every two drivers, stated sizes.

    python benchmarks/trial/check.py axle|lamp|bed MODEL.xml [--step PRODUCT.step] [--steps 7]

The checker shares no code with articad. MuJoCo reads the file, gives the poses and the Jacobian of its equality constraints; Newton's method
closes the loops; manifold3d intersects the meshes of the parts, which are those of the file, or solids of a STEP file of the product at rest
(OpenCascade reads it; visual meshes may be coarser than clearances). What counts as a mistake is the same whoever made the files:

- a part without a body of its name, without a closed mesh in geom group 2, or with another shape or place in the STEP file;
- freedoms = nv - rank(J of the equalities) at random closed poses, or the number of closed loops, other than the task states;
- a pose of two drivers, over their whole ranges, in which loops do not close or two parts share volume;
- a size, range or position other than stated.

Two meshes share volume if the intersection V has at least 2 mm³ and a mean thickness 2 V / A of at least 0.1 mm, A its surface: less than
that is the difference between a circle and its polygon. Exit code 1 if there is a mistake.
"""

from __future__ import annotations

import argparse
import itertools
import math
import sys
from collections.abc import Callable, Container, Mapping
from pathlib import Path
from typing import Any, Final

import build123d
import manifold3d
import mujoco
import numpy as np
import trimesh
from OCP.collections import Sequence_TDF_Label
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label
from OCP.TDocStd import TDocStd_Document
from OCP.TopLoc import TopLoc_Location
from OCP.XCAFDoc import XCAFDoc_DocumentTool

LEAST_VOLUME: Final = 2.0  # mm³
LEAST_THICKNESS: Final = 0.1  # mm, mean
DEFLECTION, ANGLE = 0.02, 0.1  # mm and rad: of the meshes of solids
ALIKE: Final = 0.1  # mm, and 1/500 of the size: between the model's visual mesh and the solid
CLOSED: Final = 1e-5  # m and rad: residual of a closed loop
STEP: Final = math.radians(4)  # of drivers on the way to a pose
FULL: Final = math.pi  # range of a joint without limits, to both sides
GENERIC: Final = 5  # random poses at which the rank is taken


def both(*stems: str) -> list[str]:
    """Return the names of parts on both sides."""
    return [f"{stem}_{side}" for stem in stems for side in "lr"]


PARTS: Final[Mapping[str, list[str]]] = {
    "axle": [
        *("beam", "tie_rod", "bracket", "column", "drag_link", "drag_pin_a", "drag_pin_b"),
        *both("kingpin", "knuckle", "hub", "wheel", "nut", "tie_pin"),
    ],
    "lamp": [
        *("foot", "turntable", "lower_a", "lower_b", "elbow", "upper_a", "upper_b", "head", "shade", "bulb", "tilt_pin"),
        *(f"{arm}_pin_{letter}" for arm in ("low", "up") for letter in "abcd"),
    ],
    "bed": ["cabinet", "frame", "mattress", "leg", *both("pivot", "foot_pin", "side_pin", "cylinder", "rod", "leg_pin")],
}
DRIVERS: Final[Mapping[str, list[str]]] = {
    "axle": ["steer", "spin_l", "spin_r"],
    "lamp": ["yaw", "low_a", "up_a", "tilt"],
    "bed": ["fold", "swing"],
}
FREEDOMS: Final[Mapping[str, int]] = {"axle": 3, "lamp": 4, "bed": 2}
LOOPS: Final[Mapping[str, int]] = {"axle": 2, "lamp": 2, "bed": 2}


class Product:
    """A model in MuJoCo whose loops are closed for given values of its drivers."""

    def __init__(self, file: Path, kind: str, step: Path | None = None) -> None:
        self.parts = PARTS[kind]
        self.drivers = DRIVERS[kind]
        self.mistakes: list[str] = []
        self.model = mujoco.MjModel.from_xml_path(str(file))
        self.model.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
        for flag in ("mjDSBL_CONTACT", "mjDSBL_LIMIT", "mjDSBL_FRICTIONLOSS"):
            self.model.opt.disableflags |= getattr(mujoco.mjtDisableBit, flag)
        self.data = mujoco.MjData(self.model)
        self.body = {name: self._id("BODY", name) for name in self.parts}
        self.joint = {name: self._id("JOINT", name) for name in self.drivers}
        if self.mistakes:
            return
        if self.model.nkey:
            mujoco.mj_resetDataKeyframe(self.model, self.data, 0)
        self.fixed = {int(self.model.jnt_dofadr[joint]) for joint in self.joint.values()}
        self.open = [dof for dof in range(self.model.nv) if dof not in self.fixed]
        if not self.close():
            self.mistakes.append(f"loops are open by {1e3 * np.abs(self.residual()[1]).max():.3f} mm at rest")
        self.rest = self.data.qpos.copy()
        self.values = {name: float(self.rest[self.model.jnt_qposadr[joint]]) for name, joint in self.joint.items()}
        self.mesh: dict[str, Any] = {name: self._mesh(name) for name in self.parts}
        if step is not None:
            self._finer(step)
        self.solid: dict[str, Any] = {}
        for name, mesh in self.mesh.items():
            solid = (
                None
                if mesh is None
                else manifold3d.Manifold(manifold3d.Mesh(np.asarray(mesh.vertices, np.float32), np.asarray(mesh.faces, np.uint32)))
            )
            if solid is None or solid.status() != manifold3d.Error.NoError or solid.volume() <= 0:
                self.mistakes.append(f"{name} has no closed mesh in geom group 2")
            self.solid[name] = solid

    def _id(self, kind: str, name: str) -> int:
        found = mujoco.mj_name2id(self.model, getattr(mujoco.mjtObj, f"mjOBJ_{kind}"), name)
        if found < 0:
            self.mistakes.append(f"there is no {kind.lower()} {name}")
        return int(found)

    def _mesh(self, name: str) -> trimesh.Trimesh | None:
        """Return the meshes of a part's visual geoms in the frame of its body [mm]."""
        model, pieces = self.model, []
        for geom in np.flatnonzero((model.geom_bodyid == self.body[name]) & (model.geom_group == 2)):
            if int(model.geom_type[geom]) != mujoco.mjtGeom.mjGEOM_MESH.value:
                continue
            data = model.geom_dataid[geom]
            start, count = model.mesh_vertadr[data], model.mesh_vertnum[data]
            first, faces = model.mesh_faceadr[data], model.mesh_facenum[data]
            turn = np.empty(9)
            mujoco.mju_quat2Mat(turn, model.geom_quat[geom])
            points = model.mesh_vert[start : start + count] @ turn.reshape(3, 3).T + model.geom_pos[geom]
            pieces.append(trimesh.Trimesh(1e3 * points, model.mesh_face[first : first + faces], process=False))
        if not pieces:
            return None
        mesh: trimesh.Trimesh = trimesh.util.concatenate(pieces)
        mesh.merge_vertices(digits_vertex=4)
        return mesh

    def _finer(self, file: Path) -> None:
        """Replace the meshes by those of the solids in a STEP file of the product at rest, if both show the same part at the same place."""
        solids = solids_of(file)
        for name in self.parts:
            if name not in solids:
                self.mistakes.append(f"the STEP file has no solid {name}")
                continue
            mesh, drawn = trimesh.Trimesh(*solids[name], process=False), self.mesh[name]
            mesh.merge_vertices(digits_vertex=5)
            mesh.apply_transform(np.linalg.inv(self.pose(name)))
            if drawn is not None:
                differ = np.abs(mesh.bounds - drawn.bounds).max()
                if differ > ALIKE + ALIKE / 50 * mesh.scale:
                    self.mistakes.append(f"{name} differs by {differ:.1f} mm between the model and the STEP file")
            self.mesh[name] = mesh

    def residual(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the Jacobian of the equality constraints and their residual [m, rad] at the present pose."""
        mujoco.mj_fwdPosition(self.model, self.data)
        rows = np.flatnonzero(self.data.efc_type[: self.data.nefc] == mujoco.mjtConstraint.mjCNSTR_EQUALITY.value)
        return self.data.efc_J.reshape(-1, self.model.nv)[rows] if len(rows) else np.zeros((0, self.model.nv)), self.data.efc_pos[rows]

    def close(self) -> bool:
        """Move all but the drivers until the loops are closed, by Newton's method; return whether they are."""
        for _ in range(30):
            jacobian, error = self.residual()
            if not len(error) or np.abs(error).max() < CLOSED / 100:
                return True
            step = np.zeros(self.model.nv)
            step[self.open] = np.linalg.lstsq(jacobian[:, self.open], -error, rcond=1e-9)[0]
            mujoco.mj_integratePos(self.model, self.data.qpos, step, 1.0)
        return bool(np.abs(self.residual()[1]).max() < CLOSED)

    def move(self, values: Mapping[str, float]) -> bool:
        """Move the drivers from rest to these values [rad], the others to rest, in small steps; return whether loops stay closed."""
        self.data.qpos[:] = self.rest
        start = self.values
        goal = {**start, **values}
        count = max(1, *(math.ceil(abs(goal[name] - start[name]) / STEP) for name in start))
        for index in range(1, count + 1):
            for name, joint in self.joint.items():
                self.data.qpos[self.model.jnt_qposadr[joint]] = start[name] + (goal[name] - start[name]) * index / count
            if not self.close():
                return False
        return True

    def range(self, name: str) -> tuple[float, float]:
        joint = self.joint[name]
        low, high = self.model.jnt_range[joint]
        return (float(low), float(high)) if self.model.jnt_limited[joint] else (-FULL, FULL)

    def pose(self, name: str) -> np.ndarray:
        """Return the pose of a part, in mm."""
        pose = np.eye(4)
        pose[:3, :3] = self.data.xmat[self.body[name]].reshape(3, 3)
        pose[:3, 3] = 1e3 * self.data.xpos[self.body[name]]
        return pose

    def box(self, *names: str) -> np.ndarray:
        """Return the lowest and the highest corner of parts at the present pose [mm]."""
        corners = [trimesh.transform_points(self.mesh[name].vertices, self.pose(name)) for name in names]
        points = np.concatenate(corners)
        return np.array([points.min(axis=0), points.max(axis=0)])

    def freedoms(self) -> int:
        """Return nv - rank(J), the largest rank at random closed poses within the ranges."""
        random, rank = np.random.default_rng(7), 0
        for _ in range(GENERIC):
            self.move({name: random.uniform(*self.range(name)) * 0.6 + 0.4 * self.values[name] for name in self.drivers})
            jacobian, _ = self.residual()
            if len(jacobian):
                sizes = np.linalg.svd(jacobian, compute_uv=False)
                rank = max(rank, int((sizes > 1e-6 * sizes[0]).sum()))
        return int(self.model.nv) - rank

    def loops(self) -> int:
        """Return how many pairs of parts equality constraints tie together; a body that is no part belongs to the part that holds it."""
        model, named, tied = self.model, set(self.body.values()), set()
        for index in range(model.neq):
            if int(model.eq_type[index]) not in (mujoco.mjtEq.mjEQ_CONNECT.value, mujoco.mjtEq.mjEQ_WELD.value):
                continue
            ends = [int(model.eq_obj1id[index]), int(model.eq_obj2id[index])]
            if int(model.eq_objtype[index]) == mujoco.mjtObj.mjOBJ_SITE.value:
                ends = [int(model.site_bodyid[end]) for end in ends]
            tied.add(frozenset(self._held_by(end, named) for end in ends))
        return len(tied)

    def _held_by(self, body: int, named: Container[int]) -> int:
        while body and body not in named:
            body = int(self.model.body_parentid[body])
        return body


def solids_of(file: Path) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Return vertices [mm] and triangles of each solid of a STEP file, placed, by the name of its instance or else of its product."""
    document = TDocStd_Document(TCollection_ExtendedString("check"))
    reader = STEPCAFControl_Reader()
    reader.SetNameMode(namemode=True)
    reader.ReadFile(str(file))
    reader.Transfer(document)
    tool, found = XCAFDoc_DocumentTool.ShapeTool_s(document.Main()), dict[str, tuple[np.ndarray, np.ndarray]]()

    def visit(label: Any, place: TopLoc_Location, names: list[str]) -> None:
        if tool.IsReference_s(label):
            referred = TDF_Label()
            tool.GetReferredShape_s(label, referred)
            visit(referred, place * tool.GetLocation_s(label), [*names, name_of(label)])
            return
        parts = Sequence_TDF_Label()
        tool.GetComponents_s(label, parts)
        for index in range(1, parts.Length() + 1):
            visit(parts.Value(index), place, [])
        if not parts.Length():
            shape = tool.GetShape_s(label)
            for name in (*names, name_of(label)):
                found.setdefault(name, meshed(shape.Moved(place)))

    roots = Sequence_TDF_Label()
    tool.GetFreeShapes(roots)
    for index in range(1, roots.Length() + 1):
        visit(roots.Value(index), TopLoc_Location(), [])
    return found


def name_of(label: Any) -> str:
    name = TDataStd_Name()
    return str(name.Get().ToExtString()) if label.FindAttribute(TDataStd_Name.GetID_s(), name) else ""


def meshed(shape: Any) -> tuple[np.ndarray, np.ndarray]:
    points, faces = build123d.Shape.cast(shape).tessellate(DEFLECTION, ANGLE)
    return np.array([tuple(point) for point in points]), np.array(faces)


class Overlaps:
    """Shared volume of pairs of parts, computed once for each relative pose."""

    def __init__(self, product: Product) -> None:
        self.product = product
        self.known: dict[Any, float] = {}
        self.worst: dict[tuple[str, str], tuple[float, str]] = {}

    def look(self, place: str) -> None:
        """Compare all pairs at the present pose."""
        poses = {name: self.product.pose(name) for name in self.product.parts}
        boxes = {name: self.product.box(name) for name in self.product.parts}
        for first, second in itertools.combinations(self.product.parts, 2):
            if (np.minimum(boxes[first][1], boxes[second][1]) - np.maximum(boxes[first][0], boxes[second][0])).min() <= 0:
                continue
            between = np.linalg.inv(poses[first]) @ poses[second]
            key = (first, second, *np.round(between[:3], 4).ravel())
            if key not in self.known:
                self.known[key] = self._shared(first, second, between)
            volume = self.known[key]
            if volume > self.worst.get((first, second), (0.0, ""))[0]:
                self.worst[first, second] = volume, place

    def _shared(self, first: str, second: str, between: np.ndarray) -> float:
        common = self.product.solid[first] ^ self.product.solid[second].transform(between[:3])
        volume, area = common.volume(), common.surface_area()
        return float(volume) if volume >= LEAST_VOLUME and 2 * volume / area >= LEAST_THICKNESS else 0.0


def moved(product: Product, steps: int) -> list[str]:
    """Move every two drivers over their ranges and return the mistakes that are found there."""
    found, overlaps = [], Overlaps(product)
    product.move({})
    overlaps.look("at rest")
    for first, second in itertools.combinations(product.drivers, 2):
        stuck = []
        for a in np.linspace(*product.range(first), steps):
            for b in np.linspace(*product.range(second), steps):
                place = f"{first} {math.degrees(a):.1f}°, {second} {math.degrees(b):.1f}°"
                if product.move({first: float(a), second: float(b)}):
                    overlaps.look(place)
                else:
                    stuck.append(place)
        if stuck:
            found.append(f"loops do not close at {len(stuck)} poses of {first} and {second}, such as {stuck[0]}")
    return found + [f"{a} and {b} share {volume:.0f} mm³ at {place}" for (a, b), (volume, place) in overlaps.worst.items() if volume > 0]


# ---------------------------------------------------------------------- stated sizes


class Sizes:
    """Compares stated numbers with what the files have."""

    def __init__(self, product: Product) -> None:
        self.product = product
        self.found: list[str] = []

    def equal(self, what: str, value: float, stated: float, within: float) -> None:
        if not abs(value - stated) <= within:
            self.found.append(f"{what} is {value:.2f}, not {stated:g} ± {within:g}")

    def size(self, part: str, stated: tuple[float | None, ...], within: float = 0.5) -> None:
        """Compare the sides of a part's bounding box at the present pose."""
        low, high = self.product.box(part)
        for axis, value in zip("xyz", stated, strict=True):
            if value is not None:
                index = "xyz".index(axis)
                self.equal(f"the size of {part} along {axis}", high[index] - low[index], value, within)

    def span(self, name: str, low: float, high: float, within: float = 0.6) -> None:
        """Compare a joint's range in degrees, whichever way it counts."""
        ends = sorted(math.degrees(end) for end in self.product.range(name))
        if not any(max(abs(ends[0] - a), abs(ends[1] - b)) <= within for a, b in ((low, high), (-high, -low))):
            self.found.append(f"the range of {name} is [{ends[0]:.1f}, {ends[1]:.1f}]°, not [{low:g}, {high:g}]")

    def width(self, name: str, degrees: float, within: float = 0.6) -> None:
        low, high = self.product.range(name)
        self.equal(f"the range of {name} in degrees", math.degrees(high - low), degrees, within)


def turned(product: Product, part: str, before: np.ndarray, axis: np.ndarray) -> float:
    """Return how far a part has turned about an axis of the world since a pose [deg]; the tilt beside it is not counted."""
    turn = product.pose(part)[:3, :3] @ before[:3, :3].T
    side = np.cross(axis, [1.0, 0, 0] if abs(axis[0]) < 0.9 else [0, 1.0, 0])
    side /= np.linalg.norm(side)
    image = turn @ side
    return math.degrees(math.atan2(np.cross(side, image) @ axis, side @ image))


def axle(product: Product) -> list[str]:
    """Check the sizes of the axle."""
    sizes, up = Sizes(product), np.array([0.0, 0, 1])
    product.move({})
    for side in "lr":
        sizes.size(f"wheel_{side}", (60, 300, 300))
        sizes.size(f"kingpin_{side}", (None, None, None))
        low, high = product.box(f"wheel_{side}")
        sizes.equal(f"the height of wheel_{side}'s lowest point", low[2], 0, 0.5)
        sizes.equal(f"x of wheel_{side}'s middle", (low[0] + high[0]) / 2, -450 if side == "l" else 450, 0.5)
        low, high = product.box(f"kingpin_{side}")
        sizes.equal(f"x of kingpin_{side}", (low[0] + high[0]) / 2, -350 if side == "l" else 350, 0.5)
        if product.model.jnt_limited[product.joint[f"spin_{side}"]]:
            sizes.found.append(f"spin_{side} has limits")
    sizes.span("steer", -23, 30)
    before = {side: product.pose(f"knuckle_{side}") for side in "lr"}
    for end in product.range("steer"):
        if not product.move({"steer": end}):
            continue
        left, right = (turned(product, f"knuckle_{side}", before[side], up) for side in "lr")
        stated = 30 if left > 0 else -23
        sizes.equal(f"the angle of knuckle_l where steer is {math.degrees(end):.1f}°", left, stated, 0.5)
        # Ackermann: cot(outer) = cot(inner) + kingpin distance / wheelbase; the left wheel is the inner one in a turn to the left
        cot = 1 / math.tan(math.radians(abs(stated))) + (700 / 1200 if stated > 0 else -700 / 1200)
        sizes.equal(
            f"the angle of knuckle_r where knuckle_l has {left:.1f}°", right, math.copysign(math.degrees(math.atan(1 / cot)), stated), 1
        )
    return sizes.found


def lamp(product: Product) -> list[str]:
    """Check the sizes of the lamp."""
    sizes = Sizes(product)
    product.move({})
    sizes.size("foot", (180, 180, None))
    sizes.size("bulb", (44, 44, None))
    sizes.equal("the height of the foot's lowest point", product.box("foot")[0][2], 0, 0.3)
    low, high = product.box("shade")
    sizes.equal("the diameter of the shade along x", high[0] - low[0], 120, 0.5)
    sizes.span("yaw", -170, 170)
    sizes.span("low_a", -20, 30)
    sizes.span("up_a", -40, 30)
    sizes.span("tilt", -45, 45)
    rest = {name: product.pose(name) for name in ("elbow", "head")}
    pivot = {name: 1e3 * product.data.xanchor[product.joint[name]] for name in ("low_a", "up_a")}
    sizes.equal("the height of the lower arm's pivot", pivot["low_a"][2], 120, 0.5)
    for driver, part in (("low_a", "elbow"), ("up_a", "head")):
        for end in product.range(driver):
            if not product.move({driver: end}):
                continue
            way = product.pose(part)[:3, 3] - rest[part][:3, 3]
            radius = float(np.linalg.norm(way)) / (2 * math.sin(abs(end - product.values[driver]) / 2))
            sizes.equal(f"the length of the arm that {driver} moves", radius, 300, 0.5)
    for low, high in itertools.product(product.range("low_a"), product.range("up_a")):
        if product.move({"low_a": low, "up_a": high}):
            for part, before in rest.items():
                tilt = math.degrees(math.acos(min(1.0, (np.trace(product.pose(part)[:3, :3] @ before[:3, :3].T) - 1) / 2)))
                sizes.equal(f"the tilt of {part} at the ends", tilt, 0, 0.1)
    # rest: lower arm upright, upper arm level
    product.move({})
    sizes.equal("the height of the upper arm's pivot above the lower one's", pivot["up_a"][2] - pivot["low_a"][2], 325, 0.5)
    low, high = product.box("upper_a")
    sizes.equal("the height of upper_a at rest", high[2] - low[2], 14, 0.5)
    return list(dict.fromkeys(sizes.found))


def bed(product: Product) -> list[str]:
    """Check the sizes of the wall bed."""
    sizes = Sizes(product)
    product.move({})
    sizes.size("cabinet", (1040, 350, 2300))
    low, high = product.box("cabinet")
    sizes.equal("y of the cabinet's back", high[1], 0, 0.5)
    sizes.equal("z of the cabinet's bottom", low[2], 0, 0.5)
    sizes.width("fold", 90)
    sizes.width("swing", 90)
    poses = {}
    for end in product.range("fold"):
        if product.move({"fold": end}):
            low, high = product.box("mattress")
            poses["down" if high[1] - low[1] > high[2] - low[2] else "up"] = end
    if set(poses) != {"down", "up"}:
        return [*sizes.found, "the ends of fold are not a level and an upright bed"]
    product.move({"fold": poses["down"]})
    sizes.size("mattress", (860, 1900, 120))
    sizes.equal("the width of the frame", np.ptp(product.box("frame")[:, 0]), 900, 0.5)
    sizes.equal("the length of the frame", np.ptp(product.box("frame")[:, 1]), 2000, 0.5)
    sizes.equal("the height of the mattress' underside", product.box("mattress")[0][2], 430, 0.5)
    inside, standing = [], []
    for end in product.range("swing"):
        if product.move({"fold": poses["down"], "swing": end}):
            standing.append(float(product.box("leg")[0][2]))
        if product.move({"fold": poses["up"], "swing": end}):
            inside.append(float(product.box("leg", "frame", "mattress")[0][1]))
    sizes.equal("the height of the leg's lowest point where it stands", min(standing), 0, 1)
    if max(standing) < 200:
        sizes.found.append(f"the folded leg hangs down to {max(standing):.0f} mm above the floor")
    if max(inside) < -350.5:
        sizes.found.append(f"the folded bed reaches {-max(inside):.1f} mm from the wall, more than the cabinet")
    return sizes.found


SIZES: Final[Mapping[str, Callable[[Product], list[str]]]] = {"axle": axle, "lamp": lamp, "bed": bed}


def mistakes(file: Path, kind: str, step: Path | None = None, steps: int = 7) -> list[str]:
    """Return everything that is wrong with a product's file."""
    product = Product(file, kind, step)
    if product.mistakes:
        return product.mistakes
    found = []
    if (freedoms := product.freedoms()) != FREEDOMS[kind]:
        found.append(f"it has {freedoms} freedoms, not {FREEDOMS[kind]}")
    if (loops := product.loops()) != LOOPS[kind]:
        found.append(f"it closes {loops} loops, not {LOOPS[kind]}")
    return found + SIZES[kind](product) + moved(product, steps)


def main() -> int:
    """Check a file, print its mistakes and return the exit code."""
    reader = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    reader.add_argument("product", choices=sorted(PARTS))
    reader.add_argument("model", type=Path)
    reader.add_argument("--step", type=Path)
    reader.add_argument("--steps", type=int, default=7)
    arguments = reader.parse_args()
    found = mistakes(arguments.model, arguments.product, arguments.step, arguments.steps)
    for line in found:
        print(f"  {line}")
    print(f"{arguments.product}: {len(found)} mistakes" if found else f"{arguments.product}: no mistakes")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
