"""Check of what a level surface carries: the board below it is a beam on what holds it, as its shapes say."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

from articad.arrays import FloatArray
from articad.geometry import TriMesh
from articad.kinematics.joints import JointType
from articad_bench.check import Bounds, Check, in_words
from articad_bench.subject import Subject

G: Final = 9.81  # m/s²
FLOOR_MM: Final = 0.2  # a part so near the ground stands on it
TOUCH_MM: Final = 0.3  # parts so near each other touch
PLAY_MM: Final = 0.6  # as far as a pin may be from its bore
UP: Final = 0.999  # cosine of the lean of a level surface
LEVEL_MM: Final = 0.05  # triangles within this height are one surface
STATIONS: Final = 60  # along a beam
STRIP: Final = 1 / 3  # of the width of a board: its middle, which what lies all round it does not carry both ways
TURNS: Final = 0.5  # cosine of the angle of a pin to the line about which a board bends, from which it lets the board turn
CLAMPED: Final = 2.0  # times the thickness of a board: what is fixed to it along more than this, or half of it, does not let it turn
_PINS: Final = frozenset({JointType.REVOLUTE, JointType.CYLINDRICAL, JointType.SCREW, JointType.BALL, JointType.UNIVERSAL})
SINGULAR: Final = 1e12  # condition of a beam that nothing holds


Held = NDArray[np.bool_]
"""At which nodes of a beam something holds it."""


class Top(NamedTuple):
    """A level surface of a part.

    Attributes:
        part: Its name.
        height: Above the lowest point of the product [mm].
        area: [mm²].
        sides: Of the least rectangle around it, ascending `(2,)` [mm].
        ways: Directions of the longer and the shorter side `(2, 2)`.
        centre: Middle of the surface in the frame of the whole `(3,)` [mm].
    """

    part: str
    height: float
    area: float
    sides: FloatArray
    ways: FloatArray
    centre: FloatArray


class Carries(Check):
    """A number of boards at one height carry a load, by the bending stress and the sag of a beam (Euler and Bernoulli).

    A board is a part with a level top of at least these sides. Its section is measured all along it. Parts that reach the ground, or the product's fixed
    part, without this board carry it where they touch it: what only touches it from below pushes, what is fixed to it holds both ways, and
    does not let it turn where it reaches along twice the thickness of the board, or half of it, and a pin lets it turn about its axis. Both directions of the
    board are looked at, and the worse one counts; what lies all round a board carries the middle third of it in the better direction. The load
    lies evenly on the whole board, or on any one place of it.

    Attributes:
        kg: Load on each board.
        level: Height of its top [mm].
        top: Its least sides [mm].
        number: Of boards that carry it.
        stress: Largest bending stress that its material bears [N/mm²].
        modulus: Of elasticity of its material [N/mm²].
        sag: Largest sag [mm]; None where any is accepted.
        anywhere: Whether the load stands on the worst place.
    """

    kind: Literal["carries"] = "carries"
    kg: float
    level: Bounds
    top: tuple[float, float] = (0.0, 0.0)
    number: Bounds = (1, 999)
    stress: float
    modulus: float
    sag: float | None = None
    anywhere: bool = False

    @property
    def wanted(self) -> str:
        where = f"{in_words(self.level)} mm high, {self.top[0]:g} x {self.top[1]:g} mm or larger"
        sag = "" if self.sag is None else f" and {self.sag:g} mm of sag"
        load = f"{self.kg:g} kg {'anywhere' if self.anywhere else 'each'}"
        return f"{in_words(self.number)} boards {where} that carry {load} at {self.stress:g} N/mm²{sag} (modulus {self.modulus:g} N/mm²)"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        tops = [self._top(subject, name) for name in subject.shaped]
        found = [(top, bending(subject, top, self.kg, self.modulus, anywhere=self.anywhere)) for top in tops if top is not None]
        good = [bent for _, bent in found if bent is not None and bent.stress <= self.stress and (self.sag is None or bent.sag <= self.sag)]
        told = "; ".join(f"{top.part} {_in_words(bent)}" for top, bent in found)
        return self.number[0] <= len(good) <= self.number[1], f"{len(good)} ({told or 'no such board'})"

    def _top(self, subject: Subject, name: str) -> Top | None:
        """Return the largest surface of a part at that height, if it is large enough and mostly there."""
        wanted = sorted(self.top)
        there = [top for top in level_tops(subject, name) if self.level[0] <= top.height <= self.level[1]]
        large = [top for top in there if (top.sides >= np.array(wanted) - FLOOR_MM).all() and top.area >= wanted[0] * wanted[1] / 2]
        return max(large, key=lambda top: top.area, default=None)


class Bent(NamedTuple):
    """Largest bending stress [N/mm²] and sag [mm] of a board."""

    stress: float
    sag: float


def _in_words(bent: Bent | None) -> str:
    return "is not held" if bent is None else f"{bent.stress:.3g} N/mm², {bent.sag:.3g} mm"


def level_tops(subject: Subject, name: str) -> list[Top]:
    """Return the level surfaces of a part at rest that face upwards."""
    mesh = _placed(subject, name)
    normals = mesh.normals_of_twice_area
    area = np.linalg.norm(normals, axis=1) / 2
    chosen = np.flatnonzero((area > 0) & (normals[:, 2] > 2 * UP * area))
    heights = mesh.vertices[mesh.triangles[chosen]].mean(axis=1)[:, 2]
    ground = float(subject.corners(subject.rest)[0][2])
    tops = []
    for level in np.unique(np.round(heights / LEVEL_MM)):
        rows = chosen[np.round(heights / LEVEL_MM) == level]
        points = mesh.vertices[mesh.triangles[rows]]
        sides, ways = _rectangle(points.reshape(-1, 3)[:, :2])
        middle = np.average(points.mean(axis=1), axis=0, weights=area[rows])
        tops.append(Top(name, float(middle[2]) - ground, float(area[rows].sum()), sides, ways, middle))
    return tops


def _rectangle(points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the sides of the least rectangle around points, ascending, and the directions of its longer and its shorter side."""
    try:
        corners = points[ConvexHull(points).vertices]
    except QhullError:
        return np.zeros(2), np.eye(2)
    edges = np.roll(corners, -1, axis=0) - corners
    best = None
    for angle in np.unique(np.round(np.mod(np.arctan2(edges[:, 1], edges[:, 0]), math.pi / 2), 6)):
        ways = np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
        sides = np.ptp(corners @ ways.T, axis=0)
        if best is None or sides.prod() < best[0].prod() - 1e-9:
            best = sides, ways
    assert best is not None
    order = np.argsort(-best[0], kind="stable")
    return np.sort(best[0]), best[1][order]


