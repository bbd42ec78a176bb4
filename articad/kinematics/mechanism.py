"""Mechanism: parts that joints carry and move; what is asked for poses, velocities and freedoms."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np
import numpy.typing as npt

from articad.connectors import SE3, FloatArray, quaternion
from articad.errors import KinematicsError, PlanError, did_you_mean
from articad.findings import Finding, Findings
from articad.kinematics.batch import TreeArrays
from articad.kinematics.configuration import Configuration
from articad.kinematics.graph import JointGraph
from articad.kinematics.joints import Coordinate, Coupling, Joint
from articad.kinematics.layout import Layout


class Mechanism:
    """Parts, the joints between them, and couplings between joints; immutable.

    Args:
        parts: Names, in the order in which poses are returned.
        ground: The part that stands still.
        joints: In order of declaration.
        couplings: Relations between coordinates.
        T_ground: Pose of the ground part; the identity by default.

    Raises:
        PlanError: With every finding about names, numbers and structure.
    """

    def __init__(
        self, parts: Sequence[str], ground: str, joints: Sequence[Joint], couplings: Sequence[Coupling] = (), T_ground: SE3 | None = None
    ) -> None:
        self.parts, self.ground = tuple(parts), ground
        self.joints, self.couplings = tuple(joints), tuple(couplings)
        self.T_ground = SE3.identity() if T_ground is None else T_ground
        graph = JointGraph(self.parts, ground, self.joints)
        findings = Findings([*graph.findings(), *(f for joint in self.joints for f in joint.findings()), *_coupling_findings(self)])
        if not findings.ok:
            raise PlanError("\n".join(map(str, findings.errors)), findings=findings)
        self._structure = findings
        self.tree, self.loop_joints = graph.spanning_tree()
        self.layout = Layout(self.joints)
        self.arrays = TreeArrays(self.parts, self.tree, self.layout, self.T_ground)

    # --- what it is

    @property
    def is_tree(self) -> bool:
        """True when no joint closes a loop and no coupling ties joints: every coordinate is free."""
        return not self.loop_joints and not self.couplings

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Columns of all joints, in order of declaration."""
        return self.layout.coordinates

    @property
    def drivers(self) -> tuple[Coordinate, ...]:
        """The columns of q, in order of declaration; of a tree all coordinates."""
        return self.layout.coordinates

    @property
    def nq(self) -> int:
        """Number of columns of q."""
        return len(self.drivers)

    @cached_property
    def rest(self) -> FloatArray:
        """Values of the drivers in the rest pose `(nq,)`, read-only."""
        rest = self.layout.rest.copy()
        rest.setflags(write=False)
        return rest

    @property
    def mobility(self) -> int:
        """How many independent motions the mechanism has."""
        return self.layout.n_freedoms

    @property
    def grubler(self) -> int:
        """Freedoms of the joints less six per loop and one per coupling: for information, wrong for planar loops."""
        return self.layout.n_freedoms - 6 * len(self.loop_joints) - len(self.couplings)

    def findings(self) -> Findings:
        """Return what there is to say about a mechanism that could be made: warnings and notes."""
        return self._structure

    # --- where things are

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

        For each joint, `T_child = T_parent · C_p · J(q) · F · C_c⁻¹` (ArtiCAD, Representation).

        Args:
            q: Coordinates of the drivers [rad, mm], `(*batch, nq)`; a ball's four need not be of exactly unit length.

        Returns:
            `T_ground_part` of all parts in the order of `parts`, `(*batch, N, 7)` [mm, quaternion xyzw].

        Raises:
            KinematicsError: If q is not finite or has another number of columns.
        """
        return self.arrays.poses(self._columns(q))

    def rest_poses(self) -> dict[str, SE3]:
        """Return the pose of every part at rest."""
        return dict(zip(self.parts, self.poses(self.rest), strict=True))

    def jacobian(self, q: npt.ArrayLike, part: str, T_part_frame: SE3 | None = None) -> FloatArray:
        """Return how fast a frame of a part moves with each driver.

        Args:
            q: Coordinates of the drivers [rad, mm], `(nq,)`.
            part: The part that carries the frame.
            T_part_frame: The frame in the part; the part's own frame by default.

        Returns:
            `(6, nv)`: velocity of the frame's origin [mm] over angular velocity [rad], in the ground frame, per unit of each
            driver's freedom. Columns are in the order of `drivers`; a ball has three: the angular velocity (x, y, z) of its child
            side against its parent side in the parent connector's frame.

        Raises:
            KinematicsError: If the part is not one of the mechanism.
        """
        frame = SE3.identity() if T_part_frame is None else T_part_frame
        index = self.part_index(part)
        return self._part_jacobian(self._columns(q), index, frame.translation)

    def part_index(self, part: str) -> int:
        """Return the place of a part in the array of poses.

        Raises:
            KinematicsError: If there is none of that name.
        """
        try:
            return self.parts.index(part)
        except ValueError:
            known = ", ".join(self.parts)
            raise KinematicsError(f"Unknown part {part!r}.{did_you_mean(part, self.parts)} Known: {known}.", parts=[part]) from None

    def _columns(self, q: npt.ArrayLike) -> FloatArray:
        """Return the coordinates of all joints `(*batch, n_columns)` at the drivers' values."""
        return self.layout.normalized(self._drivers_array(q))

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


def _coupling_findings(mechanism: Mechanism) -> list[Finding]:
    columns = {name: joint for joint in mechanism.joints for name in joint.column_names}
    found = []
    for coupling in mechanism.couplings:
        where = f"couplings.{coupling.name}"
        for name in dict.fromkeys((coupling.a, coupling.b)):
            if name not in columns:
                message = f"Coupling {coupling.name!r} names coordinate {name!r} which no joint has."
                hint = f"Use one of [{', '.join(columns)}].{did_you_mean(name, columns)}"
                found.append(Finding(code="E_JOINT_UNKNOWN", where=where, message=message, hint=hint))
            elif len(columns[name].type.freedom_units) != len(columns[name].type.coordinates):
                message = f"Coupling {coupling.name!r} ties a component of ball {columns[name].name!r}."
                found.append(Finding(code="E_COUPLING", where=where, message=message, hint="Tie an angle or a travel."))
        if coupling.a == coupling.b:
            message = f"Coupling {coupling.name!r} ties {coupling.a!r} to itself."
            found.append(Finding(code="E_COUPLING", where=where, message=message, hint="Name two coordinates."))
        if not np.isfinite([coupling.ratio, coupling.offset]).all() or coupling.ratio == 0:
            message = f"Coupling {coupling.name!r} has ratio {coupling.ratio:.6g} and offset {coupling.offset:.6g}."
            found.append(Finding(code="E_COUPLING_RATIO", where=where, message=message, hint="Give a finite ratio other than zero."))
    return found
