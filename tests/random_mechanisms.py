"""Random mechanisms: trees of all joint types, with loops and couplings planted anywhere.

A mechanism grows at its rest pose, from the ground part on. Each step plants a motif (a joint, a four-bar, a gear, …) on some part that
is there already: on the ground, on an arm, on the coupler of another loop. A motif gives the frames of its joints in the world at rest,
and every part has a frame of its own, so all loops close at rest by construction. The motif also says how many freedoms it adds.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from articad.connectors import SE3, Mate
from articad.kinematics import Coupling, Joint, JointLimits, JointType, Mechanism
from tests.pose_equations import FLIP, joint_motion

FloatArray = NDArray[np.float64]
Point = tuple[float, float]
Place = Callable[[FloatArray], FloatArray]  # from a frame of a motif to the world

MOST_PARTS = 12
LINES = (1.0, 1e4)  # mm: mechanisms are from 1 mm to 10 m large
INF = math.inf
RATIOS = (0.25, 0.5, 1.0, 2.0, math.sqrt(2), None)
KINDS = tuple(kind for kind in JointType if kind is not JointType.FREE)
AFLOAT = 100_000  # the first seed of mechanisms with free joints: one below all the rest, and others anywhere


@dataclass(frozen=True)
class Specimen:
    """A random mechanism and what its generator knows of it.

    Attributes:
        mechanism: Under test.
        rest: Pose `(4, 4)` of each part at rest [mm].
        size: Length scale [mm] of each part's motif.
        freedoms: Mobility in general position.
        story: The motifs, each with the part that carries it; for messages.
    """

    mechanism: Mechanism
    rest: dict[str, FloatArray]
    size: dict[str, float]
    freedoms: int
    story: tuple[str, ...]


def random_mechanism(seed: int) -> Specimen:
    """Return the mechanism of a seed; with free joints from `AFLOAT` on."""
    afloat = seed >= AFLOAT
    garden = Garden(np.random.default_rng(seed), kinds=(*KINDS, *[JointType.FREE] * 3) if afloat else KINDS)
    wanted = int(garden.rng.integers(2, MOST_PARTS + 1))
    if afloat and garden.rng.random() < 0.6:
        garden.float_off()
    while len(garden.rest) < wanted:
        garden.plant(str(garden.rng.choice(list(MOTIFS), p=np.array(list(MOTIFS.values())) / sum(MOTIFS.values()))))
    return garden.grown()


class Garden:
    """Where a mechanism grows.

    Args:
        rng: Makes all choices.
        scale: Length [mm] of a typical motif; drawn by default.
        kinds: Of single joints.
        ratios: Of couplings, but for their units; None stands for any number.
    """

    def __init__(
        self,
        rng: np.random.Generator,
        scale: float | None = None,
        kinds: Sequence[str] = KINDS,
        ratios: Sequence[float | None] = RATIOS,
    ) -> None:
        self.rng, self.kinds, self.ratios = rng, kinds, ratios
        self.scale = math.exp(rng.uniform(*np.log(LINES))) if scale is None else scale
        self.rest: dict[str, FloatArray] = {"ground": random_frame(rng, self.scale)}
        self.size = {"ground": self.scale}
        self.joints: dict[str, Joint] = {}
        self.couplings: list[Coupling] = []
        self.freedoms = 0
        self.story: list[str] = []
        self._hinges: list[tuple[str, FloatArray]] = []  # revolute joints of the tree that a ram may drive, each with its frame
        self._flats: list[tuple[list[str], Place, float]] = []  # planar loops: links, place of a frame, size
        self._groups: dict[str, int] = {}  # of each joint: joints of one group are tied by loops or couplings

    def grown(self) -> Specimen:
        """Return the mechanism, its parts and joints declared in random order."""
        parts, names = (self.rng.permutation(list(found)).tolist() for found in (self.rest, self.joints))
        mechanism = Mechanism(
            parts, "ground", [self.joints[name] for name in names], self.couplings, T_ground=SE3.from_matrix(self.rest["ground"])
        )
        return Specimen(mechanism, self.rest, self.size, self.freedoms, tuple(self.story))

    # --- growing

    def plant(self, motif: str, carrier: str | None = None) -> None:
        """Plant a motif on a part, by default on the newest one or on any; nothing where there is no room or nothing to plant it on."""
        carrier = carrier or (list(self.rest)[-1] if self.rng.random() < 0.4 else str(self.rng.choice(list(self.rest))))
        size = self.scale * self.rng.uniform(0.4, 1.2) * (0.02 if self.rng.random() < 0.1 else 1.0)
        before = len(self.joints)
        room = MOST_PARTS - len(self.rest)
        if room < NEW_PARTS.get(motif, 1) and not (motif == "stewart" and len(self.rest) <= 3):
            return
        at, hand = self.rest[carrier] @ random_frame(self.rng, self.size[carrier]), np.diag([1.0, self.rng.choice([-1.0, 1.0]), 1.0, 1.0])
        getattr(self, f"_{motif}")(carrier, lambda local: at @ hand @ local @ hand, size)  # `hand` mirrors half of the motifs
        if len(self.joints) > before:
            self.story.append(f"{motif} on {carrier}: {', '.join(list(self.joints)[before:])}")

    def float_off(self) -> None:
        """Put all that grows from now on onto a part that a free joint carries, but for what is planted on the ground by chance."""
        at = self.rest["ground"] @ random_frame(self.rng, self.scale)
        name = self.join("free", "ground", self.sprout(at, self.scale), at, self.scale)
        self.freedoms += JointType.FREE.freedoms
        self.story.append(f"{name} carries the rest")

    def sprout(self, at: FloatArray, size: float) -> str:
        """Return a new part with a random frame near a place."""
        name = f"part{len(self.rest)}"
        self.rest[name], self.size[name] = at @ random_frame(self.rng, size), size
        return name

    def join(self, kind: str, a: str, b: str, at: FloatArray, size: float, *, driver: bool = False, free: bool = False) -> str:
        """Join two parts at a frame of the world at rest; with random rest values, mate and direction, and without limits if `free`."""
        rng, joint_type, name = self.rng, JointType(kind), f"{kind}{len(self.joints)}"
        if joint_type.reversible and rng.random() < 0.3:
            a, b = b, a
        lead = size * rng.uniform(0.1, 0.5) * rng.choice([-1, 1]) if kind == "screw" else 0.0
        rest = random_rest(rng, joint_type, size)
        mate = Mate.OPPOSED if rng.random() < 0.3 else Mate.ALIGNED
        far = at @ joint_motion(joint_type, rest, lead) @ (FLIP if mate is Mate.OPPOSED else np.eye(4))
        self.joints[name] = Joint(
            name=name,
            type=joint_type,
            parent=a,
            child=b,
            parent_connector=f"{name}_near",
            child_connector=f"{name}_far",
            T_parent_connector=SE3.from_matrix(np.linalg.inv(self.rest[a]) @ at),
            T_child_connector=SE3.from_matrix(np.linalg.inv(self.rest[b]) @ far),
            mate=mate,
            limits=random_limits(rng, joint_type, rest, size, free=free),
            rest=tuple(rest),
            lead=lead,
            driver=driver and joint_type not in {JointType.FIXED, JointType.FREE},
        )
        self._groups[name] = len(self.joints)
        return name

    def ring(
        self, carrier: str, joints: Sequence[tuple[str, FloatArray]], size: float, freedoms: int, drivers: Sequence[int] = (0,)
    ) -> list[str]:
        """Close a loop from a part over new links back to it: a joint of a kind at each frame; return the links, the carrier first."""
        links = [carrier, *(self.sprout(frame, size) for _, frame in joints[1:])]
        marked = self.rng.random() < 0.85
        ends = zip(links, [*links[1:], carrier], strict=True)
        names = [
            self.join(kind, a, b, frame, size, driver=marked and i in drivers, free=i not in drivers or not marked)
            for i, ((kind, frame), (a, b)) in enumerate(zip(joints, ends, strict=True))
        ]
        self._unite(names)
        self.freedoms += freedoms
        return links

    def _unite(self, names: Sequence[str]) -> None:
        groups = {self._groups[name] for name in names}
        self._groups = {name: min(groups) if group in groups else group for name, group in self._groups.items()}

    def _mark(self, name: str, *, driver: bool) -> None:
        self.joints[name] = replace(self.joints[name], driver=driver)

    # --- motifs of one joint

    def _joint(self, carrier: str, place: Place, size: float) -> None:
        """A joint of any type with a part on it."""
        kind, at = str(self.rng.choice(self.kinds)), place(np.eye(4))
        name = self.join(kind, carrier, self.sprout(at, size), at, size, driver=self.rng.random() < 0.7)
        self.freedoms += JointType(kind).freedoms
        if kind == "revolute":
            self._hinges.append((name, at))

    def _gear(self, carrier: str, place: Place, size: float) -> None:
        """A joint that is coupled to any coordinate there is, as driver or as follower: a gear, a belt, a rack, a mimic joint."""
        source = self._coordinate(lambda _: True)
        if source is None:
            return
        kind, at = str(self.rng.choice(["revolute", "revolute", "slider", "screw", "cylindrical"])), place(np.eye(4))
        name = self.join(kind, carrier, self.sprout(at, size), at, size, free=self.rng.random() < 0.7)
        self._couple(source, str(self.rng.choice(self.joints[name].column_names)), size)
        old = source.split(".")[0]
        if self.joints[old].driver and len(self.joints[old].column_names) == 1 and self.rng.random() < 0.5:
            self._mark(old, driver=False)
            self._mark(name, driver=True)
        self.freedoms += JointType(kind).freedoms - 1

    def _tie(self, _carrier: str, _place: Place, size: float) -> None:
        """A coupling of two drivers that were independent, such as the cranks of two loops."""
        a = self._coordinate(lambda joint: joint.driver and len(joint.column_names) == 1)
        group = self._groups[a] if a is not None else None
        b = self._coordinate(lambda joint: joint.driver and len(joint.column_names) == 1 and self._groups[joint.name] != group)
        if a is None or b is None:
            return
        self._couple(a, b, size)
        self._mark(b, driver=False)
        self.freedoms -= 1
        self.story.append(f"{b} follows {a}")

    def _couple(self, a: str, b: str, size: float) -> None:
        """Couple two coordinates so that both rest where they rest; named either way round."""
        if self.rng.random() < 0.5:
            a, b = b, a
        columns = {c.name: c for joint in self.joints.values() for c in joint.columns}
        units = {"rad": 1.0, "mm": 0.5 * size}
        drawn = self.ratios[int(self.rng.integers(len(self.ratios)))] or self.rng.uniform(0.3, 3.0)
        ratio = float(drawn * self.rng.choice([-1, 1])) * units[columns[b].unit] / units[columns[a].unit]
        self.couplings.append(Coupling(f"coupling{len(self.couplings)}", "linear", a, b, ratio, columns[b].rest - ratio * columns[a].rest))
        self._unite([a.split(".")[0], b.split(".")[0]])

    def _coordinate(self, wanted: Callable[[Joint], bool]) -> str | None:
        names = [c.name for joint in self.joints.values() if joint.type.quaternion is None and wanted(joint) for c in joint.columns]
        return str(self.rng.choice(names)) if names else None

    # --- planar loops

    def _four_bar(self, carrier: str, place: Place, size: float) -> None:
        self._flat(carrier, place, size, lambda: [(0, 0), self._near((0, 0), 0.25, 0.5), self._near((0.5, 0.6), 0, 0.5), (1, 0)])

    def _parallelogram(self, carrier: str, place: Place, size: float) -> None:
        def draw() -> list[Point]:
            x, y = self._near((0, 0), 0.4, 0.8)
            return [(0, 0), (x, y), (x + 1, y), (1, 0)]

        self._flat(carrier, place, size, draw)

    def _five_bar(self, carrier: str, place: Place, size: float) -> None:
        near = self._near
        self._flat(carrier, place, size, lambda: [(0, 0), near((0, 0), 0.3, 0.6), near((0.5, 0.9), 0, 0.4), near((1, 0), 0.3, 0.6), (1, 0)])

    def _flat(self, carrier: str, place: Place, size: float, draw: Callable[[], list[Point]]) -> None:
        """A planar loop of pins; the first one drives, of five the last one too."""
        points = _bent(draw)
        drivers = (0, 4) if len(points) == 5 else (0,)
        links = self.ring(carrier, [("revolute", place(pin(size * x, size * y))) for x, y in points], size, len(drivers), drivers)
        self._flats.append((links, place, size))

    def _slider_crank(self, carrier: str, place: Place, size: float) -> None:
        start, crank, end = _bent(lambda: [(0, 0), self._near((0, 0), 0.25, 0.5), self._near((1.2, 0), 0, 0.4)], ends=False)
        pins = [place(pin(size * x, size * y)) for x, y in (start, crank, end)]
        rod = np.array([end[0] - crank[0], end[1] - crank[1], 0.0])
        along = place(frame((size * end[0], size * end[1], 0), turned_z(rod, self.rng.uniform(-0.8, 0.8))))
        joints = [("revolute", pins[0]), ("revolute", pins[1]), ("revolute", pins[2]), ("slider", along)]
        links = self.ring(carrier, joints, size, 1, (int(self.rng.choice([0, 0, 3])),))
        self._flats.append((links, place, size))

    def _dyad(self, _carrier: str, _place: Place, _size: float) -> None:
        """Two links more between two links of a planar loop: Watt's and Stephenson's chains, cranks that are shared."""
        if not self._flats:
            return
        links, place, size = self._flats[self.rng.integers(len(self._flats))]
        a, b = self.rng.choice(links, 2, replace=False)
        near = self._near
        points = _bent(lambda: [near((0, 0.5), 0, 1), near((0.5, 0.5), 0.3, 1.5), near((1, 0.5), 0, 1)], ends=False)
        self._bridge(str(a), str(b), [("revolute", place(pin(size * x, size * y))) for x, y in points], size)

    def _ram(self, _carrier: str, _place: Place, size: float) -> None:
        """A cylinder and its rod across a hinge, which they turn."""
        if not self._hinges:
            return
        name, at = self._hinges.pop(int(self.rng.integers(len(self._hinges))))
        hinge = self.joints[name]
        start, angle = self.rng.uniform(-math.pi, math.pi), self.rng.uniform(1.0, 2.1)
        p, q = (size * self.rng.uniform(0.4, 1.0) * np.array([math.cos(turn), math.sin(turn), 0.0]) for turn in (start, start + angle))
        joints = [("revolute", at @ pin(*p[:2])), ("slider", at @ frame(p, q - p)), ("revolute", at @ pin(*q[:2]))]
        made = self._bridge(hinge.parent, hinge.child, joints, size)
        self._mark(made[1], driver=hinge.driver)
        self._mark(name, driver=False)
        self._unite([name, *made])

    def _bridge(self, a: str, b: str, joints: Sequence[tuple[str, FloatArray]], size: float) -> list[str]:
        """Join two parts by two links, which takes as many freedoms as it gives."""
        links = [a, self.sprout(joints[0][1], size), self.sprout(joints[-1][1], size), b]
        return [self.join(kind, near, far, at, size, free=True) for (kind, at), near, far in zip(joints, links, links[1:], strict=False)]

    # --- loops in space

    def _bennett(self, carrier: str, place: Place, size: float) -> None:
        """The skew four-bar that moves against all counting: sin β / b = sin α / a (Bennett 1903)."""
        a, b, alpha, theta = 1.0, self.rng.uniform(0.5, 0.8), self.rng.uniform(0.6, 1.2), self.rng.uniform(0.6, 2.0)
        beta = math.asin(b / a * math.sin(alpha))
        phi = -2 * math.atan(math.sin((alpha + beta) / 2) / math.sin((alpha - beta) / 2) / math.tan(theta / 2))
        here, joints = np.eye(4), []
        for length, twist, turn in ((a, alpha, theta), (b, beta, phi), (a, alpha, theta), (b, beta, phi)):
            here = here @ pin(size * length, 0) @ joint_motion(JointType.UNIVERSAL, [twist, 0])
            joints.append(("revolute", place(here)))
            here = here @ joint_motion(JointType.REVOLUTE, [turn])
        self.ring(carrier, joints, size, 1)

    def _rssr(self, carrier: str, place: Place, size: float) -> None:
        """A crank and a rocker about skew axes; the universal joint holds the coupler's spin."""
        self._skew(carrier, place, size, "revolute")

    def _rssp(self, carrier: str, place: Place, size: float) -> None:
        """A crank that pushes a slider in any direction."""
        self._skew(carrier, place, size, "slider")

    def _skew(self, carrier: str, place: Place, size: float, last: str) -> None:
        rng = self.rng
        spots = [
            np.zeros(3),
            [0.4, 0.0, 0.1],
            [1.0 + rng.uniform(-0.2, 0.2), rng.uniform(0.4, 0.8), rng.uniform(-0.3, 0.3)],
            [1.1, 0.0, 0.0],
        ]
        axes = [[0, 0, 1], [1, 1, 0], [1, 0, 1], [0.3, 0.2, 1.0] if last == "revolute" else [1.0, 0.5, 0.2]]
        kinds = ["revolute", "universal", "ball", last]
        frames = [frame(size * np.array(o), np.array(z) + 0.3 * rng.normal(size=3)) for o, z in zip(spots, axes, strict=True)]
        self.ring(carrier, [(kind, place(at)) for kind, at in zip(kinds, frames, strict=True)], size, 1)

    def _stewart(self, carrier: str, place: Place, size: float) -> None:
        """A platform on six legs that are driven."""
        top, names = self.sprout(place(frame((0, 0, 1.2 * size), (0, 0, 1))), size), []
        for foot, head in zip(np.radians([-10, 10, 110, 130, 230, 250]), np.radians([-50, 50, 70, 170, 190, 290]), strict=True):
            low = size * np.array([math.cos(foot), math.sin(foot), 0.0])
            high = size * np.array([0.6 * math.cos(head), 0.6 * math.sin(head), 1.2])
            bottom, end = (place(frame(spot, high - low)) for spot in (low, high))
            links = [carrier, self.sprout(bottom, size), self.sprout(end, size), top]
            for kind, at, near, far in zip(("universal", "slider", "ball"), (bottom, bottom, end), links, links[1:], strict=False):
                names.append(self.join(kind, near, far, at, size, driver=kind == "slider", free=True))
        self._unite(names)
        self.freedoms += 6

    def _near(self, centre: Point, least: float, most: float) -> Point:
        radius, turn = self.rng.uniform(least, most), self.rng.uniform(-math.pi, math.pi)
        return centre[0] + radius * math.cos(turn), centre[1] + radius * math.sin(turn)


