"""Check of what a level surface carries: the board below it is a beam on what holds it, as its shapes say."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final, Literal, NamedTuple

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from articad.arrays import FloatArray, IntArray
from articad.geometry import TriMesh
from articad.kinematics.joints import Joint, JointType
from articad_bench.beams import Bent, Support, beam
from articad_bench.check import Bounds, Check, in_words, within
from articad_bench.subject import Subject

G: Final = 9.81  # m/s²
FLOOR_MM: Final = 0.2  # a part so near the ground stands on it
TOUCH_MM: Final = 0.3  # parts so near each other touch
PLAY_MM: Final = 0.6  # as far as a pin may be from its bore
UP: Final = 0.999  # cosine of the lean of a level surface
LEVEL_MM: Final = 0.05  # triangles within this height are one surface
STRIP: Final = 1 / 3  # of the width of a board: its middle, which what lies all round it does not carry both ways
TURNS: Final = 0.5  # cosine of the angle of a pin to the line about which a board bends, from which it lets the board turn
CLAMPED: Final = 2.0  # times the thickness of a board: what is fixed to it along so much, or along half of the board, does not let it turn
_PINS: Final = frozenset({JointType.REVOLUTE, JointType.CYLINDRICAL, JointType.SCREW, JointType.BALL, JointType.UNIVERSAL})


class Top(NamedTuple):
    """A level surface of a part.

    Attributes:
        part: Its name.
        height: Above the lowest point of the product [mm].
        area: [mm²].
        sides: Of the least rectangle around it, ascending `(2,)` [mm].
        ways: Directions of the longer and the shorter side `(2, 2)`.
        centre: Middle of the surface in the frame of the whole `(3,)` [mm].
        corners: Of its triangles, seen from above `(n, 2)` [mm].
    """

    part: str
    height: float
    area: float
    sides: FloatArray
    ways: FloatArray
    centre: FloatArray
    corners: FloatArray


class Carries(Check):
    """A number of boards at one height carry a load, by the bending stress and the sag of a beam (Euler and Bernoulli).

    A board is a part with a level top of at least these sides. Its section is measured all along it. Parts that reach the ground, or the product's fixed
    part, without this board carry it where they touch it: what only touches it from below pushes, what is fixed to it holds both ways, and
    does not let it turn where it reaches along twice the thickness of the board, or along half of the board, and a pin lets it turn about its axis.
    Both directions of the board are looked at, and the worse one counts; what lies all round a board carries the middle third of it in the better
    direction. What carries the board is taken for rigid, however thin it is. The load lies evenly on the whole surface, or on any one place of it.

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
        there = [top for top in level_tops(subject, name) if within(top.height, self.level)]
        large = [top for top in there if (top.sides >= np.array(wanted) - FLOOR_MM).all() and top.area >= wanted[0] * wanted[1] / 2]
        return max(large, key=lambda top: top.area, default=None)


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
    for rows in _levels(heights, chosen):
        points = mesh.vertices[mesh.triangles[rows]]
        sides, ways = _rectangle(points.reshape(-1, 3)[:, :2])
        middle = np.average(points.mean(axis=1), axis=0, weights=area[rows])
        tops.append(Top(name, float(middle[2]) - ground, float(area[rows].sum()), sides, ways, middle, points.reshape(-1, 3)[:, :2]))
    return tops


def _levels(heights: FloatArray, chosen: IntArray) -> list[IntArray]:
    """Return triangles in groups of one level, from below; each group begins at its lowest triangle."""
    groups: list[list[int]] = []
    low = -math.inf
    for at in np.argsort(heights, kind="stable"):
        if heights[at] > low + LEVEL_MM:
            low = float(heights[at])
            groups.append([])
        groups[-1].append(int(chosen[at]))
    return [np.array(group) for group in groups]


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
            bent = beam(
                mesh,
                axis,
                supports,
                kg * G,
                modulus,
                (float((top.corners @ way).min()), float((top.corners @ way).max())),
                anywhere=anywhere,
            )
            (whole if limits is None else strips).append(bent)
    if None in whole:
        return None
    worse = [bent for bent in whole if bent is not None]
    if held := [bent for bent in strips if bent is not None]:
        worse.append(min(held))
    return Bent(max(bent.stress for bent in worse), max(bent.sag for bent in worse))


# ---------------------------------------------------------------------- what carries a board


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
    jointed |= {name for name in subject.shaped if _joints_between(subject, board, name)}
    beside = (_near(subject, board, TOUCH_MM) | (_near(subject, board, PLAY_MM) & jointed)) - {board}
    return [name for name in subject.shaped if name in beside & reached]


def _joints_between(subject: Subject, board: str, carrier: str) -> list[Joint]:
    """Return the joints between a part and the body of a board: the pin of its hinge may be fixed to it."""
    body = subject.rigid[board]
    sides = ((joint, {joint.parent, joint.child}) for joint in subject.assembly.joints if joint.type is not JointType.FIXED)
    return [joint for joint, ends in sides if carrier in ends and body in {subject.rigid[name] for name in ends - {carrier}}]


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