def bending(subject: Subject, top: Top, kg: float, modulus: float, *, anywhere: bool = False) -> Bent | None:
    """Return how a load bends a board, in the worse of its two directions; None if nothing holds it there.

    Args:
        subject: The assembly.
        top: Surface of the board.
        kg: Load.
        modulus: Of elasticity [N/mm²].
        anywhere: Whether the load stands on the worst place, in place of evenly on the whole board.
    """
    carriers = _carriers(subject, top.part)
    mesh = _placed(subject, top.part)
    whole: list[Bent | None] = []
    strips: list[Bent | None] = []
    for way, across in (top.ways, top.ways[::-1]):
        axis, beside = (np.append(each, 0.0) for each in (way, across))
        ends = mesh.vertices @ beside
        middle, half = float(ends.min() + ends.max()) / 2, STRIP * float(np.ptp(ends)) / 2
        for limits in (None, (beside, middle - half, middle + half)):
            supports = [row for name in carriers for row in _supports(subject, top.part, name, axis, limits)]
            bent = _beam(mesh, axis, supports, kg * G, modulus, anywhere=anywhere)
            (whole if limits is None else strips).append(bent)
    if None in whole:
        return None
    worse = [bent for bent in whole if bent is not None]
    if held := [bent for bent in strips if bent is not None]:
        worse.append(min(held))
    return Bent(max(bent.stress for bent in worse), max(bent.sag for bent in worse))


# ---------------------------------------------------------------------- what carries a board


class Support(NamedTuple):
    """A stretch along a board where something carries it.

    Attributes:
        low: Its beginning [mm].
        high: Its end [mm].
        both_ways: Whether it holds the board down as well; then it does not let it turn where it is longer than a point.
    """

    low: float
    high: float
    both_ways: bool


