"""Branch: the assembly mode of the rest pose, and every configuration that can be reached from it.

Loops and couplings that move no joint in common are independent: each such group is closed, driven and followed by itself. Drivers of
different groups need no common path, and what one group cannot reach says nothing about another.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import NamedTuple, NoReturn

import numpy as np

from articad.arrays import BoolArray, FloatArray, IndexArray
from articad.errors import DeadPointError, KinematicsError, LoopError
from articad.findings import Finding
from articad.kinematics.continuation import Follower, Stop, Trace
from articad.kinematics.deflation import regularized
from articad.kinematics.factors import least_squares
from articad.kinematics.inexact import shown_gap
from articad.kinematics.joints import Coordinate, Coupling, Joint, JointType
from articad.kinematics.layout import Layout
from articad.kinematics.loops import CLOSED, ClosureSystem
from articad.kinematics.mobility import Mobility, choose_drivers, idle_parts, mobility_of, null_space
from articad.kinematics.roadmap import Roadmap
from articad.kinematics.track import Track
from articad.kinematics.tree import KinematicTree

_STARTS = 12  # random starts before a loop is reported as open
_LAST_ITERATIONS = 200  # for the best gap: convergence to a stretched chain is linear
_ALMOST = 1e-3  # |r| below which a loop is open because of inexact data, not because of its rest values
_SAME_MODE = 1e-6  # rad, or lengths L: closer solutions are the same
_MOVED = 1e-15  # rad, or lengths L: a driver that moved less did not move
_ROWS_NAMED = 5  # rows of a batch named in an error


class Solved(NamedTuple):
    """The solution for a batch of drivers' values.

    Attributes:
        Q: Coordinates `(batch, columns)`; rows that are not reached have the requested drivers and the others at rest.
        reached: `(batch,)`.
    """

    Q: FloatArray
    reached: BoolArray


class Group:
    """Loops and couplings that share joints: they move together, and have drivers of their own.

    Args:
        tree: The tree that carries all parts.
        layout: Layout of all joints of the mechanism.
        loop_joints: Joints that close the loops.
        couplings: Relations between coordinates.

    Attributes:
        system: The equations.
        analysis: Their mobility.
        columns: Places of the group's coordinates, drivers and followers, among those of all joints.
        joints: The joints of these coordinates.
        drivers: Coordinates that drive, in the order in which they are declared.
        driver_columns: Their places among the coordinates of all joints.
        refused: Joints marked as drivers that cannot drive.
        dependent: Freedoms of the system that follow the drivers.
        follower: Object that follows the branch.
        Q: The system's coordinates at rest.

    Raises:
        LoopError: E_LOOP_OPEN if the loops cannot be closed from the rest pose.
    """

    def __init__(self, tree: KinematicTree, layout: Layout, loop_joints: Sequence[Joint], couplings: Sequence[Coupling]) -> None:
        self.system = ClosureSystem(tree, layout, loop_joints, couplings)
        own = self.system.layout
        Q = self._closed_at_rest()
        self.analysis = mobility_of(self.system, Q)
        regular = regularized(self.system, self.analysis)
        if regular is not None and regular is not self.system:
            self.system = regular
            closed = regular.close(Q, regular.active)  # the rest pose may lie on another set, where more is free
            Q = closed.Q if closed.ok else Q
        self._places, self.refused = choose_drivers(self.system, self.analysis.freedoms)
        self.columns: IndexArray = self.system.written
        self.joints: tuple[Joint, ...] = own.joints
        self.drivers: tuple[Coordinate, ...] = tuple(own.coordinates[i] for i in self._places)
        self.driver_columns: IndexArray = self.system.columns[list(self._places)]
        self._driving: IndexArray = np.array(driver_freedoms(own, self._places), dtype=np.intp)
        driven = np.zeros(own.n_freedoms, dtype=bool)
        driven[self._driving] = True
        self.dependent: BoolArray = self.system.active & ~driven
        # the drivers keep their values in the plan, if the rest pose can be closed with them
        exact = self.system.close(self._with_rest_drivers(Q), self.dependent)
        self.Q = exact.Q if exact.ok else Q
        self.follower = Follower(self.system, self.dependent, simple=regular is not None)
        self.follower.start(self.analysis.Q)
        self._follows: BoolArray = (self.follower.basis.matrix != 0).any(axis=1) | ~self.system.active
        self._tracks: dict[tuple[int, bool], Track] = {}

    @property
    def idle(self) -> tuple[tuple[str, ...], ...]:
        """Parts, or pairs that a joint connects, which can move while all drivers and all other parts stand."""
        held = null_space(self.analysis.freedoms[self._driving])
        return idle_parts(self.system, replace(self.analysis, mobility=held.shape[1], freedoms=self.analysis.freedoms @ held))

    # --- at rest

    def _with_rest_drivers(self, Q: FloatArray) -> FloatArray:
        out = Q.copy()
        out[list(self._places)] = self.system.layout.rest[list(self._places)]
        return out

    def _closed_at_rest(self) -> FloatArray:
        system = self.system
        closed = system.close(system.layout.rest, system.active)
        if closed.ok:
            return closed.Q
        if closed.residual < _ALMOST:  # other assembly modes are not intended
            self._raise_open(closed.Q, from_rest=False)
        rng = np.random.default_rng(0)
        starts = system.move(system.layout.rest, rng.uniform(-math.pi, math.pi, (_STARTS, system.layout.n_freedoms)))
        Q, norm = system.close_many(starts, system.active, iterations=60)
        if norm.min() <= CLOSED:
            self._raise_open(closed.Q, from_rest=True)
        best = Q[np.argmin(norm)] if norm.min() < closed.residual else closed.Q
        return self._raise_open(system.close(best, system.active, iterations=_LAST_ITERATIONS).Q, from_rest=False)

    def _raise_open(self, Q: FloatArray, *, from_rest: bool) -> NoReturn:
        gaps = self.system.gaps(Q)
        if not gaps.size or self.system.contradiction(Q) > CLOSED:
            message = "Couplings contradict each other."
            finding = Finding(code="E_COUPLING_REST", where="couplings", message=message, hint="Set their offsets from the rest values.")
            raise LoopError(f"E_COUPLING_REST: {message}", findings=[finding])
        worst = int(np.argmax(gaps))
        loop, gap = self.system.loops[worst], float(gaps[worst])
        joint = loop.joint
        turn = float(np.linalg.norm(self.system.residual_one(Q)[6 * worst + 3 : 6 * worst + 6]))
        sizes = (shown_gap(gap), f"{math.degrees(turn):.2g}°")
        lever = turn * self.system.length
        size = sizes[0] if lever < 0.01 * gap else sizes[1] if gap < 1e-6 * lever else " and ".join(sizes)
        place = f"{joint.parent}.{joint.parent_connector} / {joint.child}.{joint.child_connector}"
        if from_rest:
            message, hint = (
                f"loop {loop} does not close near its rest pose: gap {size} at {place}.",
                "Give rest values that close it.",
            )
        else:
            message = f"loop {loop} cannot close: best gap {size} at {place}{_arithmetic(loop.joints)}."
            hint = "Lengthen a link or move a pivot."
        finding = Finding(
            code="E_LOOP_OPEN", where=f"joints.{joint.name}", message=message, hint=hint, parts=loop.parts, value=gap, limit=0.0, unit="mm"
        )
        raise LoopError(f"E_LOOP_OPEN: {message} {hint}", loop=loop.parts, gap=gap, findings=[finding])

    # --- elsewhere

    def place_of(self, column: int) -> int | None:
        """Return the place in the system of a driver's column among all joints; None if it does not drive this group."""
        at = np.flatnonzero(self.driver_columns == column)
        return self._places[int(at[0])] if at.size else None

    def track(self, column: int, *, certify: bool = False, Q: FloatArray | None = None) -> Track:
        """Return the track of one driver (a column of the system): from rest, which is cached, or from Q, which is not."""
        if Q is not None:
            return Track(self.follower, Q, column, certify)
        return self._tracks.setdefault((column, certify), Track(self.follower, self.Q, column, certify))

    def solve(self, Q_all: FloatArray) -> Solved:
        """Follow the branch from rest to the drivers' values, each row by itself.

        A single driver follows its track. Several move along a straight line, or if that is blocked, along a path that a roadmap finds;
        the same values always lead to the same configuration.

        Args:
            Q_all: Coordinates of all joints `(batch, n_columns)`; only those of drivers are used.
        """
        if len(Q_all) > 1 and (Q_all[:, self.driver_columns] == Q_all[:1, self.driver_columns]).all():
            one = self.solve(Q_all[:1])
            return Solved(np.tile(one.Q, (len(Q_all), 1)), np.tile(one.reached, len(Q_all)))
        Q, wanted, step = self._asked(Q_all)
        reached: BoolArray = np.ones(len(Q), dtype=bool)
        moves = np.abs(step[:, self._driving]) > _MOVED
        alone = self._moving_alone(moves)
        for place in np.unique(alone[alone >= 0]).tolist():
            rows = np.flatnonzero(alone == place)
            Q[rows], reached[rows], _ = self.track(place).evaluate(wanted[rows, place])
        rows = np.flatnonzero((alone < 0) & moves.any(axis=1))
        if rows.size:
            Q[rows], reached[rows] = self._together(step[rows], wanted[rows])
        Q[~reached] = wanted[~reached]
        return Solved(Q, reached)

    def _asked(self, Q_all: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return for each row the rest configuration, the same with the drivers at their requested values, and the step between both."""
        Q = np.tile(self.Q, (len(Q_all), 1))
        wanted = Q.copy()
        wanted[:, list(self._places)] = Q_all[:, self.driver_columns]
        wanted = self.system.ties.fitted(wanted, ~self.dependent)
        return Q, wanted, self.step(Q, wanted)

    def step(self, start: FloatArray, wanted: FloatArray) -> FloatArray:
        """Return the scaled displacement `(batch, freedoms)` of the drivers and of what is coupled to them, between configurations."""
        step = self.system.step_between(start, wanted)
        step[:, self._follows] = 0.0
        return step

    def _moving_alone(self, moves: BoolArray) -> IndexArray:
        """Return for each row the one column that moves, or −1 if several move, or a ball, or none."""
        layout = self.system.layout
        columns = [-1 if int(f) in layout.ball_freedoms else layout.column_of_freedom(int(f)) for f in self._driving]
        if not columns:
            return np.full(len(moves), -1, dtype=np.intp)
        return np.where(moves.sum(axis=1) == 1, np.array(columns, dtype=np.intp)[moves.argmax(axis=1)], -1)

    def advance(self, Q: FloatArray, wanted: FloatArray) -> Solved:
        """Follow straight lines from configurations `(batch, columns)` to the drivers' values in `wanted`."""
        found, arrived = self.follower.trace_many(Q, self.step(Q, wanted))
        found[:, list(self._places)] = wanted[:, list(self._places)]  # exact to the last bit
        return Solved(self.system.ties.fitted(found, ~self.dependent), arrived)

    def advance_from(self, Q_all: FloatArray, wanted_all: FloatArray) -> FloatArray | None:
        """Return the end of a straight line of the drivers from a closed configuration of all joints; None if it is blocked."""
        Q = self.system.to_system(Q_all)
        wanted = Q.copy()
        wanted[list(self._places)] = wanted_all[self.driver_columns]
        wanted = self.system.ties.fitted(wanted, ~self.dependent)
        if np.array_equal(wanted, Q):
            return Q
        found, arrived = self.advance(Q[None], wanted[None])
        return found[0] if arrived[0] else None

    def _together(self, step: FloatArray, wanted: FloatArray) -> Solved:
        Q, arrived = self.advance(np.tile(self.Q, (len(step), 1)), wanted)
        barred = np.flatnonzero(~arrived)
        for i in barred[self._closable(wanted[barred])] if barred.size else barred:
            trace = self.follower.trace(self.Q, step[i], 1.0)  # with all guards, where the batch failed
            straight = trace.stop is Stop.ARRIVED
            found = trace.Q_end if straight else self._roadmap.reached(step[i][self._driving], wanted[i])
            if found is not None:
                Q[i], arrived[i] = found, True
        return Solved(Q, arrived)

    @cached_property
    def _roadmap(self) -> Roadmap:
        return Roadmap(self)

    def _closable(self, wanted: FloatArray) -> BoolArray:
        """Return which rows can be closed at all, tried from a few random starts."""
        noise = np.random.default_rng(0).uniform(-math.pi, math.pi, (_STARTS, self.system.layout.n_freedoms)) * self.dependent
        starts = self.system.move(wanted[:, None], noise).reshape(-1, wanted.shape[1])
        _, norm = self.system.close_many(starts, self.dependent, iterations=60)
        return np.asarray((norm.reshape(len(wanted), _STARTS) <= CLOSED).any(axis=1))

    @property
    def driving(self) -> IndexArray:
        """Freedoms of the system that drive."""
        return self._driving

    def failure(self, Q_all: FloatArray, row: str) -> KinematicsError:
        """Return the error that says why the drivers' values of one row `(n_columns,)` are not reached."""
        Q, wanted, step = self._asked(Q_all[None])
        moves = np.abs(step[:, self._driving]) > _MOVED
        place = int(self._moving_alone(moves)[0])
        if place >= 0:
            track, value = self.track(place), float(wanted[0, place])
            trace = track.side(value)
            return failure(
                trace, self.system.layout.coordinates[place], track.value(1 if value >= track.start else -1, trace.end), value, row
            )
        trace = self.follower.trace(Q[0], step[0], 1.0)
        freedom = int(self._driving[np.argmax(np.abs(step[0, self._driving]))])
        place = self.system.layout.column_of_freedom(freedom)
        end = float(self.system.move(Q[0], step[0] * trace.end)[place])
        asked = float(wanted[0, place])
        row += "no way around was found; " if self._closable(wanted)[0] else "no closed configuration was found there; "
        return failure(trace, self.system.layout.coordinates[place], end, asked, row)

    def velocities(self, Q_all: FloatArray, G: FloatArray) -> None:
        """Write the velocities of followers at closed coordinates into G `(n_freedoms, nv)`, whose drivers' rows are given."""
        system, where = self.system, np.flatnonzero(self.dependent)
        if where.size:
            J = system.evaluate_one(system.to_system(Q_all))[1]
            driven = J @ (G[system.freedoms] / system.scale[:, None])
            G[system.freedoms[where]] = least_squares(J[:, where], -driven, 1e-10) * system.scale[where, None]

    def modes(self, Q_all: FloatArray, starts: int) -> FloatArray:
        """Return all assembly modes found at the drivers' values, the group's own branch first: `(modes, columns)`."""
        system, rng = self.system, np.random.default_rng(0)
        _, wanted, _ = self._asked(Q_all[None])
        noise = rng.uniform(-math.pi, math.pi, (starts, system.layout.n_freedoms)) * self.dependent
        candidates, norm = system.close_many(system.move(wanted[0], noise), self.dependent, iterations=80)
        closed = list(candidates[norm <= CLOSED])
        Q, reached = self.solve(Q_all[None])
        if reached[0]:  # if this branch does not reach the value, others may
            closed.insert(0, Q[0])
        kept: list[FloatArray] = []
        for one in closed:
            if all(self._apart(one, known) for known in kept):
                kept.append(one)
        return np.array(kept).reshape(-1, system.layout.n_columns)

    def _apart(self, a: FloatArray, b: FloatArray) -> bool:
        step = self.system.step_between(a, b)
        angles = ~self.system.layout.is_length
        step[angles] = np.mod(step[angles] + math.pi, 2 * math.pi) - math.pi
        return bool(np.abs(step).max() > _SAME_MODE)


class Branch:
    """A mechanism with loops or couplings, closed at rest, its drivers chosen.

    Args:
        tree: The tree that carries all parts.
        layout: Layout of all joints.
        loop_joints: Joints that close loops.
        couplings: Relations between coordinates.

    Attributes:
        groups: The independent groups, in the order of their first joints.
        drivers: Coordinates that drive, in the order in which they are declared: those of all groups, and all that no constraint
            involves.
        columns: Their places among the coordinates of all joints.
        driver_freedoms: Their freedoms among those of all joints.
        refused: Joints marked as drivers that cannot drive.
        Q_rest: Coordinates of all joints at rest, closed.

    Raises:
        LoopError: E_LOOP_OPEN if the loops cannot be closed from the rest pose.
    """

    def __init__(self, tree: KinematicTree, layout: Layout, loop_joints: Sequence[Joint], couplings: Sequence[Coupling]) -> None:
        self.layout = layout
        self._given = tree, tuple(loop_joints), tuple(couplings)
        self.groups = tuple(Group(tree, layout, *members) for members in independent(tree, layout, loop_joints, couplings))
        touched = {int(column) for group in self.groups for column in group.columns}
        driving = {int(column) for group in self.groups for column in group.driver_columns}
        self.columns: tuple[int, ...] = tuple(c for c in range(layout.n_columns) if c in driving or c not in touched)
        self.drivers: tuple[Coordinate, ...] = tuple(layout.coordinates[i] for i in self.columns)
        self.driver_freedoms: IndexArray = np.array(driver_freedoms(layout, self.columns), dtype=np.intp)
        self.refused: tuple[Joint, ...] = tuple(joint for group in self.groups for joint in group.refused)
        Q = layout.rest
        for group in self.groups:
            Q = group.system.into_all(Q, group.Q)
        self.Q_rest = Q

    # --- all groups together

    @cached_property
    def system(self) -> ClosureSystem:
        """The equations of all groups together, for what concerns the whole mechanism. Each group has its own, smaller system."""
        tree, loop_joints, couplings = self._given
        return ClosureSystem(tree, self.layout, loop_joints, couplings)

    @property
    def Q(self) -> FloatArray:
        """Coordinates of `system` at rest."""
        return self.system.to_system(self.Q_rest)

    @cached_property
    def dependent(self) -> BoolArray:
        """Freedoms of `system` that follow the drivers."""
        mine: BoolArray = self.system.active & ~np.isin(self.system.freedoms, self.driver_freedoms)
        return mine

    @cached_property
    def analysis(self) -> Mobility:
        """Mobility of the whole mechanism, in the coordinates of `system`."""
        Q_all = self.Q_rest
        total = sum(group.analysis.mobility for group in self.groups)
        motions = np.zeros((self.layout.n_freedoms, total))
        at = 0
        for group in self.groups:
            found = group.analysis
            Q_all = group.system.into_all(Q_all, found.Q)
            motions[group.system.freedoms, at : at + found.mobility] = found.freedoms * group.system.scale[:, None]
            at += found.mobility
        freedoms = motions[self.system.freedoms] / self.system.scale[:, None]
        return Mobility(
            total,
            sum(group.analysis.first_order for group in self.groups),
            sum(group.analysis.rank for group in self.groups),
            self.system.to_system(Q_all),
            freedoms / np.maximum(np.linalg.norm(freedoms, axis=0), 1e-300),
            min((group.analysis.near for group in self.groups), default=1.0),
            max((group.analysis.obstruction for group in self.groups), default=0.0),
            sum(group.analysis.multiple for group in self.groups),
        )

    def driven_by(self, column: int) -> tuple[Group, int] | None:
        """Return the group that a driver's column moves, and its place there; None if nothing follows it."""
        for group in self.groups:
            place = group.place_of(column)
            if place is not None:
                return group, place
        return None

    # --- elsewhere

    def solve(self, q: FloatArray) -> Solved:
        """Return the coordinates of all joints `(batch, n_columns)` at the drivers' values `(batch, nq)`, and which rows are reached."""
        Q_all, reached = self._with_drivers(q), np.ones(len(q), dtype=bool)
        for group in self.groups:
            Q, mine = group.solve(Q_all)
            Q_all, reached = group.system.into_all(Q_all, Q), reached & mine
        return Solved(Q_all, reached)

    def _with_drivers(self, q: FloatArray) -> FloatArray:
        Q_all = np.tile(self.Q_rest, (len(q), 1))
        Q_all[:, self.columns] = q
        return self.layout.normalized(Q_all)

    def configurations(self, q: FloatArray) -> FloatArray:
        """Return the coordinates of all joints `(batch, n_columns)` at the drivers' values `(batch, nq)`.

        Raises:
            DeadPointError: If a driver would have to pass a dead point; the message names the rows that are not reached.
            KinematicsError: E_SINGULAR if the branch is not determined on the way; E_NOT_FOLLOWED if it is too long.
        """
        Q_all, reached = self.solve(q)
        if not reached.all():
            raise self.failure(q, reached)
        return Q_all

    def failure(self, q: FloatArray, reached: BoolArray) -> KinematicsError:
        """Return the error for the rows `(batch, nq)` that are not reached: their numbers, and the reason for the first one."""
        rows = np.flatnonzero(~reached)
        first = int(rows[0])
        Q_all = self._with_drivers(q[first : first + 1])
        row = ""
        if len(q) > 1:
            named = "; ".join(f"row {i} ({self._values(q[i])})" for i in rows[:_ROWS_NAMED].tolist())
            more = f" and {len(rows) - _ROWS_NAMED} more" if len(rows) > _ROWS_NAMED else ""
            row = f"{len(rows)} of {len(q)} rows cannot be reached: {named}{more}. Row {first}: "
        group = next(group for group in self.groups if not group.solve(Q_all).reached[0])
        return group.failure(Q_all[0], row)

    def _values(self, q: FloatArray) -> str:
        return ", ".join(f"{c.name} = {shown(float(value), c.unit)}" for c, value in zip(self.drivers, q, strict=True))

    def velocities(self, Q_all: FloatArray) -> FloatArray:
        """Return the velocities of all freedoms per driver freedom, `(n_freedoms, nv)`, in rad and mm, at closed coordinates."""
        G = np.zeros((self.layout.n_freedoms, len(self.driver_freedoms)))
        G[self.driver_freedoms, np.arange(len(self.driver_freedoms))] = 1.0
        for group in self.groups:
            group.velocities(Q_all, G)
        return G

    def modes(self, q: FloatArray, starts: int) -> FloatArray:
        """Return all assembly modes found at driver values `(nq,)`: coordinates `(modes, n_columns)`.

        Random starts are used; a mode to which no start converges is not found. The rest pose's own branch is first, if it is there.
        """
        found = self._with_drivers(np.asarray(q)[None])
        for group in self.groups:
            ways = group.modes(found[0], starts)
            found = np.concatenate([group.system.into_all(one, ways) for one in found])
        return found


def independent(
    tree: KinematicTree, layout: Layout, loop_joints: Sequence[Joint], couplings: Sequence[Coupling]
) -> list[tuple[list[Joint], list[Coupling]]]:
    """Return loops and couplings in groups that share no freedom: connected components, in the order of their first freedoms."""
    touched: list[tuple[Joint | Coupling, set[int]]] = []
    for closing in loop_joints:
        round_it = (closing, *tree.joints_between(closing.parent, closing.child))
        own = {f for joint in round_it for f in range(layout.freedoms[joint.name].start, layout.freedoms[joint.name].stop)}
        touched.append((closing, own))
    touched += [(c, {layout.freedom_of(layout.column_of[name]) for name in (c.a, c.b)}) for c in couplings]
    merged: list[tuple[list[Joint | Coupling], set[int]]] = []
    for one, own in touched:
        beside = [group for group in merged if group[1] & own]
        merged = [group for group in merged if not group[1] & own]
        members = [*(member for group in beside for member in group[0]), one]
        merged.append((members, own.union(*(group[1] for group in beside))))
    merged.sort(key=lambda group: min(group[1], default=-1))
    order = {id(one): i for i, (one, _) in enumerate(touched)}
    groups = [sorted(members, key=lambda one: order[id(one)]) for members, _ in merged]
    return [([m for m in members if isinstance(m, Joint)], [m for m in members if isinstance(m, Coupling)]) for members in groups]


def failure(trace: Trace, coordinate: Coordinate, end: float, asked: float, row: str = "") -> KinematicsError:
    """Return the error that says what stopped a trace on its path to `asked`, at the driver value `end`."""
    there, wanted = shown(end, coordinate.unit), shown(asked, coordinate.unit)
    where = f"joints.{coordinate.joint}"
    if trace.stop is Stop.DEAD_POINT:
        message = f"{row}driver {coordinate.name!r} cannot go to {wanted}: the loop reaches only {there}."
        hint = f"Stay on this side of {there}, or lengthen a link."
        finding = Finding(code="E_DEAD_POINT", where=where, message=message, hint=hint, value=end, unit=coordinate.unit)
        return DeadPointError(str(finding), driver=coordinate.name, q=end, findings=[finding])
    if trace.stop is Stop.SINGULAR:
        what = f"the mechanism is singular at {coordinate.name} = {there}: its branch is not determined beyond that."
        code, hint = "E_SINGULAR", "Keep the driver away from there."
    elif trace.stop is Stop.MULTIPLE:
        what = f"the mechanism is not followed beyond {coordinate.name} = {there}: its constraints have a multiple root."
        code, hint = "E_NOT_FOLLOWED", "Use fewer links, or links that are not parallel or equal; no obstacle is known beyond that."
    else:
        what = f"the mechanism was followed to {coordinate.name} = {there} and not further: the path takes too many steps."
        code, hint = "E_NOT_FOLLOWED", f"Request a value nearer than {there}; no obstacle is known beyond it."
    finding = Finding(code=code, where=where, message=f"{row}on the way to {wanted} {what}", hint=hint, value=end, unit=coordinate.unit)
    return KinematicsError(str(finding), findings=[finding])


def shown(value: float, unit: str) -> str:
    """Return a value as findings show it: degrees, mm, or a plain number."""
    if unit == "rad":
        return f"{math.degrees(value):.3f}°"
    return f"{value:.3f} mm" if unit == "mm" else f"{value:.4f}"


def driver_freedoms(layout: Layout, columns: Sequence[int]) -> list[int]:
    """Return the freedoms of driver columns, in their order; a ball's four columns have three."""
    freedoms: list[int] = []
    for column in columns:
        joint = layout.coordinates[column].joint
        own = layout.freedoms[joint]
        first = layout.joint(joint).type.quaternion
        at = column - layout.columns[joint].start
        if first is None or at < first:
            freedoms.append(layout.freedom_of(column))
        elif at == first:
            freedoms.extend(range(own.start + first, own.stop))
    return freedoms


def _arithmetic(joints: Sequence[Joint]) -> str:
    """Return ` (30+30+30 < 200)` for a loop in which one link is longer than all others together."""
    ends: dict[str, list[FloatArray]] = {}
    for joint in joints:
        ends.setdefault(joint.parent, []).append(joint.T_parent_connector.translation)
        ends.setdefault(joint.child, []).append(joint.T_child_connector.translation)
    lengths = sorted(float(np.linalg.norm(points[0] - points[-1])) for points in ends.values())
    if sum(lengths[:-1]) >= lengths[-1] or any(joint.type not in {JointType.REVOLUTE, JointType.BALL} for joint in joints):
        return ""
    return f" ({'+'.join(f'{length:.6g}' for length in lengths[:-1])} < {lengths[-1]:.6g})"