MOTIFS = {
    "joint": 6, "gear": 3, "tie": 1, "four_bar": 2, "parallelogram": 1, "slider_crank": 2, "five_bar": 1, "dyad": 1.5, "ram": 1.5,
    "bennett": 0.7, "rssr": 0.7, "rssp": 0.7, "stewart": 0.2,
}  # fmt: skip  # how often each is planted
NEW_PARTS = {
    "four_bar": 3,
    "parallelogram": 3,
    "slider_crank": 3,
    "five_bar": 4,
    "dyad": 2,
    "ram": 2,
    "bennett": 3,
    "rssr": 3,
    "rssp": 3,
    "stewart": 13,
}


def random_frame(rng: np.random.Generator, reach: float) -> FloatArray:
    """Return a pose `(4, 4)` of any orientation, its origin within a reach per axis."""
    q = rng.normal(size=4)
    return np.asarray(SE3.from_quaternion(q / np.linalg.norm(q), rng.uniform(-reach, reach, 3)).matrix)


def random_rest(rng: np.random.Generator, kind: JointType, size: float) -> list[float]:
    """Return rest values of a joint; a third of all joints rests at zero."""
    if rng.random() < 0.3:
        return list(kind.neutral)
    if kind.quaternion is not None:
        q = np.array([*rng.normal(size=3) * 0.3, 1.0])
        return [*(float(x) for x in rng.uniform(-0.8, 0.8, kind.quaternion) * size), *(float(x) for x in q / np.linalg.norm(q))]
    return [float(rng.uniform(-0.8, 0.8) * (size if unit == "mm" else 1.0)) for unit in kind.units]


