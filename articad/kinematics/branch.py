"""Branch: the one way of being assembled that the rest pose shows, and every configuration that is reached from it."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Sequence
from typing import NoReturn

import numpy as np

from articad.connectors import FloatArray
from articad.errors import DeadPointError, KinematicsError, LoopError
from articad.findings import Finding
from articad.kinematics.continuation import Follower, Stop, Trace
from articad.kinematics.factors import least_squares
from articad.kinematics.inexact import shown_gap
from articad.kinematics.joints import Coordinate, Coupling, Joint, JointType
from articad.kinematics.layout import IndexArray, Layout
from articad.kinematics.loops import CLOSED, BoolArray, ClosureSystem
from articad.kinematics.mobility import choose_drivers, mobility_of
from articad.kinematics.track import Track
from articad.kinematics.tree import KinematicTree

_STARTS = 12  # random starts before a loop is said to be open
_LAST_ITERATIONS = 200  # for the best gap: convergence to a stretched chain is linear
_ALMOST = 1e-3  # |r| at which a loop is open by inexact data, not by its rest values
_SAME_MODE = 1e-6  # rad, or lengths L: two solutions this close are one
_MOVED = 1e-15  # rad, or lengths L: a driver that moved less did not move


class Branch:
    """A mechanism with loops or couplings, closed at rest, its drivers chosen.

    Args:
        tree: Which carries all parts.
        layout: Of all joints.
        loop_joints: Joints that close loops.
        couplings: Relations between coordinates.

    Raises:
        LoopError: E_LOOP_OPEN if the loops cannot be closed from the rest pose.
    """

    def __init__(self, tree: KinematicTree, layout: Layout, loop_joints: Sequence[Joint], couplings: Sequence[Coupling]) -> None:
        self.layout = layout
        self.system = ClosureSystem(tree, layout, loop_joints, couplings)
        Q = self._closed_at_rest()
        self.analysis = mobility_of(self.system, Q)
        self.columns, self.refused = choose_drivers(layout, self.system, self.analysis.freedoms)
        self.drivers: tuple[Coordinate, ...] = tuple(layout.coordinates[i] for i in self.columns)
        self.driver_freedoms: IndexArray = np.array(_freedoms(layout, self.columns), dtype=np.intp)
        driven = np.isin(self.system.freedoms, self.driver_freedoms)
        self.dependent: BoolArray = self.system.active & ~driven
        # the drivers stay where the plan has them, if the rest can be closed there
        exact = self.system.close(self._with_rest_drivers(Q), self.dependent)
        self.Q_rest = self.system.into_all(layout.rest, exact.Q if exact.ok else Q)
        self.Q = self.system.to_system(self.Q_rest)
        self.follower = Follower(self.system, self.dependent)
        self.follower.start(self.analysis.Q)
        self._tracks: dict[tuple[int, bool], Track] = {}

    # --- at rest

    def _with_rest_drivers(self, Q: FloatArray) -> FloatArray:
        out = Q.copy()
        mine = np.isin(self.system.columns, np.array(self.columns, dtype=np.intp))
        out[mine] = self.system.layout.rest[mine]
        return out

    def _closed_at_rest(self) -> FloatArray:
        system = self.system
        closed = system.close(system.layout.rest, system.active)
        if closed.ok:
            return closed.Q
        if closed.residual < _ALMOST:  # other ways of assembling it are not what is meant
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
        if not gaps.size:
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

    def configurations(self, q: FloatArray) -> FloatArray:
        """Return the coordinates of all joints `(batch, n_columns)` at the drivers' values `(batch, nq)`.

        Raises:
            DeadPointError: If a driver would have to pass a dead point.
            KinematicsError: E_SINGULAR if the branch is not determined on the way.
        """
        Q_all = np.tile(self.Q_rest, (len(q), 1))
        Q_all[:, self.columns] = q
        Q_all = self.layout.normalized(Q_all)
        wanted = self.system.to_system(Q_all)
        step = self.system.step_between(self.Q, wanted)
        step[:, self.dependent | ~self.system.active] = 0.0
        moving = np.flatnonzero((np.abs(step) > _MOVED).any(axis=0))
        if not moving.size:
            return self.system.into_all(Q_all, np.tile(self.Q, (len(q), 1)))
        column = self._column_of(moving)
        if column is not None:
            track = self.track(column)
            Q, reached, _ = track.evaluate(wanted[:, column])
            if not reached.all():
                value = float(wanted[np.argmin(reached), column])
                self.refuse(track.side(value), column, track.value(1 if value >= track.start else -1, track.side(value).end), value)
        else:
            Q = self._along_lines(step, wanted)
        return self.system.into_all(Q_all, Q)

    def track(self, column: int, *, certify: bool = False, Q: FloatArray | None = None) -> Track:
        """Return the way of one driver (a column of the system) from rest, kept for later questions, or from Q, which is not kept."""
        if Q is not None:
            return Track(self.follower, Q, column, certify)
        return self._tracks.setdefault((column, certify), Track(self.follower, self.Q, column, certify))

    def _column_of(self, moving: IndexArray) -> int | None:
        """Return the one column that moves, or None: several do, or a ball."""
        layout = self.system.layout
        if len(moving) > 1:
            return None
        freedom = int(moving[0])
        return None if freedom in layout.ball_freedoms else layout.column_of_freedom(freedom)

    def _along_lines(self, step: FloatArray, wanted: FloatArray) -> FloatArray:
        """Follow straight lines in the space of several drivers."""
        Q, arrived = self.follower.trace_many(self.Q, step)
        for i in np.flatnonzero(~arrived):
            trace = self.follower.trace(self.Q, step[i], 1.0)
            if trace.stop is not Stop.ARRIVED:
                freedom = int(np.argmax(np.abs(step[i])))
                column = self.system.layout.column_of_freedom(freedom)
                self.refuse(trace, column, float(self.system.move(self.Q, step[i] * trace.end)[column]), float(wanted[i, column]))
            Q[i] = trace.Q_end
        # the drivers' own columns to the last bit
        driven = np.isin(self.system.columns, np.array(self.columns, dtype=np.intp))
        Q[:, driven] = wanted[:, driven]
        return Q

    def refuse(self, trace: Trace, column: int, end: float, asked: float) -> NoReturn:
        """Raise what stopped a trace on the way to `asked`, at the driver value `end`."""
        coordinate = self.system.layout.coordinates[column]
        there, wanted = shown(end, coordinate.unit), shown(asked, coordinate.unit)
        if trace.stop is Stop.DEAD_POINT:
            finding = Finding(
                code="E_DEAD_POINT",
                where=f"joints.{coordinate.joint}",
                message=f"driver {coordinate.name!r} cannot go to {wanted}: the loop reaches only {there}.",
                hint=f"Stay on this side of {there}, or lengthen a link.",
                value=end,
                unit=coordinate.unit,
            )
            raise DeadPointError(str(finding), driver=coordinate.name, q=end, findings=[finding])
        finding = Finding(
            code="E_SINGULAR",
            where=f"joints.{coordinate.joint}",
            message=f"on the way to {wanted} the mechanism is singular at {coordinate.name} = {there}: its branch is not determined beyond.",
            hint="Keep the driver away from there.",
            value=end,
            unit=coordinate.unit,
        )
        raise KinematicsError(str(finding), findings=[finding])

    def velocities(self, Q_all: FloatArray) -> FloatArray:
        """Return how fast all freedoms move per driver freedom, `(n_freedoms, nv)`, in rad and mm, at closed coordinates."""
        system = self.system
        G = np.zeros((self.layout.n_freedoms, len(self.driver_freedoms)))
        G[self.driver_freedoms, np.arange(len(self.driver_freedoms))] = 1.0
        J = system.evaluate_one(system.to_system(Q_all))[1]
        where = np.flatnonzero(self.dependent)
        if where.size:
            driven = J @ (G[system.freedoms] / system.scale[:, None])
            solved = least_squares(J[:, where], -driven, 1e-10) * system.scale[where, None]
            G[system.freedoms[where]] = solved
        return G

    def modes(self, q: FloatArray, starts: int) -> FloatArray:
        """Return all ways found of assembling the mechanism at driver values `(nq,)`: coordinates `(modes, n_columns)`.

        Random starts; a way that a start never falls into is not found. The rest pose's own branch is first, if it is there.
        """
        system, rng = self.system, np.random.default_rng(0)
        Q_all = self.Q_rest.copy()
        Q_all[list(self.columns)] = q
        Q_all = self.layout.normalized(Q_all)
        base = system.to_system(Q_all)
        noise = rng.uniform(-math.pi, math.pi, (starts, system.layout.n_freedoms)) * self.dependent
        candidates, norm = system.close_many(system.move(base, noise), self.dependent, iterations=80)
        closed = list(candidates[norm <= CLOSED])
        with contextlib.suppress(KinematicsError):  # where the branch does not reach this value, others may
            closed.insert(0, system.to_system(self.configurations(np.asarray(q)[None])[0]))
        kept: list[FloatArray] = []
        for Q in closed:
            if all(self._apart(Q, known) for known in kept):
                kept.append(Q)
        return system.into_all(Q_all, np.array(kept).reshape(-1, system.layout.n_columns))

    def _apart(self, a: FloatArray, b: FloatArray) -> bool:
        step = self.system.step_between(a, b)
        angles = ~self.system.layout.is_length
        step[angles] = np.mod(step[angles] + math.pi, 2 * math.pi) - math.pi
        return bool(np.abs(step).max() > _SAME_MODE)


def shown(value: float, unit: str) -> str:
    """Return a value as findings show it: degrees, mm, or a plain number."""
    if unit == "rad":
        return f"{math.degrees(value):.3f}°"
    return f"{value:.3f} mm" if unit == "mm" else f"{value:.4f}"


def _freedoms(layout: Layout, columns: Sequence[int]) -> list[int]:
    """Return the freedoms of driver columns, in their order; a ball's four columns have three."""
    freedoms: list[int] = []
    for column in columns:
        joint = layout.coordinates[column].joint
        own = layout.freedoms[joint]
        if layout.joint(joint).type is JointType.BALL:
            if column == layout.columns[joint].start:
                freedoms.extend(range(own.start, own.stop))
        else:
            freedoms.append(layout.freedom_of(column))
    return freedoms


def _arithmetic(joints: Sequence[Joint]) -> str:
    """Return ` (30+30+30 < 200)` for a loop of links of which one is longer than all others together."""
    ends: dict[str, list[FloatArray]] = {}
    for joint in joints:
        ends.setdefault(joint.parent, []).append(joint.T_parent_connector.translation)
        ends.setdefault(joint.child, []).append(joint.T_child_connector.translation)
    lengths = sorted(float(np.linalg.norm(points[0] - points[-1])) for points in ends.values())
    if sum(lengths[:-1]) >= lengths[-1] or any(joint.type not in {JointType.REVOLUTE, JointType.BALL} for joint in joints):
        return ""
    return f" ({'+'.join(f'{length:.6g}' for length in lengths[:-1])} < {lengths[-1]:.6g})"
