"""Checks that compare the product at rest with what a picture shows: where its parts lie, which are the larger ones, and which of two mirror images it is."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations, product
from typing import Final, Literal

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.spatial import ConvexHull

from articad.arrays import FloatArray
from articad.geometry import TriMesh
from articad_bench.check import Bounds, Check, within
from articad_bench.shape_checks import placed
from articad_bench.subject import Subject

PLACE: Final = 0.12  # of the diagonal of the whole, by which a part may lie beside its place
DRAWN: Final = 0.015  # the same, where sheets are dimensioned: a pin half out of its bore is not what they show
LOOSELY: Final = {3: 2.2, 4: 1.3}  # the same, where sizes are read off photos
APART: Final = 0.03  # of the diagonal: places nearer to each other are not told apart
_MATTER: Final = 3  # the column of the share of the matter
LARGER: Final = {3: 1.3, 4: 1.04}  # in volume and in size, by column: parts nearer to each other than this have no order
TURNS: Final = tuple(np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]], dtype=np.float64) for c, s in ((1, 0), (0, 1), (-1, 0), (0, -1)))
"""What the whole may be turned by about the upright axis: no picture says which way is x."""
MIRROR: Final = np.diag([1.0, -1.0, 1.0])
OVER: Final = np.diag([1.0, -1.0, -1.0])
POWERS: Final = tuple(p for p in product(range(4), repeat=3) if 1 <= sum(p) <= 3)
_POINT_WEIGHTS: Final = (-0.8, 0.45)  # of the middle of a tetrahedron, and of each point between it and a corner: exact to the third degree


Row = tuple[float, float, float, float, float]


class Arranged(Check):
    """Each part lies where it is shown, and of two parts the larger one is that which is shown larger; the whole may be turned by quarters.

    Attributes:
        parts: Of each part its centre from the middle of the whole, its share of the matter, and its size; lengths as shares of the
            whole's diagonal.
        bodies: Whether these are bodies: parts that are fixed together count as one. Bodies may be of any number of parts, and how much of
            its box a body fills is its maker's choice; so their order of size is that of their boxes.
        loosely: Whether sizes are read off photos: then only parts of very different sizes have an order.
        place: Share of the diagonal of the whole by which a part may lie beside its place.

    No picture says what is solid and what is hollow: a tube that is larger than a plate may be of less matter.
    """

    kind: Literal["arranged"] = "arranged"
    parts: tuple[Row, ...]
    bodies: bool = False
    loosely: bool = False
    place: float = PLACE

    @property
    def wanted(self) -> str:
        return (
            f"{len(self.parts)} {self._name} lie where they are shown, within {100 * self.place:g} % of the whole, in their order of size"
        )

    @property
    def _name(self) -> str:
        return "bodies" if self.bodies else "parts"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        found, wanted = np.array(arrangement(subject, bodies=self.bodies)), np.array(self.parts)
        if len(found) != len(wanted):
            return False, f"{len(found)} {self._name}"
        found = np.column_stack([found, [0.0] * len(found) if self.bodies else _hulls(subject)])
        least = {column: (LOOSELY if self.loosely else LARGER)[column] for column in ((4,) if self.bodies else (3, 4))}
        tries = [_compared(found, wanted, turn, least) for turn in TURNS]
        beside, reversed_ = min(tries, key=lambda each: (each[0] > self.place or each[1] > 0, each))
        return (
            beside <= self.place and not reversed_,
            f"the worst lies {100 * beside:.2g} % beside its place, {reversed_} pairs in the other order",
        )


def _compared(found: FloatArray, wanted: FloatArray, turn: FloatArray, least: Mapping[int, float]) -> tuple[float, int]:
    """Return how far the worst part lies beside its place, and how many pairs of parts have the other order of size by some columns.

    Args:
        found: Rows of the product, and the volumes of their hulls.
        wanted: Rows that are shown.
        turn: Of the whole.
        least: By column, how many times larger a part must be shown to be the larger one.
    """
    apart = np.linalg.norm(found[:, None, :3] - (wanted[:, :3] @ turn.T)[None], axis=2)
    rows, places = linear_sum_assignment(apart**2)
    mine = found[rows[np.argsort(places)]]
    wrong = 0
    for a, b in combinations(range(len(wanted)), 2):
        if np.linalg.norm(wanted[a, :3] - wanted[b, :3]) < APART:
            continue
        for column, times in least.items():
            shown = np.log(wanted[a, column] / wanted[b, column])
            orders = [np.log(mine[a, each] / mine[b, each]) for each in ((column, -1) if column == _MATTER else (column,))]
            wrong += bool(abs(shown) > np.log(times) and all(shown * order < 0 for order in orders))
    return float(apart[rows, places].max()), wrong


def _hulls(subject: Subject) -> list[float]:
    """Return the volume of the convex hull of each part [mm³]."""
    return [float(ConvexHull(mesh.vertices, qhull_options="QJ").volume) for mesh in placed(subject)]


def arrangement(subject: Subject, *, bodies: bool = False) -> list[Row]:
    """Return for each part, or body, its centre, share of the matter and size, as `Arranged` states them."""
    meshes = placed(subject)
    ends = subject.corners(subject.rest)
    diagonal, whole = float(np.linalg.norm(ends[1] - ends[0])), sum(abs(mesh.volume) for mesh in meshes)
    groups: dict[str, list[TriMesh]] = {}
    for name, mesh in zip(subject.shaped, meshes, strict=True):
        groups.setdefault(subject.rigid[name] if bodies else name, []).append(mesh)
    rows: list[Row] = []
    for group in groups.values():
        volumes = [abs(mesh.volume) for mesh in group]
        centre = np.average([mesh.solid_integrals()[1] for mesh in group], axis=0, weights=volumes)
        x, y, z = ((centre - ends.mean(axis=0)) / diagonal).tolist()
        sides = np.ptp(np.concatenate([mesh.vertices for mesh in group]), axis=0)
        rows.append((x, y, z, sum(volumes) / whole, float(np.linalg.norm(sides)) / diagonal))
    return rows


class Matter(Check):
    """The share of its box that the whole fills with matter, at rest: a shell of a solid product, or a wire of it, fills little."""

    kind: Literal["matter"] = "matter"
    share: Bounds

    @property
    def wanted(self) -> str:
        low, high = self.share
        return f"matter fills {100 * low:.2g} to {100 * high:.2g} % of its box"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        share = filled(subject)
        return within(share, self.share), f"{100 * share:.2g} %"


def filled(subject: Subject) -> float:
    """Return the share of its box that a product fills with matter, at rest."""
    return sum(abs(mesh.volume) for mesh in placed(subject)) / float(subject.size.prod())


class Handed(Check):
    """It is the product that is shown, and not its mirror image: its matter lies more like that of the one than of the other.

    Attributes:
        matter: `moments` of the product that is shown.
        margin: By how much it may lie more like the mirror image: where the two differ in a detail alone, a product without it may pass,
            and one with the detail of the mirror image may not.
    """

    kind: Literal["handed"] = "handed"
    matter: tuple[float, ...]
    margin: float = 0.0

    @property
    def wanted(self) -> str:
        return "what is shown, and not its mirror image"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        straight, mirrored = self._differences(subject)
        return straight < mirrored + self.margin, f"differs by {straight:.2g}, its mirror image by {mirrored:.2g}"

    def refuses_mirror_image(self, subject: Subject) -> bool:
        """Return whether the mirror image of a product does not pass."""
        straight, mirrored = self._differences(subject)
        return not mirrored < straight + self.margin

    def _differences(self, subject: Subject) -> tuple[float, float]:
        """Return by how much the moments of a product, and of its mirror image, differ from those that are wanted."""
        if not subject.shaped:
            return float("inf"), float("inf")
        wanted = np.array(self.matter)
        own = moments_of(subject)
        straight, mirrored = (_difference(own, wanted, turns) for turns in (TURNS, [turn @ MIRROR for turn in TURNS]))
        return straight, mirrored


class Upright(Check):
    """The product stands and faces as the text or a picture says: turned upside down, or by half about the upright axis, it is not more like that.

    Attributes:
        matter: Moments of what is wanted, as `moments` gives them.
        over: By how much it may be more like that upside down than as it stands; None if it may lie on either side.
        half: By how much it may be more like that turned by half; None if it may be turned by quarters.
    """

    kind: Literal["upright"] = "upright"
    matter: tuple[float, ...]
    over: float | None = None
    half: float | None = None

    @property
    def wanted(self) -> str:
        ways = ["upside down"] * (self.over is not None) + ["back to front"] * (self.half is not None)
        return f"not {' or '.join(ways)}"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        if not subject.shaped:
            return False, "nothing has a shape"
        straight, over, half = turned_over(subject, np.array(self.matter), faces=self.half is not None)
        ok = all(margin is None or straight < other + margin for margin, other in ((self.over, over), (self.half, half)))
        return ok, f"differs by {straight:.2g}, upside down by {over:.2g}, back to front by {half:.2g}"


def turned_over(subject: Subject, wanted: FloatArray, *, faces: bool) -> tuple[float, float, float]:
    """Return by how much the moments of a product differ from others as it stands, upside down, and turned by half about the upright axis.

    Args:
        subject: The product.
        wanted: The other moments.
        faces: Whether it is compared as it faces; else turned by the quarters with which it is most alike.
    """
    ways = (TURNS[:1] if faces else TURNS, [turn @ OVER for turn in TURNS], TURNS[2:3])
    own = moments_of(subject)
    straight, over, half = (_difference(own, wanted, turns) for turns in ways)
    return straight, over, half


def handedness(subject: Subject) -> float:
    """Return by how much the moments of a product differ from those of its mirror image."""
    own = moments_of(subject)
    return _difference(own, own, [turn @ MIRROR for turn in TURNS])


def moments_of(subject: Subject) -> FloatArray:
    """Return the `moments` of a product as it stands at rest."""
    middle = subject.corners(subject.rest).mean(axis=0)
    return moments([(mesh.vertices - middle)[mesh.triangles] for mesh in placed(subject)])


def _difference(own: FloatArray, wanted: FloatArray, turns: Iterable[FloatArray]) -> float:
    """Return the least by which moments differ from others when they are turned or mirrored."""
    return min(float(np.linalg.norm(_turned(own, turn) - wanted)) for turn in turns)


def _turned(own: FloatArray, turn: FloatArray) -> FloatArray:
    """Return the moments `(19,)` of what is turned or mirrored so that each axis comes to lie along another one, or against it.

    With u = T v, each row of T one ±1, the moment of u^p is ±1 times that of v^q: q is |T|^T p, and the sign that of the product of the ±1, each
    as often as p says.
    """
    powers = np.array(POWERS)
    places = [POWERS.index(tuple(power)) for power in (powers @ np.abs(turn)).astype(int).tolist()]
    signs: FloatArray = np.prod(turn.sum(axis=1) ** powers, axis=1)
    return signs * own[places]


def moments(bodies: Sequence[FloatArray]) -> FloatArray:
    """Return the moments of matter up to the third degree, in halves of the sides of its box, per volume `(19,)`.

    Args:
        bodies: Triangles of closed surfaces, `(n, 3, 3)` each, about the middle of their box.
    """
    corners = np.concatenate(bodies) / np.maximum(np.abs(np.concatenate(bodies)).max(axis=(0, 1)), 1e-9)
    volumes = np.linalg.det(corners) / 6
    tetrahedra = np.concatenate([np.zeros((len(corners), 1, 3)), corners], axis=1)
    centre = tetrahedra.mean(axis=1)
    points = np.stack([centre, *((2 * centre + tetrahedra[:, i]) / 3 for i in range(4))])
    weights = np.repeat(_POINT_WEIGHTS, (1, 4))[:, None] * volumes
    powers = [np.ones_like(points), points, points * points, points * points * points]
    totals = [float((weights * powers[a][..., 0] * powers[b][..., 1] * powers[c][..., 2]).sum()) for a, b, c in POWERS]
    return np.array(totals) / float(volumes.sum())