def random_limits(rng: np.random.Generator, kind: JointType, rest: Sequence[float], size: float, *, free: bool) -> JointLimits:
    """Return limits about rest: finite, endless or endless to one side."""
    if kind is JointType.BALL:
        return JointLimits(cone=math.pi)
    if kind is JointType.FREE:
        return JointLimits()
    pairs = []
    for value, unit in zip(rest, kind.units, strict=True):
        reach = rng.uniform(0.4, 3.0, 2) * (size / 3 if unit == "mm" else 1.0)
        sides = [rng.choice([reach[k], INF], p=[0.7, 0.3]) for k in (0, 1)] if not free else [INF, INF]
        pairs.append((value - float(sides[0]), value + float(sides[1])))
    return JointLimits(tuple(lo for lo, _ in pairs), tuple(hi for _, hi in pairs))


def frame(origin: Sequence[float] | FloatArray, z: Sequence[float] | FloatArray) -> FloatArray:
    """Return a frame `(4, 4)` with this z axis."""
    return np.asarray(SE3.from_axes(tuple(map(float, origin)), tuple(map(float, z))).matrix)


def pin(x: float, y: float) -> FloatArray:
    """Return the frame of a pin along z."""
    T = np.eye(4)
    T[:2, 3] = x, y
    return T


def turned_z(v: FloatArray, angle: float) -> FloatArray:
    """Return a vector of the xy plane turned by an angle."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([c * v[0] - s * v[1], s * v[0] + c * v[1], 0.0])


def _bent(draw: Callable[[], list[Point]], *, ends: bool = True) -> list[Point]:
    """Return points of a chain that at none of them is nearly stretched or folded: its angles are between 30° and 150°."""
    while True:
        points = draw()
        if all(_is_bent(points[k - 2], points[k - 1], points[k]) for k in range(0 if ends else 2, len(points))):
            return points


def _is_bent(p: Point, q: Point, r: Point) -> bool:
    """Return whether the angle at q is between 30° and 150°."""
    a, b = (np.subtract(end, q) for end in (p, r))
    lengths = np.linalg.norm(a) * np.linalg.norm(b)
    return bool(lengths > 1e-3 and abs(a @ b) < math.cos(math.radians(30)) * lengths)
