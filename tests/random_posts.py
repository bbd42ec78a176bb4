"""Random mechanisms with a post in the way of one part, or just beside its way; and what is true of them by sampling densely.

Two parts have a shape, the hand and the post, so that the truth is that of one pair. The oracle is the theorem of separating axes for
convex solids, at tens of thousands of poses: each driver alone, every two on a grid, all at once.
"""

from __future__ import annotations

import contextlib
import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from articad.assembly import Assembly
from articad.connectors import SE3, Connector
from articad.errors import DeadPointError
from articad.geometry import TriMesh
from articad.geometry.part import Part
from articad.geometry.shapes import box, cylinder
from articad.kinematics import Joint, JointLimits, JointType, Mechanism
from tests.pose_equations import PoseEquations, inverse
from tests.random_mechanisms import Garden, Specimen, random_frame

FloatArray = NDArray[np.float64]

MOTIFS = ("joint", "joint", "gear", "gear", "tie", "four_bar", "parallelogram", "slider_crank", "five_bar", "ram", "bennett", "rssr")
RATIOS = (0.25, 0.5, 1.0, 2.0, 3.0)
MOST_DRIVERS = 3
HIT, CLEAR = 0.5, 0.6  # mm: posts are hit by more than this, or missed by more
AT_REST = 1.0  # mm: room at rest
TRIES = 60
SURELY_CLEAR = 2 * CLEAR  # mm
CHUNK = 2048


class Convex:
    """A convex solid: its corners, the normals of its faces and the directions of its edges."""

    def __init__(self, mesh: TriMesh) -> None:
        self.mesh, V = mesh, mesh.vertices
        self.corners = V - 0.0
        sides = V[np.roll(mesh.triangles, -1, 1)] - V[mesh.triangles]
        self.normals = _directions(np.cross(sides[:, 0], sides[:, 1]))
        self.edges = _directions(sides.reshape(-1, 3))
        self.radius = float(np.linalg.norm(V, axis=1).max())

    def depth(self, other: Convex, T: FloatArray) -> FloatArray:
        """Return by how much the other at poses `(n, 4, 4)` is in this one, negative where some plane is between them [mm].

        Where they are apart by more than `SURELY_CLEAR` any plane that shows it will do.
        """
        out: FloatArray = self.radius + other.radius - np.linalg.norm(T[:, :3, 3], axis=1)
        near = np.flatnonzero(out > -SURELY_CLEAR)
        for rows in np.array_split(near, math.ceil(len(near) / CHUNK)) if len(near) else []:
            out[rows] = self._depth(other, T[rows])
        return out

    def _depth(self, other: Convex, T: FloatArray) -> FloatArray:
        R, t, n = T[:, :3, :3], T[:, :3, 3], len(T)
        theirs = other.normals @ np.swapaxes(R, 1, 2)
        out = self._least(other, R, t, np.concatenate([np.broadcast_to(self.normals, (n, *self.normals.shape)), theirs], axis=1))
        left = np.flatnonzero(out > -SURELY_CLEAR)  # planes along an edge of each are many, and few poses need them
        if len(left):
            edges = other.edges @ np.swapaxes(R[left], 1, 2)
            across = np.cross(self.edges[None, :, None], edges[:, None]).reshape(len(left), -1, 3)
            size = np.linalg.norm(across, axis=2, keepdims=True)
            across = np.where(size > 1e-6, across / np.maximum(size, 1e-6), self.normals[0])
            out[left] = np.minimum(out[left], self._least(other, R[left], t[left], across))
        return out

    def _least(self, other: Convex, R: FloatArray, t: FloatArray, axes: FloatArray) -> FloatArray:
        """Return the least overlap along axes `(n, k, 3)` where the other is turned by `R (n, 3, 3)` and moved by `t (n, 3)`."""
        mine = self.corners @ axes.reshape(-1, 3).T  # corners first: the largest of few rows of many numbers is quick
        others = other.corners @ (axes @ R).reshape(-1, 3).T
        at = (axes @ t[:, :, None]).ravel()
        overlap = np.minimum(mine.max(0) - others.min(0) - at, others.max(0) + at - mine.min(0))
        least: FloatArray = overlap.reshape(len(t), -1).min(1)
        return least