def _placed(subject: Subject, name: str) -> TriMesh:
    mesh = subject.assembly.parts[name].mesh
    assert mesh is not None
    return mesh.transformed(subject.rest[name])


def _near(subject: Subject, name: str, within: float) -> set[str]:
    """Return the parts so near a part at rest."""
    low, high = subject.corners(subject.rest, [name])
    found = set()
    for other in subject.shaped:
        ends = subject.corners(subject.rest, [other])
        if other != name and (ends[0] <= high + within).all() and (ends[1] >= low - within).all() and subject.apart(name, other) <= within:
            found.add(other)
    return found


def _carriers(subject: Subject, board: str) -> list[str]:
    """Return the parts beside a board that reach the ground, or the part that stands still, without it."""
    floor = float(subject.corners(subject.rest)[0][2]) + FLOOR_MM
    low = [name for name in subject.shaped if float(subject.corners(subject.rest, [name])[0][2]) <= floor]
    reached = ({subject.assembly.ground, *low}) - {board}
    around: dict[str, set[str]] = {name: _near(subject, name, TOUCH_MM) for name in subject.shaped}
    for joint in subject.assembly.joints:
        around.setdefault(joint.parent, set()).add(joint.child)
        around.setdefault(joint.child, set()).add(joint.parent)
    fresh = set(reached)
    while fresh:
        fresh = {other for name in fresh for other in around.get(name, ())} - reached - {board}
        reached |= fresh
    jointed = {name for joint in subject.assembly.joints if board in (joint.parent, joint.child) for name in (joint.parent, joint.child)}
    beside = (_near(subject, board, TOUCH_MM) | (_near(subject, board, PLAY_MM) & jointed)) - {board}
    return [name for name in subject.shaped if name in beside & reached]


def _supports(subject: Subject, name: str, carrier: str, axis: FloatArray, strip: tuple[FloatArray, float, float] | None) -> list[Support]:
    """Return where along an axis a part carries a board: within a strip of it, beside which nothing counts, or anywhere across it."""
    board = _placed(subject, name)
    fixed = subject.rigid[name] == subject.rigid[carrier]
    joints = [j for j in subject.assembly.joints if {j.parent, j.child} == {name, carrier} and j.type is not JointType.FIXED]
    low, high = board.bounds
    near = PLAY_MM if joints and not fixed else TOUCH_MM
    top = high[2] + near if fixed or joints else low[2] + near  # else it only pushes
    walls = [(np.eye(3)[i], low[i] - near, high[i] + near) for i in range(2)] + [(np.eye(3)[2], low[2] - near, top)]
    ends = board.vertices @ axis
    start, end = float(ends.min()), float(ends.max())
    spans = _merged(
        [
            np.clip(points @ axis, start, end) - start
            for points in _clipped(_placed(subject, carrier), [*walls, *([strip] if strip else [])])
        ]
    )
    if fixed:
        middle, least = (end - start) / 2, min(CLAMPED * float(high[2] - low[2]), (end - start) / 2)
        points = [min(max(middle, a), b) for a, b in spans]
        return [
            Support(a, b, both_ways=True) if b - a >= least else Support(at, at, both_ways=True)
            for (a, b), at in zip(spans, points, strict=True)
        ]
    if joints and spans:
        beside = np.cross([0.0, 0.0, 1.0], axis)
        pins = [joint for joint in joints if joint.type in _PINS and abs(float(subject.axis(joint) @ beside)) > TURNS]
        places = [subject.rest[pin.parent] @ pin.T_parent_connector for pin in pins]
        turning = [float(np.clip(place.translation @ axis, start, end)) - start for place in places]
        return [Support(at, at, both_ways=True) for at in turning] or [Support(a, b, both_ways=True) for a, b in spans]
    return [Support(a, b, both_ways=False) for a, b in spans]


def _merged(rows: Sequence[FloatArray]) -> list[tuple[float, float]]:
    """Return the stretches that pieces of a surface cover together, from their values along an axis."""
    found: list[tuple[float, float]] = []
    for low, high in sorted((float(row.min()), float(row.max())) for row in rows):
        if found and low <= found[-1][1] + TOUCH_MM:
            found[-1] = found[-1][0], max(high, found[-1][1])
        else:
            found.append((low, high))
    return found


