"""Proof along drivers of loops or couplings: the followers stay in tubes about curves that the checker of certificates can verify.

Joints that loops and couplings tie together form a group. Each group has drivers; its followers do not depend on other groups.
For a small box of the ranges of one group's drivers, the checker's Newton map proves that the followers have exactly one solution in a
tube about a quadratic curve (existence: Brouwer; uniqueness: Banach). So each coordinate stays near a line, and the bounds of `spread`
apply to the box. If the bounds are too wide, the box is halved about a new solution, and the width of its tube falls to a quarter.
Drivers of several groups and independent coordinates move together in products of such boxes. The prover calls the checker's own
inequalities, so it uses no piece that the checker would refute. The search starts with the joined tube of all boxes and splits it.
"""

from __future__ import annotations

import contextlib
import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from articad.arrays import FloatArray, IntArray
from articad.certificates.clearing import Boxes, CannotCut
from articad.certificates.proof import Proof, Prover, Shrink
from articad.certificates.spread import Spread
from articad.certificates.verifier import Checker, joined
from articad.certificates.verifier_files import Refuted
from articad.connectors.se3 import SE3
from articad.interference.freedoms import Freedom, scattered
from articad.interference.motion import Chain, Route
from articad.interference.overlap import Overlap, overlap
from articad.interference.scene import Scene
from articad.interference.verdict import UNRELATED_VOLUME_MM3
from articad.interference.work import CLOSED, PLACED, WorkBudget, piece_price

Ends = tuple[tuple[float, float], ...]  # for each driver

SMALLEST_STEP = 1e-6  # of the driver's range, below which it is not followed further
FIRST_STEP = 1.0  # of the way to a bound, halved until the followers are enclosed
SMALLEST_BOX = 1 / 256  # of the ranges of several drivers, below which they are not followed together
MOST_BOXES = 3000  # of several drivers
WIDER = 1.2  # factor on the distance within which there is a solution, to get that within which there is no other one
ROOM = (2e-4, 2e-6)  # rad or mm: margin of a tube; a large one allows long pieces, but with many joints only a small one works
SMALLEST_PIECE = 1e-4  # rad or mm: precision of the end of the free range along a driver
LOOKS = 24  # poses sampled beyond contact
REACHED = 1e-6  # rad or mm: largest deviation of the centre of a box from the pose of the mechanism that replaces it
_CLOSED = 1e-10  # tolerance of loops and couplings
_STILL = 1e-14  # of a Newton step: rounding


@dataclass(frozen=True, eq=False)
class FollowedBox:
    """One followed box of the ranges of a group's drivers, or the union of several.

    Attributes:
        ends: Lower and upper end for each driver [rad or mm].
        numbers: Indices of its followed boxes in the track.
        line: For each coordinate of the group: its value in the middle, its rate for each driver `(drivers,)`, and the largest distance
            of the coordinate from this line [rad or mm].
        off: Distance of the line from a pose of the mechanism in the middle [rad or mm]; infinite for a union.
    """

    ends: Ends
    numbers: tuple[int, ...]
    line: Mapping[str, tuple[float, FloatArray, float]]
    off: float

    @property
    def half(self) -> FloatArray:
        """Half of the range of each driver."""
        return np.array([(high - low) / 2 for low, high in self.ends])

    @property
    def middle(self) -> FloatArray:
        """Value of each driver in the middle."""
        return np.array([(high + low) / 2 for low, high in self.ends])


