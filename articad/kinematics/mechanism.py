"""Mechanism: parts and the joints that carry and move them; gives poses, velocities and freedoms."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from articad.arrays import FloatArray
from articad.connectors import SE3, quaternion
from articad.errors import KinematicsError, LoopError, PlanError, did_you_mean
from articad.findings import Finding, Findings
from articad.kinematics.batch import TreeArrays
from articad.kinematics.branch import Branch
from articad.kinematics.configuration import Configuration
from articad.kinematics.forward import MOST_FREEDOMS, CompiledModel, compile  # noqa: A004 - it compiles the tree
from articad.kinematics.graph import JointGraph
from articad.kinematics.inexact import NOISE, Correction, nearest
from articad.kinematics.joint_check import joint_findings
from articad.kinematics.joints import Coordinate, Coupling, Joint, JointType
from articad.kinematics.layout import Layout
from articad.kinematics.linkage_findings import askew_error, loop_findings
from articad.kinematics.mobility import NEARLY_FREE, REALISED, Redundancy, redundancies
from articad.kinematics.motion import DrivenMotion, FeasibleRange, drive, feasible_range
from articad.kinematics.path import path
from articad.kinematics.reach import Reach, reach
from articad.kinematics.solution import Solution
from articad.kinematics.tree import KinematicTree

MOST_ENTRIES = 8_000_000
"""Entries of the matrix of all loops and couplings, 64 MB: 1,000 loops of one joint each, or 100 among 10,000 joints."""


class _Compiled(NamedTuple):
    """Joints and data computed from their frames."""

    joints: tuple[Joint, ...]
    tree: KinematicTree
    loop_joints: tuple[Joint, ...]
    layout: Layout
    arrays: TreeArrays


class _Linkage(NamedTuple):
    """Joints and their loops, closed at rest, or the reason why not; and the correction that was, or would be, needed."""

    compiled: _Compiled
    branch: Branch | None = None
    error: KinematicsError | None = None
    correction: Correction | None = None
    beyond: Correction | None = None


class Mechanism:
    """Parts, the joints between them, and couplings between joints; immutable.

    Args:
        parts: Names, in the order in which poses are returned.
        ground: The part that does not move.
        joints: In the order in which they are declared.
        couplings: Relations between coordinates.
        T_ground: Pose of the ground part; the identity by default.

    Raises:
        PlanError: With every finding about names, numbers and structure.
    """

    def __init__(
        self, parts: Sequence[str], ground: str, joints: Sequence[Joint], couplings: Sequence[Coupling] = (), T_ground: SE3 | None = None
    ) -> None:
        self.parts, self.ground = tuple(parts), ground
        self.given_joints, self.couplings = tuple(joints), tuple(couplings)
        self.T_ground = SE3.identity() if T_ground is None else T_ground
        self._require_bounded()
        graph = JointGraph(self.parts, ground, self.given_joints)
        findings = Findings([*graph.findings(), *joint_findings(self.given_joints), *_coupling_findings(self)])
        if not findings.ok:
            raise PlanError("\n".join(map(str, findings.errors)), findings=findings)
        self._structure = findings
        self._given = _compiled(self, self.given_joints, graph)

    def _require_bounded(self) -> None:
        """Refuse a mechanism whose equations no memory holds: their matrix is dense.

        Six rows for each loop and one for each coupling, a column for each coordinate.
        """
        loops = max(0, len(self.given_joints) - len(self.parts) + 1)
        rows, columns = 6 * loops + len(self.couplings), sum(len(joint.rest) for joint in self.given_joints)
        if rows * columns > MOST_ENTRIES:
            raise KinematicsError(
                f"{loops} loops and {len(self.couplings)} couplings of {columns} coordinates are {rows * columns} entries of a matrix;"
                f" the maximum is {MOST_ENTRIES}."
            )

    # --- structure

    @property
    def is_tree(self) -> bool:
        """True when no joint closes a loop and no coupling connects joints: every coordinate is free."""
        return not self._given.loop_joints and not self.couplings

    @property
    def joints(self) -> tuple[Joint, ...]:
        """The joints in the order in which they are declared; those of inexact loops have the nearest frames that close and move.

        See `correction`; `given_joints` has them as given.
        """
        return self._used.joints

    @property
    def tree(self) -> KinematicTree:
        """The tree that carries every part."""
        return self._used.tree

    @property
    def loop_joints(self) -> tuple[Joint, ...]:
        """The joints that close loops."""
        return self._used.loop_joints

    @property
    def layout(self) -> Layout:
        """Places of the coordinates of each joint."""
        return self._used.layout

    @property
    def arrays(self) -> TreeArrays:
        """The tree compiled for arithmetic."""
        return self._used.arrays

    @property
    def correction(self) -> Correction | None:
        """The displacements of inexact connectors so that the loops close; None if there are none."""
        return self._linkage.correction

    @property
    def inconsistency(self) -> Correction | None:
        """The displacements that loops would need to move; None if they need none, or if no such geometry is near."""
        return self._linkage.beyond

    @property
    def _used(self) -> _Compiled:
        return self._linkage.compiled

    @cached_property
    def _linkage(self) -> _Linkage:
        """The loops with consistent frames: the given ones if those close and move."""
        if self.is_tree:
            return _Linkage(self._given)
        given = _linked(self._given, self.couplings)
        if not _is_doubtful(given):
            return given
        found = nearest(self.parts, self.ground, self.given_joints, self.couplings)
        if found is not None and found.within:
            graph = JointGraph(self.parts, self.ground, found.joints)
            corrected = _linked(_compiled(self, found.joints, graph), self.couplings, found)
            if corrected.branch is not None and not _is_doubtful(corrected, noise=False):
                return corrected
        if isinstance(given.error, LoopError):
            if given.error.findings[0].code != "E_LOOP_OPEN":  # couplings that contradict each other: no frame is the cause
                return given
            cause = nearest(self.parts, self.ground, self.given_joints, self.couplings, coarse=True) or found
            return given if cause is None else given._replace(error=askew_error(given.error, cause))
        return given._replace(beyond=found)

    def changed(
        self, *, joints: Iterable[Joint] | None = None, couplings: Iterable[Coupling] | None = None, T_ground: SE3 | None = None
    ) -> Mechanism:
        """Return the mechanism of the same parts with other joints, other couplings, or its ground in another place.

        Args:
            joints: All joints; as they were given by default.
            couplings: All couplings; the same by default.
            T_ground: Pose of the ground; the same by default.

        Raises:
            PlanError: As the constructor.
        """
        return Mechanism(
            self.parts,
            self.ground,
            self.given_joints if joints is None else tuple(joints),
            self.couplings if couplings is None else tuple(couplings),
            T_ground=self.T_ground if T_ground is None else T_ground,
        )

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Columns of all joints, in order of declaration."""
        return self.layout.coordinates

    @property
    def branch(self) -> Branch:
        """The loops and couplings, closed at rest; only for a mechanism that has some.

        Raises:
            LoopError: E_LOOP_OPEN if the loops cannot be closed from the rest pose.
            KinematicsError: If the mechanism is a tree.
        """
        if self._linkage.error is not None:
            raise self._linkage.error.with_traceback(None)
        if self._linkage.branch is None:
            raise KinematicsError("A tree of joints has no loops to close.")
        return self._linkage.branch

    @property
    def drivers(self) -> tuple[Coordinate, ...]:
        """The columns of q, in the order in which they are declared: for a tree, all coordinates.

        With loops or couplings these are the joints marked as drivers, with further ones added in the order of declaration up to the
        mobility.

        Raises:
            LoopError: E_LOOP_OPEN if the loops cannot be closed from the rest pose.
        """
        return self.layout.coordinates if self.is_tree else self.branch.drivers

    @property
    def driving_joints(self) -> tuple[str, ...]:
        """Names of the joints that have drivers and ranges over which to move, in order; free joints have no ranges."""
        free = {joint.name for joint in self.joints if joint.type is JointType.FREE}
        return tuple(name for name in dict.fromkeys(driver.joint for driver in self.drivers) if name not in free)

    @property
    def driver_columns(self) -> tuple[int, ...]:
        """Place of each driver among `coordinates`."""
        return tuple(range(self.layout.n_columns)) if self.is_tree else self.branch.columns

    @property
    def nq(self) -> int:
        """Number of columns of q."""
        return self.layout.n_columns if self.is_tree else len(self.drivers)

    @cached_property
    def rest(self) -> FloatArray:
        """Values of the drivers in the rest pose `(nq,)`, read-only."""
        rest = self.layout.rest.copy() if self.is_tree else self.branch.Q_rest[list(self.branch.columns)]
        rest.setflags(write=False)
        return rest

    @property
    def mobility(self) -> int:
        """Number of independent motions: the dimension of the set of closed configurations near rest, not a count of joints."""
        if self.is_tree:
            return self.layout.n_freedoms
        passive = self.layout.n_freedoms - int(self.branch.system.active.sum())
        return passive + self.branch.analysis.mobility

    @property
    def grubler(self) -> int:
        """Freedoms of the joints minus six per loop and one per coupling: for information; wrong for planar loops."""
        return self.layout.n_freedoms - 6 * len(self.loop_joints) - len(self.couplings)

    def findings(self) -> Findings:
        """Return the findings about a valid mechanism.

        For a tree these are only warnings about its joints; for loops and couplings they also say whether they close and move
        (E_LOOP_OPEN, E_LOOP_LOCKED, E_COUPLING_LOCKED, E_DRIVER, W_LOOP_INEXACT, W_SHAKY, W_NEAR_SINGULAR, W_IDLE_FREEDOM, I_REDUNDANT).
        `motion_findings` checks ranges.
        """
        return self._structure if self.is_tree else self._structure + loop_findings(self)

    def motion_findings(self) -> Findings:
        """Return findings where a driver's declared range is larger than loops allow.

        E_DEAD_POINT, E_LOOP_LIMIT, E_SINGULAR, or E_NOT_FOLLOWED where the path takes too many steps.
        """
        if self.is_tree:
            return Findings()
        ranges = [self.feasible_range(c.name) for c in self.drivers if c.unit != "1" and c.joint in self.driving_joints]
        return Findings(finding for one in ranges for finding in one.findings)

    # --- poses and velocities

    def configuration(self, q: npt.ArrayLike) -> Configuration:
        """Return the coordinates of all joints.

        Args:
            q: Coordinates of the drivers [rad, mm], `(*batch, nq)`.

        Returns:
            Configurations `(*batch)`.
        """
        return Configuration(self.joints, self._columns(q))

    def poses(self, q: npt.ArrayLike) -> SE3:
        """Place every part in the ground frame.

        For each joint, `T_child = T_parent · C_p · J(q) · F · C_c⁻¹`.

        Args:
            q: Coordinates of the drivers [rad, mm], `(*batch, nq)`; a ball's quaternion need not be exactly of unit length.

        Returns:
            `T_ground_part` of all parts in the order of `parts`, `(*batch, N, 7)` [mm, quaternion xyzw].

        Raises:
            KinematicsError: If q is not finite or has another number of columns; E_SINGULAR, E_NOT_FOLLOWED.
            DeadPointError: If a loop would have to pass a dead point. For a batch, the message names the rows; `solve` returns the
                others.
            LoopError: E_LOOP_OPEN if a loop cannot be closed at rest.
        """
        values, compiled = np.asarray(q, dtype=np.float64), self._compiled_model
        if values.ndim != 1 or compiled is None:
            return self.arrays.poses(self._columns(values))
        # of a tree the drivers are all coordinates, and the compiled model looks for NaN and for the length of quaternions
        return compiled.poses(values if self.is_tree and len(values) == self.layout.n_columns else self._columns(values))

    @cached_property
    def _compiled_model(self) -> CompiledModel | None:
        """The tree as a Pinocchio model for one configuration at a time; None where nothing moves or its workspace would be large."""
        return compile(self) if 0 < self.layout.n_freedoms <= MOST_FREEDOMS else None

    def __getstate__(self) -> dict[str, object]:
        """Return what is copied and pickled: Pinocchio's workspaces stay in their process."""
        return {name: value for name, value in self.__dict__.items() if name != "_compiled_model"}

    def solve(self, q: npt.ArrayLike) -> Solution:
        """Place every part, and mark the rows of drivers' values that the mechanism does not reach.

        In contrast, `poses` refuses a batch in which one row is not reached. Limits are not checked by either.

        Args:
            q: Coordinates of the drivers [rad, mm], `(*batch, nq)`.

        Returns:
            Poses, NaN where not reached; a mask; and the reason for the first row that is not reached.

        Raises:
            KinematicsError: If q is not finite or has another number of columns.
            LoopError: E_LOOP_OPEN if a loop cannot be closed at rest.
        """
        values = self._finite_drivers(q)
        batch = values.shape[:-1]
        flat = values.reshape(math.prod(batch), self.nq)
        if self.is_tree:
            columns, reached = self.layout.normalized(flat), np.ones(len(flat), dtype=bool)
        else:
            columns, reached = self.branch.solve(flat)
        findings = Findings() if reached.all() else self.branch.failure(flat, reached).findings
        poses = np.array(self.arrays.poses(columns).data)
        columns = np.where(reached[:, None], columns, np.nan)
        poses[~reached] = np.nan
        placed = SE3.from_unit_array(poses.reshape(*batch, *poses.shape[1:]))
        return Solution(values, reached.reshape(batch), columns.reshape(*batch, self.layout.n_columns), placed, findings)

    def rest_poses(self) -> dict[str, SE3]:
        """Return the pose of every part at rest."""
        return dict(zip(self.parts, self.at_rest, strict=True))

    @cached_property
    def at_rest(self) -> SE3:
        """Poses of all parts at rest `(N,)` [mm, quaternion xyzw].

        In NumPy also for one configuration: files state these numbers in full, and have the same bytes with every build of Pinocchio.
        """
        return self.arrays.poses(self._columns(self.rest))

    def jacobian(self, q: npt.ArrayLike, part: str, T_part_frame: SE3 | None = None) -> FloatArray:
        """Return how fast a frame of a part moves with each driver.

        Args:
            q: Coordinates of the drivers [rad, mm], `(nq,)`.
            part: The part that carries the frame.
            T_part_frame: The frame in the part; the part's own frame by default.

        Returns:
            `(6, nv)`: velocity of the frame's origin [mm] over angular velocity [rad], in the ground frame, per unit of each
            driver's freedom. Columns are in the order of `drivers`; a ball has three: the angular velocity (x, y, z) of its child side
            relative to its parent side in the parent connector's frame.

        Raises:
            KinematicsError: If the mechanism has no such part.
        """
        frame = SE3.identity() if T_part_frame is None else T_part_frame
        Q = self._columns(q)
        if Q.ndim != 1:
            raise KinematicsError(f"A Jacobian is computed at one configuration; q has shape {np.shape(q)}.")
        J = self._part_jacobian(Q, self.part_index(part), frame.translation)
        return J if self.is_tree else J @ self.branch.velocities(Q)

    # --- motion

    def drive(
        self, driver: str, lo: float, hi: float, steps: int = 60, *, at: Mapping[str, float] | None = None, certify: bool = False
    ) -> DrivenMotion:
        """Move one driver evenly, the rest follows; where it cannot go on, the motion ends there and says why.

        Args:
            driver: Name of a driver.
            lo: First value [rad, mm].
            hi: Last value [rad, mm].
            steps: Number of values, both ends included.
            at: Values of other drivers [rad, mm]; at rest by default.
            certify: Prove that each step stays on its branch (about ten times the work).

        Returns:
            Values, configurations, poses, strength and findings.

        Raises:
            UnknownJointError: If there is no such driver.
            LoopError: E_LOOP_OPEN.
        """
        return drive(self, driver, lo, hi, steps, at, certify=certify)

    def sweep(self, *args: Any, **options: Any) -> DrivenMotion:
        """Deprecated name of `drive`."""
        warnings.warn("Mechanism.sweep is named Mechanism.drive.", DeprecationWarning, stacklevel=2)
        return self.drive(*args, **options)

    def feasible_range(self, driver: str, *, at: Mapping[str, float] | None = None) -> FeasibleRange:
        """Return how far a driver can go from rest: its own limits, dead points, and limits of the joints that follow.

        Args:
            driver: Name of a driver.
            at: Values of other drivers [rad, mm]; at rest by default.

        Raises:
            UnknownJointError: If there is no such driver.
            LoopError: E_LOOP_OPEN.
        """
        return feasible_range(self, driver, at)

    def assembly_modes(self, q: npt.ArrayLike | None = None, *, starts: int = 80) -> tuple[Configuration, ...]:
        """Return the assembly modes found at the drivers' values; the rest pose's own branch first.

        Args:
            q: Values of the drivers `(nq,)` [rad, mm]; at rest by default.
            starts: Random starts; a mode to which none of them converges is not found.
        """
        values = self.rest if q is None else self._drivers_array(q)
        if self.is_tree:
            return (self.configuration(values),)
        return tuple(Configuration(self.joints, Q) for Q in self.branch.modes(values, starts))

    def redundancy(self) -> tuple[Redundancy, ...]:
        """Return the constraints of each loop that the others imply, and which joints to release so that real, inexact parts fit."""
        if self.is_tree:
            return ()
        b = self.branch
        return redundancies(self.parts, self.ground, self.layout, b.system, b.analysis, b.Q_rest)

    def reach(
        self,
        part: str,
        target: SE3 | npt.ArrayLike,
        T_part_frame: SE3 | None = None,
        *,
        starts: int = 32,
        accept: Callable[[FloatArray], bool] | None = None,
    ) -> Reach:
        """Return a configuration within limits that brings a frame of a part to a target, or the nearest one and what stops it.

        Args:
            part: The part that carries the frame.
            target: A pose in the ground frame, or a point `(3,)` [mm], which leaves the orientation free.
            T_part_frame: The frame in the part; the part's own frame by default.
            starts: How many random configurations within limits to try besides the rest pose, until the target is reached.
            accept: Decides whether drivers' values `(nq,)` [rad, mm] that reach the target are accepted; if not, others are tried.

        Raises:
            KinematicsError: E_REACH_BARRED if the target is reached, but `accept` refuses every configuration.
        """
        return reach(self, part, target, SE3.identity() if T_part_frame is None else T_part_frame, starts, accept)

    def path(self, start: npt.ArrayLike, goal: npt.ArrayLike, *, accept: Callable[[Configuration], bool] | None = None) -> FloatArray:
        """Return waypoints of the drivers from one configuration to another; on the straight lines between them, branch and limits hold.

        A straight line if that is free, else two random trees that meet (RRT-Connect) with a fixed seed: equal calls give equal results.
        Limits are checked every 0.1 rad or 0.1 lengths of a link, which is sampled, not proven.

        Args:
            start: Values of the drivers `(nq,)` [rad, mm].
            goal: The same [rad, mm]; the path ends in the configuration that `poses` returns there.
            accept: Decides whether a configuration on the path is accepted, for example because no parts meet.

        Returns:
            `(n, nq)`, start and goal included.

        Raises:
            LimitError: If start or goal is outside limits, followers included.
            KinematicsError: E_NO_PATH if no path was found.
        """
        return path(self, start, goal, accept)

    def part_index(self, part: str) -> int:
        """Return the index of a part in the array of poses.

        Raises:
            KinematicsError: If there is no such part.
        """
        try:
            return self.parts.index(part)
        except ValueError:
            known = ", ".join(self.parts)
            raise KinematicsError(f"Unknown part {part!r}.{did_you_mean(part, self.parts)} Known: {known}.", parts=[part]) from None

    def _columns(self, q: npt.ArrayLike) -> FloatArray:
        """Return the coordinates of all joints `(*batch, n_columns)` at the drivers' values."""
        values = self._finite_drivers(q)
        if self.is_tree:
            return self.layout.normalized(values)
        batch = values.shape[:-1]
        flat = values.reshape(math.prod(batch), self.nq)
        return self.branch.configurations(flat).reshape(*batch, self.layout.n_columns)

    def _finite_drivers(self, q: npt.ArrayLike) -> FloatArray:
        values = self._drivers_array(q)
        if not np.isfinite(values).all():
            raise KinematicsError("E_NONFINITE: a coordinate is NaN or infinite.")
        return values

    def _drivers_array(self, q: npt.ArrayLike) -> FloatArray:
        values = np.asarray(q, dtype=np.float64)
        if values.ndim == 0 or values.shape[-1] != self.nq:
            names = ", ".join(c.name for c in self.drivers)
            raise KinematicsError(f"q has shape {values.shape}; its last axis must have {self.nq} columns: {names}.")
        return values

    def _part_jacobian(self, Q: FloatArray, part: int, p_part: FloatArray) -> FloatArray:
        """Return the Jacobian `(6, n_freedoms)` of a point of a part with respect to the freedoms of all joints of the tree."""
        T = self.arrays.matrices(Q[None])
        v0, omega = (twist[:, 0] for twist in self.arrays.twists(T, Q[None]))
        point = T[part, 0, :3, :3] @ p_part + T[part, 0, :3, 3]
        J = np.concatenate([v0 + quaternion.cross(omega, point), omega], axis=-1)
        signed: FloatArray = (J * self.arrays.carried[part][:, None]).T
        return signed

    def __repr__(self) -> str:
        return f"Mechanism({len(self.parts)} parts, {len(self.joints)} joints, {len(self.loop_joints)} loops)"