def _clipped(mesh: TriMesh, walls: Sequence[tuple[FloatArray, float, float]]) -> list[FloatArray]:
    """Return the corners of what of each triangle lies between pairs of planes, each given by its normal and two distances, `(n, 3)` [mm]."""
    corners = mesh.vertices[mesh.triangles]
    for normal, low, high in walls:
        along = corners @ normal
        corners = corners[(along.min(axis=1) <= high) & (along.max(axis=1) >= low)]
    found = []
    for triangle in corners:
        polygon = list(triangle)
        for normal, low, high in walls:
            polygon = _cut(_cut(polygon, normal, low), -normal, -high)
        if polygon:
            found.append(np.array(polygon))
    return found


def _cut(polygon: Sequence[FloatArray], normal: FloatArray, limit: float) -> list[FloatArray]:
    """Return the piece of a polygon beyond a plane."""
    kept = []
    for a, b in zip(polygon, [*polygon[1:], *polygon[:1]], strict=True):
        before, after = float(normal @ a) - limit, float(normal @ b) - limit
        if before >= 0:
            kept.append(a)
        if before * after < 0:
            kept.append(a + before / (before - after) * (b - a))
    return kept


# ---------------------------------------------------------------------- the beam


class Section(NamedTuple):
    """A section: second moment about its level axis [mm⁴], and distance of its farthest point from that axis [mm]."""

    moment: float
    edge: float


def section(mesh: TriMesh, axis: FloatArray, at: float) -> Section:
    """Return the section of a solid across an axis, `at` from the origin along it [mm].

    Green's theorem over the segments in which triangles cross the plane: the solid lies on the left of each.
    """
    side = mesh.vertices @ axis - at
    sides = side[mesh.triangles]
    crossed = (sides.min(axis=1) < 0) & (sides.max(axis=1) >= 0)
    if not crossed.any():
        return Section(0.0, 0.0)
    corners, sides = mesh.vertices[mesh.triangles[crossed]], sides[crossed]
    across = np.cross([0.0, 0.0, 1.0], axis)
    below = sides < 0
    starts, ends = np.empty((len(corners), 2)), np.empty((len(corners), 2))
    for i in range(3):
        j = (i + 1) % 3
        with np.errstate(divide="ignore", invalid="ignore"):
            points = corners[:, i] + (sides[:, i] / (sides[:, i] - sides[:, j]))[:, None] * (corners[:, j] - corners[:, i])
        flat = np.stack([points @ across, points[:, 2]], axis=1)
        starts[below[:, i] & ~below[:, j]] = flat[below[:, i] & ~below[:, j]]
        ends[~below[:, i] & below[:, j]] = flat[~below[:, i] & below[:, j]]
    z0 = float(starts[:, 1].mean())
    (y1, z1), (y2, z2) = starts.T - [[0.0], [z0]], ends.T - [[0.0], [z0]]
    cross = y1 * z2 - y2 * z1
    area = float(cross.sum()) / 2
    if abs(area) < 1e-9:
        return Section(0.0, 0.0)
    first = float((cross * (z1 + z2)).sum()) / 6
    second = float((cross * (z1 * z1 + z1 * z2 + z2 * z2)).sum()) / 12
    centre = first / area
    heights = np.concatenate([z1, z2]) - centre
    return Section(abs(second - area * centre * centre), float(np.abs(heights).max()))