class DriverTrack:
    """The followers of some drivers of one group over the drivers' ranges, in boxes that are halved on request; shared by all pairs.

    Args:
        checker: Checker of a certificate without claims; it holds joints, groups and drivers.
        drivers: Coordinates of one group; the other drivers of the group stay at rest.
        bounds: Lower and upper end for each driver; the track covers as much of them as can be followed.

    Attributes:
        work: Units of work spent on pieces, including pieces that could not be followed.

    Raises:
        Refuted: If a loop is open at rest.
    """

    def __init__(self, checker: Checker, drivers: tuple[str, ...], bounds: Ends) -> None:
        self.drivers, self.bounds = drivers, bounds
        self.names: list[str] = checker.followers(drivers)
        self.group = frozenset(next(group for group in checker.groups if drivers[0] in group))  # the group's other drivers stay at rest
        self._checker, self.rest = checker, np.array([checker.rest[name] for name in drivers])
        self._found = checker.begin(self.names, len(drivers))
        self._others: list[int] = []
        self._price = piece_price(len(self.names) - len(drivers), len(drivers))
        self.work = 0
        self._number: dict[Ends, int] = {}
        self._cuts: dict[Ends, tuple[int, float, Ends, Ends]] = {}
        self._pieces: dict[Ends, FollowedBox] = {}
        self._steps: dict[int, list[FollowedBox]] = {}

    @property
    def count(self) -> int:
        """Number of pieces found so far."""
        return len(self._number)

    # --- one driver

    def steps(self, sign: int) -> list[FollowedBox]:
        """Return the pieces of a single driver's range from rest towards one end, as far as it can be followed."""
        if sign not in self._steps:
            at, end = float(self.rest[0]), self.bounds[0][1 if sign > 0 else 0]
            step, last, found = (end - at) * FIRST_STEP, 0, list[FollowedBox]()
            least = abs(end - at) * SMALLEST_STEP
            while at != end and abs(step) > least:
                there = end if abs(end - at) <= abs(step) * 1.5 else at + step
                piece = self._piece(((min(at, there), max(at, there)),), last)
                if piece is None:
                    step /= 2
                    continue
                found.append(piece)
                at, last, step = there, piece.numbers[0], step * 1.5
            self._steps[sign] = found
        return self._steps[sign]

    def reached(self, sign: int) -> float:
        """Return how far the pieces of a single driver go towards one end."""
        steps = self.steps(sign)
        return steps[-1].ends[0][1 if sign > 0 else 0] if steps else float(self.rest[0])

    def _tree(self, ends: list[Ends]) -> Ends:
        """Record how a row of pieces is split, half of them to each side; return the ends of the union."""
        if len(ends) == 1:
            return ends[0]
        at = (len(ends) + 1) // 2
        low, high = self._tree(ends[:at]), self._tree(ends[at:])
        whole = ((low[0][0], high[0][1]),)
        self._cuts[whole] = 0, low[0][1], low, high
        return whole

    # --- the whole range

    @cached_property
    def whole(self) -> FollowedBox | None:
        """The union of all followed pieces; None if there is none, or if several drivers cannot be followed over all of their ranges."""
        if len(self.drivers) == 1:
            steps = [*self.steps(-1)[::-1], *self.steps(1)]
            return self.piece(self._tree([step.ends for step in steps])) if steps else None
        grown = self._grown(self.bounds)
        return None if grown is None else self.piece(grown)

    def spans(self) -> dict[str, tuple[float, float]]:
        """Return the lower and upper bound of each coordinate over all followed pieces [rad or mm]."""
        found: dict[str, tuple[float, float]] = {}
        for number in () if self.whole is None else self.whole.numbers:
            ends, *line, _ = self._found[number]
            middle, slopes, near = joined(np.array([ends]), [tuple(line)])
            far = np.abs(slopes).T @ (np.ptp(np.array(ends), axis=1) / 2) + near
            for name, low, high in zip(self.names, (middle - far).tolist(), (middle + far).tolist(), strict=True):
                known = found.get(name, (low, high))
                found[name] = min(low, known[0]), max(high, known[1])
        return found

    def _grown(self, ends: Ends) -> Ends | None:
        """Follow several drivers over a box; split a box that is too large, and follow the half nearer to rest first."""
        for at, (low, high) in enumerate(ends):
            if low < self.rest[at] < high:
                return self._parted(ends, at, float(self.rest[at]))
        beside = self._beside(ends)
        if beside is None or len(self._number) > MOST_BOXES:
            return None
        if self._piece(ends, beside) is not None:
            return ends
        share = np.array([(high - low) / (most - least) for (low, high), (least, most) in zip(ends, self.bounds, strict=True)])
        if share.max() < SMALLEST_BOX:
            return None
        slopes = self._found[beside][2]
        reach = np.abs(slopes[:, len(ends) :]).max(axis=1, initial=0.0) * [high - low for low, high in ends]
        at = int(np.argmax(reach)) if reach.any() else int(np.argmax(share))
        return self._parted(ends, at, sum(ends[at]) / 2)

    def _parted(self, ends: Ends, at: int, place: float) -> Ends | None:
        low, high = ((*ends[:at], half, *ends[at + 1 :]) for half in ((ends[at][0], place), (place, ends[at][1])))
        order = (low, high) if place >= self.rest[at] else (high, low)
        if any(self._grown(part) is None for part in order):
            return None
        self._cuts[ends] = at, place, low, high
        return ends

    def _beside(self, ends: Ends) -> int | None:
        """Return the number of the piece found so far that touches a box and is nearest to its middle, or of the rest pose."""
        (low, high), spans = np.array(ends).T, np.array([row[0] for row in self._found])
        touches = ((spans[..., 0] <= high) & (spans[..., 1] >= low)).all(axis=1)
        if not touches.any():
            return None
        middle = (low + high) / 2
        off = np.linalg.norm(np.clip(middle, spans[..., 0], spans[..., 1]) - middle, axis=1)
        return int(np.argmin(np.where(touches, off, np.inf)))

    # --- pieces

    def piece(self, ends: Ends) -> FollowedBox:
        """Return the piece of a box of the drivers that has been followed."""
        if ends not in self._pieces:
            numbers = tuple(self._leaves(ends))
            rows = [self._found[number] for number in numbers]
            middle, slopes, near = joined(np.array([row[0] for row in rows]), [row[1:4] for row in rows])
            named = zip(self.names, zip(middle.tolist(), slopes.T, near.tolist(), strict=True), strict=True)
            off = float(np.abs(rows[0][1] - rows[0][4][0]).max()) if len(rows) == 1 else math.inf
            self._pieces[ends] = FollowedBox(ends, numbers, dict(named), off)
        return self._pieces[ends]

    def _leaves(self, ends: Ends) -> Iterator[int]:
        todo = [ends]
        while todo:
            one = todo.pop()
            if one in self._number:
                yield self._number[one]
            else:
                todo += self._cuts[one][2:]

    def halves(self, piece: FollowedBox, shares: FloatArray) -> tuple[int, float, FollowedBox, FollowedBox] | None:
        """Return across which driver a piece is cut, where, and its halves, each about a solution of its own; None if there are none.

        Args:
            piece: A piece of this track.
            shares: Share of the motion that each driver causes `(drivers,)`: a piece that was not cut before is cut across the largest.
        """
        if piece.ends not in self._cuts:
            at, (number,) = int(np.argmax(shares)), piece.numbers
            (low, high) = piece.ends[at]
            place = (low + high) / 2
            parts = [(*piece.ends[:at], half, *piece.ends[at + 1 :]) for half in ((low, place), (place, high))]
            if not low < place < high or any(self._piece(part, number) is None for part in parts):
                return None
            self._cuts[piece.ends] = at, place, parts[0], parts[1]
        at, place, first, second = self._cuts[piece.ends]
        return at, place, self.piece(first), self.piece(second)

    def _piece(self, ends: Ends, beside: int) -> FollowedBox | None:
        """Return a piece that lies on the branch of another one; None if the checker would refute it."""
        if ends in self._number:
            return self.piece(ends)
        span = np.array(ends)
        self.work += self._price
        guess = self.solved(span.mean(axis=1), beside)
        if guess is None:
            return None
        with contextlib.suppress(Refuted):
            bounds = self._checker.enclosures(self.names, span[None], guess[None])
            for room in ROOM:
                with contextlib.suppress(Refuted):
                    (row,) = self._checker.held(self.names, bounds, self._tube(bounds, room))
                    self._checker.join(self._found, self.names, row, beside)
                    self._others.append(beside)
                    self._number[ends] = len(self._found) - 1
                    return self.piece(ends)
        return None

    def _tube(self, bounds: tuple[Any, ...], room: float) -> FloatArray:
        """Return distances from a curve that should enclose exactly one solution, `(1, n)`: a widened fixed point of the checker's bound."""
        ends, guess, _, _, off, bend, most, share = bounds
        count: int = ends.shape[1]
        wide: FloatArray = np.zeros(guess.shape)
        for _ in range(6):
            within = wide[:, count:, None]
            held = off[..., None] + room + bend @ within + most @ np.minimum(share[..., count:] @ within, 1.0) ** 2
            wide[:, count:] = WIDER * held[..., 0]
        return wide

    def solved(self, values: FloatArray, beside: int) -> FloatArray | None:
        """Return all coordinates of the group at values of the drivers, by Newton's method from the prediction of a piece."""
        ends, value, rates, *_ = self._found[beside]
        x = value + (values - ends.mean(axis=1)) @ rates
        x[: len(values)] = values
        with contextlib.suppress(Refuted):
            for _ in range(10):
                r, J, _ = self._checker.closure(self.names, x, x)
                step = np.linalg.pinv(J[:, len(values) :], rcond=1e-7) @ r
                x[len(values) :] -= step
                if np.abs(step).max(initial=0.0) < _STILL * (1 + np.abs(x).max()):
                    break
            return x if np.abs(self._checker.closure(self.names, x, x)[0]).max(initial=0.0) < _CLOSED else None
        return None

    def at(self, values: FloatArray) -> dict[str, float] | None:
        """Return the coordinates of the group at values of the drivers; None if these have not been followed."""
        spans = np.array([row[0] for row in self._found])
        holding = np.flatnonzero(np.all((spans[..., 0] <= values) & (spans[..., 1] >= values), axis=1))
        x = self.solved(values, int(holding[-1])) if len(holding) else None
        return None if x is None else dict(zip(self.names, x.tolist(), strict=True))

    def arrays(self) -> dict[str, FloatArray | IntArray]:
        """Return all pieces as a checker reads them."""
        rows, key, count = self._found[1:], "+".join(self.drivers), len(self.drivers)
        cuts = list(self._cuts.items())
        return {
            f"{key}.ends": np.array([row[0] for row in rows]).reshape(-1, count, 2),
            f"{key}.values": np.array([row[4][0] for row in rows]).reshape(-1, len(self.names)),
            f"{key}.wide": np.array([row[4][3] for row in rows]).reshape(-1, len(self.names)),
            f"{key}.other": np.array(self._others, dtype=np.int64),
            f"{key}.boxes": np.array([ends for ends, _ in cuts]).reshape(-1, count, 2),
            f"{key}.cuts": np.array([cut[0] for _, cut in cuts], dtype=np.int64),
            f"{key}.at": np.array([cut[1] for _, cut in cuts], dtype=np.float64),
        }