def _directions(vectors: FloatArray) -> FloatArray:
    """Return unit vectors, each direction once."""
    unit = vectors / np.linalg.norm(vectors, axis=1, keepdims=True)
    signs = np.sign(unit[np.arange(len(unit)), np.abs(np.round(unit, 6)).argmax(1)])
    return np.asarray(np.unique(np.round(unit * signs[:, None], 9), axis=0))


@dataclass(frozen=True)
class Posted:
    """A mechanism with a post, and how deep the hand gets into it.

    Attributes:
        assembly: Under test; only `hand` and `post` have a shape.
        hand: Name of the part that moves by.
        carrier: Name of the part that carries the post.
        spans: Of each driver, all that its range covers: of an endless one its period.
        seat: Pose of the post in its carrier `(4, 4)`.
        solids: Hand and post.
        story: How the mechanism was grown, and what was aimed at.
    """

    assembly: Assembly
    hand: str
    carrier: str
    spans: dict[str, tuple[float, float]]
    seat: FloatArray
    solids: tuple[Convex, Convex]
    story: tuple[str, ...]
    deepest: dict[tuple[str, ...], float] = field(default_factory=dict)

    def depth(self, q: FloatArray) -> FloatArray:
        """Return the depth `(n,)` [mm] at drivers' values `(n, nq)`."""
        return _depth(self.assembly.mechanism, self.hand, self.carrier, self.seat, self.solids, q)

    @property
    def is_hit(self) -> bool:
        """True when the hand meets the post somewhere."""
        return max(self.deepest.values()) > HIT

    def hand_is_carried_by_the_carrier(self) -> bool:
        """Return whether one joint is between hand and carrier: what is welded to a body does not touch that body's children in MuJoCo."""
        return any({j.parent, j.child} == {self.hand, self.carrier} for j in self.assembly.joints)


def _depth(mechanism: Mechanism, hand: str, carrier: str, seat: FloatArray, solids: tuple[Convex, Convex], q: FloatArray) -> FloatArray:
    X = mechanism.poses(q).matrix
    at = X[:, mechanism.part_index(carrier)] @ seat
    return solids[1].depth(solids[0], inverse(at) @ X[:, mechanism.part_index(hand)])


def samples(
    rest: FloatArray, spans: Sequence[tuple[float, float]], names: Sequence[str], count: int, rng: np.random.Generator
) -> dict[tuple[str, ...], FloatArray]:
    """Return values of the drivers `(n, nq)`: each alone, every two on a grid, all at once; about `count` in all for each kind."""
    found: dict[tuple[str, ...], FloatArray] = {}
    for some in [*combinations(range(len(names)), 1), *combinations(range(len(names)), 2)]:
        side = max(2, round((count / math.comb(len(names), len(some))) ** (1 / len(some))))
        grid = np.meshgrid(*(np.linspace(*spans[k], side) for k in some), indexing="ij")
        q = np.tile(rest, (grid[0].size, 1))
        q[:, list(some)] = np.stack([axis.ravel() for axis in grid], axis=1)
        found[tuple(names[k] for k in some)] = q
    if len(names) > 2:
        found[tuple(names)] = np.array([rng.uniform(*span, count) for span in spans]).T
    return found


def planted_post(seed: int, count: int) -> Posted:
    """Return the mechanism and post of a seed, judged at about `count` poses of each kind: half are hit, half are missed."""
    rng = np.random.default_rng([seed, 7])
    for _ in range(TRIES):
        with contextlib.suppress(DeadPointError):  # within the drivers' ranges there is a place where loops do not close: draw another one
            found = _planted(rng, wants_hit=seed % 2 == 0, count=count)
            if found is not None:
                return found
    raise AssertionError("no such post was found")