def _beam(mesh: TriMesh, axis: FloatArray, supports: Sequence[Support], force: float, modulus: float, *, anywhere: bool) -> Bent | None:
    """Return stress and sag of a beam of measured sections under a force [N]; None if its supports do not hold it."""
    ends = mesh.vertices @ axis
    start, length = float(ends.min()), float(np.ptp(ends))
    nodes = _nodes(length, supports)
    lengths = np.diff(nodes)
    sections = [section(mesh, axis, start + float(at)) for at in (nodes[:-1] + nodes[1:]) / 2]
    if any(each.moment <= 0 for each in sections):
        return None
    stiff = modulus * np.array([each.moment for each in sections])
    weights = np.array([each.edge / each.moment for each in sections])
    both, pushes, clamps = (np.zeros(len(nodes), dtype=bool) for _ in range(3))
    for row in supports:
        there = (nodes >= row.low - 1e-6) & (nodes <= row.high + 1e-6)
        both |= there & row.both_ways
        pushes |= there & (not row.both_ways)
        clamps |= there & (row.both_ways and row.high > row.low)
    loads = []
    if anywhere:
        for node in range(len(nodes)):
            load = np.zeros(2 * len(nodes))
            load[2 * node] = force
            loads.append((load, 0.0))
    else:
        loads.append((_even(nodes, force / length), force / length))
    worst = Bent(0.0, 0.0)
    for load, density in loads:
        bent = _solved(lengths, stiff, weights, (load, density), both, pushes, clamps)
        if bent is None:
            return None
        worst = Bent(max(worst.stress, bent.stress), max(worst.sag, bent.sag))
    return worst


def _nodes(length: float, supports: Sequence[Support]) -> FloatArray:
    fixed = np.unique(np.round([0.0, length, *(end for row in supports for end in (row.low, row.high))], 6))
    even = np.linspace(0.0, length, STATIONS + 1)
    free = even[np.abs(even[:, None] - fixed[None]).min(axis=1) > length / (4 * STATIONS)]
    nodes = np.sort(np.concatenate([fixed, free]))
    return np.asarray(nodes[np.append(True, np.diff(nodes) > 1e-4 * length)])


def _even(nodes: FloatArray, density: float) -> FloatArray:
    """Return the forces and moments at the nodes that an even load [N/mm] stands for."""
    load = np.zeros(2 * len(nodes))
    for i, h in enumerate(np.diff(nodes)):
        load[2 * i : 2 * i + 4] += density * np.array([h / 2, h * h / 12, h / 2, -h * h / 12])
    return load


def _stiffness(h: float, stiff: float) -> FloatArray:
    """Return the stiffness of a piece of a beam for deflection and slope of both ends."""
    rows = [
        [12, 6 * h, -12, 6 * h],
        [6 * h, 4 * h * h, -6 * h, 2 * h * h],
        [-12, -6 * h, 12, -6 * h],
        [6 * h, 2 * h * h, -6 * h, 4 * h * h],
    ]
    return np.asarray(stiff / h**3 * np.array(rows))


def _solved(
    lengths: FloatArray,
    stiff: FloatArray,
    weights: FloatArray,
    loaded: tuple[FloatArray, float],
    both: Held,
    pushes: Held,
    clamps: Held,
) -> Bent | None:
    """Return stress and sag; supports that only push let go one after the other where they would have to pull."""
    load, density = loaded
    count = len(load)
    K = np.zeros((count, count))
    for i, (h, k) in enumerate(zip(lengths, stiff, strict=True)):
        K[2 * i : 2 * i + 4, 2 * i : 2 * i + 4] += _stiffness(float(h), float(k))
    holding = both | pushes
    scale = np.where(np.arange(count) % 2 == 0, 1.0, 1 / float(lengths.sum()))  # slopes by length, so that all are of one size
    while True:
        free = np.ones(count, dtype=bool)
        free[::2], free[1::2] = ~holding, ~clamps
        scaled = (K * np.outer(scale, scale))[np.ix_(free, free)]
        if not holding.any() or (free.any() and np.linalg.cond(scaled) > SINGULAR):
            return None
        moved = np.zeros(count)
        moved[free] = scale[free] * np.linalg.solve(scaled, scale[free] * load[free])
        push = (load - K @ moved)[::2]  # of each support, upwards
        least = int(np.where(holding & ~both, push, np.inf).argmin())
        if not (holding & ~both).any() or push[least] >= -1e-9 * max(1.0, float(np.abs(push).max())):
            break
        holding[least] = False
    stress = 0.0
    for i, (h, k) in enumerate(zip(lengths, stiff, strict=True)):
        even = density * np.array([h / 2, h * h / 12, h / 2, -h * h / 12])
        ends = _stiffness(float(h), float(k)) @ moved[2 * i : 2 * i + 4] - even
        stress = max(stress, float(weights[i]) * max(abs(float(ends[1])), abs(float(ends[3]))))
    return Bent(stress, float(np.abs(moved[::2]).max()))