def _compiled(mechanism: Mechanism, joints: tuple[Joint, ...], graph: JointGraph) -> _Compiled:
    tree, loop_joints = graph.spanning_tree()
    layout = Layout(joints)
    return _Compiled(joints, tree, loop_joints, layout, TreeArrays(mechanism.parts, tree, layout, mechanism.T_ground))


def _linked(compiled: _Compiled, couplings: tuple[Coupling, ...], correction: Correction | None = None) -> _Linkage:
    try:
        branch = Branch(compiled.tree, compiled.layout, compiled.loop_joints, couplings)
    except KinematicsError as error:
        return _Linkage(compiled, None, error, correction)
    return _Linkage(compiled, branch, None, correction)


def _is_doubtful(linkage: _Linkage, *, noise: bool = True) -> bool:
    """Return whether inexact frames may keep the loops from closing or moving.

    Args:
        linkage: The loops, closed or not.
        noise: Whether a small singular value counts, which may also mean a dead point nearby.
    """
    if linkage.branch is None:
        return bool(linkage.compiled.loop_joints) and isinstance(linkage.error, LoopError)
    found = [group.analysis for group in linkage.branch.groups]
    return any(REALISED < one.obstruction < NEARLY_FREE or (noise and one.near < NOISE) for one in found)


def _coupling_findings(mechanism: Mechanism) -> list[Finding]:
    found: list[Finding] = []
    if not mechanism.couplings:
        return found
    columns = {name: joint for joint in mechanism.given_joints for name in joint.column_names}
    for coupling in mechanism.couplings:
        where = f"couplings.{coupling.name}"
        for name in dict.fromkeys((coupling.a, coupling.b)):
            if name not in columns:
                message = f"Coupling {coupling.name!r} names coordinate {name!r}, which no joint has."
                hint = f"Use one of [{', '.join(columns)}].{did_you_mean(name, columns)}"
                found.append(Finding(code="E_JOINT_UNKNOWN", where=where, message=message, hint=hint))
            elif len(columns[name].type.freedom_units) != len(columns[name].type.coordinates):
                message = f"Coupling {coupling.name!r} ties a component of {columns[name].type} joint {columns[name].name!r}."
                found.append(Finding(code="E_COUPLING", where=where, message=message, hint="Tie an angle or a travel."))
        if coupling.a == coupling.b:
            message = f"Coupling {coupling.name!r} ties {coupling.a!r} to itself."
            found.append(Finding(code="E_COUPLING", where=where, message=message, hint="Name two coordinates."))
        if not np.isfinite([coupling.ratio, coupling.offset]).all() or coupling.ratio == 0:
            message = f"Coupling {coupling.name!r} has ratio {coupling.ratio:.6g} and offset {coupling.offset:.6g}."
            found.append(Finding(code="E_COUPLING_RATIO", where=where, message=message, hint="Give a finite ratio other than zero."))
    return found