class Steps:
    """Boxes along tracks, and of further coordinates that move independently.

    Args:
        ways: Tracks of drivers of different groups.
        chain: The chain between two parts.
        others: Bounds of the chain's coordinates that do not follow; NaN for those that do.
        pieces: Pieces to cover, one of each track; by default all of it.
    """

    def __init__(self, ways: Sequence[DriverTrack], chain: Chain, others: FloatArray, pieces: Sequence[FollowedBox] | None = None) -> None:
        self.ways, self.chain, self.spread = tuple(ways), chain, Spread(chain)
        self.free = np.flatnonzero(~np.isnan(others[:, 0]))
        self.others = others
        self.pieces = tuple(whole for way in ways if (whole := way.whole) is not None) if pieces is None else tuple(pieces)
        self.first = np.cumsum([0, *(len(way.drivers) for way in ways)]).tolist()
        names = [chain.freedoms[factor.column].name for _, factor in self.spread.factors]
        self._follow = [np.array([name in way.names for name in names], dtype=bool) for way in ways]
        self._columns = np.array([factor.column for _, factor in self.spread.factors], dtype=np.intp)
        self._names = names
        self.rows: list[tuple[tuple[FollowedBox, ...], FloatArray]] = []
        self.outside, self.columns, self.places, self.halves = list[bool](), list[int](), list[float](), list[tuple[int, int]]()

    @property
    def work(self) -> int:
        """Units of work that the boxes, and the pieces of the tracks, have cost so far."""
        return PLACED * len(self.spread) + sum(way.work for way in self.ways)

    def root(self) -> IntArray:
        """Add the whole range of the tracks and of the other coordinates."""
        return self._add([(self.pieces, self.others)])

    def _add(self, rows: list[tuple[tuple[FollowedBox, ...], FloatArray]]) -> IntArray:
        centres, lines, tubes = (np.array(part) for part in zip(*(self._placed(*row) for row in rows), strict=True))
        generators = np.concatenate([lines, tubes[:, :, None] * np.eye(tubes.shape[1])], axis=1)
        self.rows += rows
        self.outside += [False] * len(rows)
        self.columns += [-1] * len(rows)
        self.places += [math.nan] * len(rows)
        self.halves += [(-1, -1)] * len(rows)
        return self.spread.add(centres, np.abs(lines).sum(axis=1) + tubes, generators)

    def _placed(self, pieces: tuple[FollowedBox, ...], ends: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the chain's coordinates; the range of each factor for each driver `(drivers, F)`, and in addition to that `(F,)`."""
        values = np.where(np.isnan(ends[:, 0]), self.chain.rest, ends.mean(axis=1))  # coordinates that no driver here moves stay at rest
        lines, aside = np.zeros((self.first[-1], len(self._names))), np.zeros(len(self._names))
        for f, name in enumerate(self._names):
            column = self._columns[f]
            for way, piece in enumerate(pieces):
                if name in piece.line:
                    values[column], rates, aside[f] = piece.line[name]
                    lines[self.first[way] : self.first[way + 1], f] = rates * piece.half
            if column in self.free:
                aside[f] = (ends[column, 1] - ends[column, 0]) / 2
        return values, lines, aside

    def cut(self, boxes: IntArray, share: FloatArray) -> IntArray:
        """Halve a piece of a track, or the range of an independent coordinate, whichever has the largest share."""
        pairs = [self._cut(int(box), share[row]) for row, box in enumerate(boxes.tolist())]
        numbers = self._add([half for pair in pairs for half in pair]).reshape(-1, 2)
        for box, halves in zip(boxes.tolist(), numbers.tolist(), strict=True):
            self.halves[box] = halves[0], halves[1]
        return numbers

    def _cut(self, box: int, share: FloatArray) -> list[tuple[tuple[FollowedBox, ...], FloatArray]]:
        pieces, ends = self.rows[box]
        count = self.first[-1]
        by_driver, aside = share[:count], share[count:]
        wide = [column for column in self.free.tolist() if ends[column, 1] > ends[column, 0]]
        choices = [(float(aside[self._columns == column].sum()), -1, column) for column in wide]  # share, index of the track or -1, column
        for way, follows in enumerate(self._follow):
            own = float(by_driver[self.first[way] : self.first[way + 1]].sum() + aside[follows].sum())
            choices.append((own, way, -1))
        for _, way, column in sorted(choices, reverse=True):
            if way < 0:
                self.columns[box] = count + int(np.searchsorted(self.free, column))
                low, high = ends.copy(), ends.copy()
                low[column, 1] = high[column, 0] = self.places[box] = (ends[column, 0] + ends[column, 1]) / 2
                return [(pieces, low), (pieces, high)]
            found = self.ways[way].halves(pieces[way], by_driver[self.first[way] : self.first[way + 1]])
            if found is not None:
                at, self.places[box], *parts = found
                self.columns[box] = self.first[way] + at
                return [((*pieces[:way], part, *pieces[way + 1 :]), ends) for part in parts]
        raise CannotCut

    def is_reached(self, box: int) -> bool:
        """Return whether the centre of a box is a pose of the mechanism: in a wide box, or in a union, loops need not close there."""
        return all(piece.off <= REACHED for piece in self.rows[box][0])

    def contact(self, box: int) -> tuple[float, ...] | None:
        """Return the chain's coordinates at the centre of a box; None if the mechanism does not reach it."""
        return tuple(self._placed(*self.rows[box])[0].tolist()) if self.is_reached(box) else None

    def driven(self, box: int) -> dict[str, float]:
        """Return the drivers' values at the centre of a box."""
        pairs = zip(self.ways, self.rows[box][0], strict=True)
        return {name: float(value) for way, piece in pairs for name, value in zip(way.drivers, piece.middle, strict=True)}


class LinkageProver(Prover):
    """Proves one pair of parts while drivers move the loops and couplings between them.

    Args:
        scene: Bodies and relations.
        route: Joints from the first part to the second.
        joints: Names of the joints that move: all followers, and those that move independently.
        ways: Tracks of the drivers, one for each group that moves.
        epsilon: Distances up to this count as contact [mm].
        budget: Shared by all proofs.
    """

    def __init__(
        self,
        scene: Scene,
        route: Route,
        joints: Sequence[str],
        ways: Sequence[DriverTrack],
        *,
        epsilon: float = 1e-3,
        budget: WorkBudget | None = None,
    ) -> None:
        super().__init__(scene, route, joints, epsilon=epsilon, budget=budget)
        self.ways = tuple(ways)
        self.drivers = tuple(name for way in ways for name in way.drivers)
        mine = np.array([any(freedom.name in way.group for way in ways) for freedom in self.chain.freedoms], dtype=bool)
        self.others = np.where(mine[:, None], np.nan, self.bounds)
        if self.axis is not None and self.axis.dimensions == 3:
            self.axis = None  # a ball that follows is not held within its cone: nothing proves that it stays within it
        self.looked = 0  # poses at which `worst` measured the overlap

    @property
    def is_line(self) -> bool:
        """False: a free range is found along the driver."""
        return False

    @property
    def is_single(self) -> bool:
        """True if one driver moves, and nothing independently."""
        return len(self.drivers) == 1 and bool(np.isnan(self.others[:, 0]).all())

    def ends(self, column: int) -> tuple[float, float]:
        """Return the bounds of a coordinate of the chain: followers stay near the line over the whole track."""
        name = self.chain.freedoms[column].name
        for way in self.ways:
            if way.whole is not None and name in way.whole.line:
                value, rates, near = way.whole.line[name]
                far = float(np.abs(rates) @ way.whole.half) + near
                return value - far, value + far
        return super().ends(column)

    def boxes(self, bounds: FloatArray) -> Boxes:  # noqa: ARG002  ways know their ranges
        """Return the steps along the drivers."""
        return Steps(self.ways, self.chain, self.others)

    def vary(self, bounds: FloatArray) -> dict[str, tuple[float, float]]:  # noqa: ARG002
        """Return the drivers' ranges that were cleared, and those of the independent coordinates."""
        driven = {name: ends for way in self.ways if way.whole for name, ends in zip(way.drivers, way.whole.ends, strict=True)}
        return {**driven, **{freedom.name: (freedom.lower, freedom.upper) for freedom in self._own()}}

    def _own(self) -> list[Freedom]:
        return [freedom for freedom, (low, _) in zip(self.chain.freedoms, self.others, strict=True) if not math.isnan(low)]

    def _rest(self) -> dict[str, float]:
        return {name: float(value) for way in self.ways for name, value in zip(way.drivers, way.rest, strict=True)}

    def _proof(self, begun: Proof, shrink: Shrink, most: int) -> Proof:
        outcome = self._over_all(shrink, most)
        found = replace(begun, out_of_budget=outcome.out_of_budget, shrink=shrink, epsilon=shrink.depth or self.epsilon)
        if outcome.is_complete:
            vary = self.vary(self.bounds)
            lower, upper = vary[self.drivers[0]] if self.is_single else (None, None)
            claim = replace(self.claim(begun.overlap, vary, shrink, outcome), start=self._rest())
            return replace(found, claims=(claim,), lower=lower, upper=upper)
        if outcome.contact is None or not isinstance(outcome.course, Steps):
            return found
        return replace(found, contacts=({**self.named(outcome.contact), **outcome.course.driven(outcome.box)},))

    @property
    def moving(self) -> tuple[Freedom, ...]:
        """The drivers over what was followed of their ranges, and the coordinates that move independently."""
        rest = self._rest()
        ends = {name: span for way in self.ways if way.whole for name, span in zip(way.drivers, way.whole.ends, strict=True)}
        return (*(Freedom(name, *span, rest[name]) for name, span in ends.items()), *self._own())

    def told(self, point: Sequence[float]) -> dict[str, float]:
        """Return values of what moves by name."""
        return {freedom.name: float(value) for freedom, value in zip(self.moving, point, strict=True)}

    def seen(self, begun: Proof) -> dict[str, Any]:
        """Return where the two overlap beyond what is allowed, at one of a few values of the moving coordinates, if they do."""
        moving = self.moving
        corners = itertools.islice(itertools.product(*((f.lower, f.upper) for f in moving)), LOOKS)
        places = [{f.name: value for f, value in zip(moving, place, strict=True)} for place in [*corners, *scattered(moving, 2 * LOOKS)]]
        if len(moving) == 1:
            places = [{moving[0].name: value} for value in np.linspace(moving[0].lower, moving[0].upper, 2 * LOOKS).tolist()]
        found = [(self.depth(values), place) for place in places if (values := self.placed(place)) is not None]
        depth, place = max(found, key=lambda one: one[0], default=(0.0, {}))
        if depth <= max(self.allowed, begun.overlap.depth):
            return {}
        known = dict(zip([freedom.name for freedom in self.chain.freedoms], self.placed(place) or (), strict=True))
        return {"contacts": ({**known, **place},)}

    def collides(self, proof: Proof) -> bool:
        """Return whether the two overlap beyond what is allowed near where a proof stopped, or beyond it."""
        worst, _ = self.worst(proof)
        return worst.depth > self.allowed and worst.volume > UNRELATED_VOLUME_MM3

    def free_range(self, shrink: Shrink) -> tuple[float, float]:
        """Return how far from rest a single driver may go in both directions."""
        (way,) = self.ways
        rest = float(next(iter(self._rest().values())))
        ends = [rest, rest]
        for end, sign in enumerate((-1, 1)):
            todo = list(way.steps(sign)[::-1])
            while todo:
                step = todo.pop()
                if self.search_over(Steps(self.ways, self.chain, self.others, [step]), shrink).is_complete:
                    ends[end] = step.ends[0][end]
                    continue
                halves = way.halves(step, np.ones(1)) if step.half[0] > SMALLEST_PIECE / 2 else None
                if halves is None:
                    break
                todo += halves[2:][::-sign]
        return ends[0], ends[1]

    def worst(self, proof: Proof) -> tuple[Overlap, dict[str, float] | None]:
        """Return the deepest overlap between where a proof stopped and the ends of the ranges, and the values there."""
        worst, where = proof.overlap, None
        for contact in proof.contacts:
            for place in self._beyond(contact):
                values = self.placed(place)
                if values is None:
                    continue
                self.budget.spend(self.look_price)
                self.looked += 1
                found = overlap(self.body_a, self.body_b, SE3.from_matrix(self.chain.matrix(values)))
                if found.depth > worst.depth:
                    worst, where = found, place
        return worst, where

    def _beyond(self, contact: Mapping[str, float]) -> Iterator[dict[str, float]]:
        """Yield values from a contact on, in growing steps: each driver to its end away from rest, all to theirs, and all back to rest.

        A search may first find the far side of an obstacle, so that only the way back leads into it.
        """
        own = {freedom.name: contact[freedom.name] for freedom in self._own()}
        rest, start = self._rest(), {name: contact.get(name, value) for name, value in self._rest().items()}
        bounds = {name: ends for way in self.ways if way.whole for name, ends in zip(way.drivers, way.whole.ends, strict=True)}
        end = {name: bounds[name][1 if start[name] >= rest[name] else 0] for name in start}
        ways: list[set[str]] = [{name} for name in start]
        goals = [(end, moving) for moving in ([*ways, set(start)] if len(ways) > 1 else ways)]
        for goal, moving in [*goals, (rest, set(start))]:
            for share in (np.linspace(0.0, 1.0, LOOKS) ** 3).tolist():
                yield {**own, **{name: start[name] + (goal[name] - start[name]) * share * (name in moving) for name in start}}

    def placed(self, place: Mapping[str, float]) -> list[float] | None:
        """Return the chain's coordinates at values of the drivers and independent coordinates; None if drivers were not followed there."""
        known = dict(place)
        for way in self.ways:
            self.budget.spend(CLOSED)
            found = way.at(np.array([place[name] for name in way.drivers]))
            if found is None:
                return None
            known |= found
        return [known.get(freedom.name, freedom.rest) for freedom in self.chain.freedoms]