def _planted(rng: np.random.Generator, *, wants_hit: bool, count: int) -> Posted | None:
    garden = Garden(rng, float(rng.uniform(60, 300)), ("revolute", "revolute", "slider"), RATIOS)
    wanted = int(rng.integers(2, 8))
    while len(garden.rest) < wanted:
        garden.plant(str(rng.choice(MOTIFS)))
    limited = _limited(garden.grown(), rng)
    if limited is None:
        return None
    mechanism, spans = limited
    names = [c.name for c in mechanism.drivers]
    sampled = samples(mechanism.rest, list(spans.values()), names, count // 20, rng)
    hand = str(rng.choice([name for name in mechanism.parts if name != "ground"]))
    others = [name for name in mechanism.parts if name != hand]
    carrier = "ground" if rng.random() < 0.7 else str(rng.choice(others))
    solid, post = (Convex(_shape(rng, garden.scale)) for _ in range(2))
    seat = random_frame(rng, 1.0)
    # aim: the hand at some pose of one driver, or at a corner of two, or of all
    aim = list(sampled)[rng.integers(len(sampled))]
    q = sampled[aim]
    where = q[rng.integers(len(q))] if len(aim) != 2 or rng.random() < 0.5 else q[rng.choice([0, -1])]
    X = mechanism.poses(where[None]).matrix[0]
    way = np.linalg.inv(X[mechanism.part_index(carrier)]) @ X[mechanism.part_index(hand)]
    seat[:3, 3] = way[:3, 3]
    if not wants_hit:
        all_q = np.concatenate(list(sampled.values()))
        aside = random_frame(rng, 1.0)[:3, 0]
        for step in np.linspace(0, 2 * garden.scale, 60):
            seat[:3, 3] = way[:3, 3] + step * aside
            if _depth(mechanism, hand, carrier, seat, (solid, post), all_q).max() < -CLEAR:
                break
    if _depth(mechanism, hand, carrier, seat, (solid, post), mechanism.rest[None])[0] > -AT_REST:
        return None
    story = (*garden.story, f"post on {carrier} for {hand}", f"aimed at {', '.join(aim)}")
    posted = Posted(_assembled(mechanism, hand, carrier, seat, (solid, post)), hand, carrier, spans, seat, (solid, post), story)
    if [c.name for c in posted.assembly.drivers] != names:
        return None
    for some, values in samples(mechanism.rest, list(spans.values()), names, count, rng).items():
        posted.deepest[some] = float(posted.depth(values).max())
    deepest = max(posted.deepest.values())
    return posted if (deepest > HIT if wants_hit else deepest < -CLEAR) else None


def _limited(specimen: Specimen, rng: np.random.Generator) -> tuple[Mechanism, dict[str, tuple[float, float]]] | None:
    """Return the mechanism with limits within which its drivers can be moved in any combination, and what these ranges cover."""
    free = [replace(j, limits=_unlimited(j)) for j in specimen.mechanism.joints]
    bare = _remade(specimen.mechanism, free)
    drivers = bare.drivers
    if not 1 <= len(drivers) <= MOST_DRIVERS or any(c.unit == "1" for c in drivers):
        return None
    equations = PoseEquations(bare, specimen.rest, specimen.size)
    names, spans, limits = [c.name for c in drivers], dict[str, tuple[float, float]](), dict[str, tuple[float, float]]()
    for c in drivers:
        place = equations.place[c.name]
        goals = [c.rest + sign * rng.uniform(0.4, 1.6) * (1.0 if c.unit == "rad" else 0.4 * equations.L[place]) for sign in (-1, 1)]
        low, high = (
            float(way[round(0.85 * (len(way) - 1))].s[place]) for way in (equations.follow(names, {c.name: goal}) for goal in goals)
        )
        if high - low < 0.1 * equations.L[place]:
            return None
        spans[c.name] = limits[c.name] = low, high
        period = _period(bare, equations, names, c.name)
        kind = rng.random()
        if period is not None and kind < 0.6:
            limits[c.name] = (-math.inf, math.inf) if kind < 0.35 else (-math.inf, high) if kind < 0.5 else (low, math.inf)
            spans[c.name] = (high - period, high) if kind < 0.5 else (low, low + period)
    for corner in np.array(np.meshgrid(*spans.values())).reshape(len(names), -1).T if len(names) > 1 else []:
        goal = {
            name: float(np.clip(value, *np.add(bare.rest[k], (-2, 2)))) if limits[name] != spans[name] else value
            for k, (name, value) in enumerate(zip(names, corner, strict=True))
        }
        way = equations.follow(names, goal)
        if any(abs(way[-1].s[equations.place[name]] - value) > 1e-9 for name, value in goal.items()):
            return None
    joints = [replace(j, limits=_limits(j, limits)) if j.type is not JointType.BALL else j for j in free]
    return _remade(specimen.mechanism, joints), spans


def _period(mechanism: Mechanism, equations: PoseEquations, names: Sequence[str], driver: str) -> float | None:
    """Return after how far [rad] an angle and all that it is coupled to come back; None where something slides or closes a loop."""
    way = equations.follow(names, {driver: equations.rest.s[equations.place[driver]] + 0.12})
    moved = {
        name: (way[-1].s[at] - way[0].s[at]) / 0.12 for name, at in equations.place.items() if abs(way[-1].s[at] - way[0].s[at]) > 1e-9
    }
    kinds = {j.name: j.type for j in mechanism.joints}
    loops = {name for loop in (mechanism.branch.system.loops if mechanism.loop_joints else ()) for name in (j.name for j in loop.joints)}
    if len(way) < 2 or any(kinds.get(name) is not JointType.REVOLUTE or name in loops for name in moved):
        return None
    ratios = [Fraction(ratio).limit_denominator(1000) for ratio in moved.values()]
    turns = math.lcm(*(ratio.denominator for ratio in ratios))
    return 2 * math.pi * turns if turns <= 64 else None


def _unlimited(joint: Joint) -> JointLimits:
    count = len(joint.limits.lower)
    return joint.limits if joint.type is JointType.BALL else JointLimits((-math.inf,) * count, (math.inf,) * count)


def _limits(joint: Joint, limits: dict[str, tuple[float, float]]) -> JointLimits:
    bounds = [limits.get(name, (-math.inf, math.inf)) for name in joint.column_names]
    return JointLimits(tuple(low for low, _ in bounds), tuple(high for _, high in bounds))


def _remade(mechanism: Mechanism, joints: Sequence[Joint]) -> Mechanism:
    return Mechanism(mechanism.parts, mechanism.ground, joints, mechanism.couplings, T_ground=mechanism.T_ground)


def _shape(rng: np.random.Generator, scale: float) -> TriMesh:
    x, y, z = (float(side) for side in scale * rng.uniform(0.06, 0.3, 3))
    return box(x, y, z) if rng.random() < 0.6 else cylinder(x / 2, y, int(rng.integers(5, 9)))


def _assembled(mechanism: Mechanism, hand: str, carrier: str, seat: FloatArray, solids: tuple[Convex, Convex]) -> Assembly:
    """Return the mechanism with the post fixed to its carrier, and the shapes."""
    place = Joint(
        name="post_seat", type=JointType.FIXED, parent=carrier, child="post", parent_connector="seat", child_connector="foot",
        T_parent_connector=SE3.from_matrix(seat), T_child_connector=SE3.identity(), limits=JointLimits(), rest=(),
    )  # fmt: skip
    joints = [*mechanism.joints, place]
    connectors: dict[str, dict[str, Connector]] = {name: {} for name in (*mechanism.parts, "post")}
    for j in joints:
        connectors[j.parent][j.parent_connector] = Connector(j.parent_connector, j.T_parent_connector)
        connectors[j.child][j.child_connector] = Connector(j.child_connector, j.T_child_connector)
    shapes = {hand: solids[0].mesh, "post": solids[1].mesh}
    parts = [
        Part.from_mesh(name, shapes[name], density=7850.0, connectors=own) if name in shapes else Part.without_geometry(name, own)
        for name, own in connectors.items()
    ]
    return Assembly.from_parts(
        "posted", parts=parts, joints=joints, ground=mechanism.ground, couplings=mechanism.couplings, T_ground=mechanism.T_ground
    )
