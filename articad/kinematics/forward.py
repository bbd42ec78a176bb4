"""Trees and loops as a `pinocchio.Model`: poses, residuals of loops and their Jacobian for one configuration at a time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from threading import Lock
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from articad.arrays import FloatArray, IndexArray
from articad.connectors import SE3
from articad.errors import KinematicsError
from articad.kinematics.crossings import Crossing
from articad.kinematics.equations import Closures
from articad.kinematics.joints import Joint
from articad.kinematics.layout import QUATERNION_TOLERANCE, Layout

if TYPE_CHECKING:
    from articad.kinematics.mechanism import Mechanism

# pinocchio.Data allocates about this many bytes times nv³ (68 MiB at nv = 100, 4.0 GiB at nv = 400, measured with 4.1.0)
_DATA_BYTES_PER_CUBE = 64
_DATA_LIMIT_BYTES = 1 << 30
MOST_FREEDOMS = 60  # of models that are made unasked: a workspace of 14 MB, which takes as long to make as a hundred evaluations
_ONE = np.ones(())  # an array: making one from a number takes longer than the signs of ten parts
_CLOSED = 1e-13  # |r| of a loop: the Jacobian changes only by rounding
_TINY = 1e-160  # the sum of squares of any finite numbers times it does not overflow


class _Map(NamedTuple):
    """Maps the coordinates of all joints to Pinocchio's configuration.

    Attributes:
        columns: For each place in Pinocchio's q, the column of the coordinate that it comes from; None where the order is the same.
        signs: −1 where Pinocchio measures in the opposite direction; None where it never does.
    """

    columns: IndexArray | None
    signs: FloatArray | None

    def q(self, Q: FloatArray) -> FloatArray:
        """Return Pinocchio's configuration `(nq,)` for coordinates `(n_columns,)`; quaternions are copied."""
        q = Q if self.columns is None else Q.take(self.columns)
        return q if self.signs is None else self.signs * q


def _map_of(model: Any, crossed: Sequence[tuple[Crossing, int]], layout: Layout) -> _Map:
    """Return the map for a model, from its joints as crossed with their numbers."""
    columns, signs = np.zeros(model.nq, dtype=np.intp), np.ones(model.nq)
    for c, joint_id in crossed:
        if c.joint.type.freedoms:
            first, start, n = layout.columns[c.joint.name].start, model.joints[joint_id].idx_q, len(c.signs)
            columns[start : start + n] = range(first, first + n)
            signs[start : start + n] = c.signs
    in_order = np.array_equal(columns, np.arange(layout.n_columns))
    return _Map(None if in_order else columns, None if (signs > 0).all() else signs)


@dataclass(frozen=True, eq=False)
class CompiledModel:
    """A tree as a Pinocchio model, joints numbered depth-first.

    Attributes:
        model: The `pinocchio.Model`; its frames have the names of the parts. Lengths are in mm.
        mechanism: The mechanism it was made from.
        crossings: The tree's joints in the order in which they were added; fixed ones have no Pinocchio joint.
        joint_ids: Pinocchio's joint of each crossing; for a fixed one the joint that carries it.
        frame_ids: Frame of each part by name.
    """

    model: Any
    mechanism: Mechanism
    crossings: tuple[Crossing, ...]
    joint_ids: tuple[int, ...]
    frame_ids: dict[str, int]
    _lock: Any = field(default_factory=Lock, repr=False)

    @cached_property
    def data(self) -> Any:
        """Workspace of the model.

        Raises:
            KinematicsError: If it would take more than 1 GiB.
        """
        require_data_fits(self.model.nv)
        return self.model.createData()

    def q(self, Q: FloatArray) -> FloatArray:
        """Return Pinocchio's configuration `(nq,)` for the coordinates `(n_columns,)` of all joints of the mechanism.

        Raises:
            KinematicsError: E_NONFINITE; E_QUAT_NORM if a ball's quaternion is off by more than 1e-3.
        """
        q = self._map.q(Q)
        unit: FloatArray = self._pin.normalize(self.model, q)
        small = q * _TINY  # of finite length exactly if all coordinates are finite
        # unit − q is as long as the quaternions are off unit length
        if not (small.dot(small) < math.inf and (off := unit - q).dot(off) < QUATERNION_TOLERANCE**2):
            self.mechanism.layout.normalized(Q)  # raises the exact error, if there is one: here the deviations of all balls were summed
        return unit

    @cached_property
    def _map(self) -> _Map:
        return _map_of(self.model, list(zip(self.crossings, self.joint_ids, strict=True)), self.mechanism.layout)

    @cached_property
    def _placed(self) -> list[Any]:
        """Pinocchio's poses of the parts, in their order: the objects in `data`, which each call updates."""
        placed = self.data.oMf.tolist()
        return [placed[self.frame_ids[part]] for part in self.mechanism.parts]

    def poses(self, Q: FloatArray) -> SE3:
        """Return the poses `(N,)` of all parts for the coordinates `(n_columns,)` of all joints.

        Pinocchio's `Data` must not be too large.

        Raises:
            KinematicsError: As `q`, and if `data` would take more than 1 GiB.
        """
        pin, q = self._pin, self.q(Q)
        with self._lock:  # the workspace belongs to one call at a time
            pin.framesForwardKinematics(self.model, self.data, q)
            placed = np.frombuffer(bytearray().join(map(pin.SE3ToXYZQUAT, self._placed))).reshape(-1, 7)  # faster than concatenate
        rotations = placed[:, 3:]
        np.multiply(rotations, np.copysign(_ONE, placed[:, 6:]), rotations)  # w ≥ 0
        return SE3.from_unit_array(placed)

    @cached_property
    def _pin(self) -> Any:
        import pinocchio  # noqa: PLC0415 - this import costs 50 ms, paid where it is used

        return pinocchio


class LoopModel:
    """Residuals of loops and their Jacobian at one configuration, by Pinocchio.

    The tree with a ghost for each loop joint is one `pinocchio.Model`; each loop is a rigid constraint between the ghost's connector
    A and the real one B. With M = A⁻¹B = (R, t), φ = log R and the relative velocity (v, ω) of B against A, seen from A,

        dt = v − t × ω,    dφ = (I − ½[φ] + c [φ]²) ω,

    where (v, ω) is less Pinocchio's constraint Jacobian times the velocity. Pinocchio measures the spin of a quaternion R in the frame
    after the motion, articad in the frame before it: the columns of the Jacobian are turned by R, which is `dIntegrateTransport`
    along −log R.

    Args:
        closures: The closing conditions of the loops.
    """

    def __init__(self, closures: Closures) -> None:
        import pinocchio as pin  # noqa: PLC0415 - this import costs 50 ms, paid where it is used

        self._pin, self._closures = pin, closures
        arrays, layout = closures.arrays, closures.arrays.layout
        model = pin.Model()
        place = {arrays.ground: (0, _pin_pose(pin, arrays.T_ground))}
        crossed: list[tuple[Crossing, int]] = []
        for c in (*arrays.crossings, *arrays.closing):
            carrier, B_near = place[c.near]
            placement = B_near * _pin_pose(pin, c.A)
            if c.joint.type.freedoms:  # a fixed joint is part of the next one's placement
                carrier = model.addJoint(carrier, _joint_model(pin, c.joint), placement, c.joint.name)
                placement = pin.SE3.Identity()
                crossed.append((c, carrier))
            place[c.far] = (carrier, placement * _pin_pose(pin, c.B))
        self._model = model
        self._map = _map_of(model, crossed, layout)
        order, sign = np.zeros(layout.n_freedoms, dtype=np.intp), np.ones(layout.n_freedoms)
        for c, carrier in crossed:
            own, first = layout.freedoms[c.joint.name], model.joints[carrier].idx_v
            order[own] = range(first, first + own.stop - own.start)
            sign[own] = -1.0 if c.backwards else 1.0
        self._order = None if np.array_equal(order, np.arange(model.nv)) else order
        forwards = np.zeros(model.nv)  # 1 for freedoms of joints that are crossed from parent to child
        forwards[order] = sign > 0
        self._neutral = pin.neutral(model) if any(c.joint.type.quaternion is not None and not c.backwards for c, _ in crossed) else None
        self._forwards = None if forwards.all() else forwards
        constraints, workspaces = pin.StdVec_RigidConstraintModel(), pin.StdVec_RigidConstraintData()
        local = pin.ReferenceFrame.LOCAL
        for (ghost, real), C_c in zip(closures.ends.T.tolist(), closures.connectors, strict=True):
            C = pin.SE3(C_c[:3, :3], C_c[:3, 3])
            (one, P), (two, S) = place[ghost], place[real]
            constraints.append(pin.RigidConstraintModel(pin.ContactType.CONTACT_6D, model, one, P * C, two, S * C, local))
            workspaces.append(constraints[-1].createData())
        self._constraints, self._workspaces, self._data = constraints, workspaces, model.createData()
        rows = np.column_stack([np.repeat(1.0 / closures.lengths[:, None], 3, axis=1), np.ones((len(closures.lengths), 3))])
        # Pinocchio's constraint Jacobian is that of A against B; in the memory order of what it is multiplied with
        in_columns = self._neutral is not None or self._order is not None
        self._weights = np.require(-np.outer(rows, sign * closures.scale), requirements="F" if in_columns else "C")
        self._pairs = list(zip(constraints, workspaces, strict=True))
        # M of each loop, which each call updates in its workspace, and L
        self._mismatches = [(workspace.c1Mc2, float(length)) for workspace, length in zip(workspaces, closures.lengths, strict=True)]
        self._lock = Lock()

    def __reduce__(self) -> tuple[type[LoopModel], tuple[Closures]]:
        """Support pickling by making it again: Pinocchio's workspaces stay in their process."""
        return LoopModel, (self._closures,)

    def residual(self, Q: FloatArray) -> FloatArray:
        """Return the residuals (6 per loop) at `Q` `(columns,)`."""
        return self._evaluated(self._map.q(Q))[0]

    def evaluate(self, Q: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the residuals `(6 loops,)` and their derivatives `(6 loops, freedoms)`, scaled."""
        q = self._map.q(Q)
        r, D = self._evaluated(q)
        if self._neutral is not None:
            pin = self._pin
            back = pin.difference(self._model, q, self._neutral)  # −log R of quaternions; other freedoms are not turned
            if self._forwards is not None:  # crossed backwards, the frame after the motion is that before it
                back *= self._forwards
            D = pin.dIntegrateTransport(self._model, self._neutral, back, D.T, pin.ARG0).T
        if self._order is not None:
            D = D.T.take(self._order, axis=0).T
        if r.dot(r) > _CLOSED**2:
            D = np.ascontiguousarray(D)
            loops = r.reshape(-1, 6).tolist()
            rates = np.array([_residual_rate(loop, length) for loop, (_, length) in zip(loops, self._mismatches, strict=True)])
            D = (rates.reshape(-1, 6, 6) @ D.reshape(-1, 6, D.shape[1])).reshape(D.shape)
        return r, np.multiply(D, self._weights, D)

    def _evaluated(self, q: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return, at Pinocchio's configuration, the residuals `(6 loops,)` and Pinocchio's constraint Jacobian `(6 loops, nv)`."""
        pin = self._pin
        r: list[float] = []
        with self._lock:  # the workspace belongs to one call at a time
            pin.computeJointJacobians(self._model, self._data, q)
            for constraint, workspace in self._pairs:
                constraint.calc(self._model, self._data, workspace)
            D = pin.getConstraintsJacobian(self._model, self._data, self._constraints, self._workspaces)
            for M, length in self._mismatches:
                x, y, z, a, b, c, w = pin.SE3ToXYZQUATtuple(M)
                sine = math.sqrt(a * a + b * b + c * c) + 1e-300  # of half the angle; never zero, and too small to matter
                factor = 2.0 * math.atan(sine / (w or 1e-300)) / sine  # φ = 2 atan(|v| / w) v / |v|, at most π long
                r += (x / length, y / length, z / length, a * factor, b * factor, c * factor)
        return np.array(r), D.reshape(len(r), self._model.nv)  # Pinocchio drops the axis of a single freedom


def _residual_rate(residual: Sequence[float], length: float) -> list[float]:
    """Return the matrix (6, 6), row by row, that takes (v, ω) of B against A to (dt, dφ); see `LoopModel`.

    In plain Python: one loop takes 3 µs, where arrays of three numbers take 20.

    Args:
        residual: (t/L, φ) of a loop.
        length: Its L [mm].
    """
    x, y, z = residual[0] * length, residual[1] * length, residual[2] * length
    a, b, c = residual[3:]
    square = a * a + b * b + c * c
    half = 0.5 * math.sqrt(square)
    if half < 0.125:  # the series of c: see quaternion.inverse_coefficient, which is for arrays
        k = 1 / 12 + square * (1 / 720 + square * (1 / 30240 + square * (1 / 1209600 + square / 47900160)))
    else:
        k = (1.0 - half / math.tan(half)) / square
    ab, ac, bc = k * a * b, k * a * c, k * b * c
    return [
        *(1.0, 0.0, 0.0, 0.0, z, -y),
        *(0.0, 1.0, 0.0, -z, 0.0, x),
        *(0.0, 0.0, 1.0, y, -x, 0.0),
        *(0.0, 0.0, 0.0, 1.0 - k * (b * b + c * c), ab + 0.5 * c, ac - 0.5 * b),
        *(0.0, 0.0, 0.0, ab - 0.5 * c, 1.0 - k * (a * a + c * c), bc + 0.5 * a),
        *(0.0, 0.0, 0.0, ac + 0.5 * b, bc - 0.5 * a, 1.0 - k * (a * a + b * b)),
    ]


def require_data_fits(nv: int) -> None:
    """Refuse a model whose `pinocchio.Data` would take more than 1 GiB.

    Raises:
        KinematicsError: Naming the NumPy functions, which have no such limit.
    """
    size = _DATA_BYTES_PER_CUBE * nv**3
    if size > _DATA_LIMIT_BYTES:
        raise KinematicsError(
            f"pinocchio.Data of {nv} freedoms takes about {size / 2**30:.1f} GiB, more than 1 GiB. "
            "Use Mechanism.poses and Mechanism.jacobian, which work in NumPy (articad.kinematics.batch)."
        )


def compile(mechanism: Mechanism) -> CompiledModel:  # noqa: A001 - articad.kinematics.forward.compile reads as what it does
    """Return the mechanism's tree as a Pinocchio model; joints that close loops and couplings are left out.

    Part frames are body frames named after the parts. Pinocchio silently accepts NaN, duplicate names and reversed limits; the mechanism
    has refused them before.
    """
    import pinocchio as pin  # noqa: PLC0415

    model = pin.Model()
    model.name = "articad"
    arrays = mechanism.arrays
    names = mechanism.parts
    inertia = pin.Inertia.Zero()
    place = {arrays.ground: (0, _pin_pose(pin, mechanism.T_ground))}
    frame_ids = {mechanism.ground: model.addFrame(pin.Frame(mechanism.ground, 0, 0, place[arrays.ground][1], pin.FrameType.BODY, inertia))}
    joint_ids = []
    for c in arrays.crossings:
        carrier, B_near = place[c.near]
        placement = B_near * _pin_pose(pin, c.A)
        if c.joint.type.freedoms:
            carrier = model.addJoint(carrier, _joint_model(pin, c.joint), placement, c.joint.name)
            placement = pin.SE3.Identity()
        joint_ids.append(carrier)
        place[c.far] = (carrier, placement * _pin_pose(pin, c.B))
        frame_ids[names[c.far]] = model.addFrame(pin.Frame(names[c.far], carrier, 0, place[c.far][1], pin.FrameType.BODY, inertia))
    return CompiledModel(model, mechanism, arrays.crossings, tuple(joint_ids), frame_ids)


def _pin_pose(pin: Any, T: SE3) -> Any:
    return pin.SE3(T.rotation, T.translation.copy())


def _joint_model(pin: Any, joint: Joint) -> Any:
    """Return Pinocchio's joint with the same coordinates: one for each step of the joint's type, a screw or a quaternion as a whole."""
    kind, axes = joint.type, "XYZ"
    if any(step.advances for step in kind.steps):  # a screw: Pinocchio's pitch is length per radian
        return getattr(pin, f"JointModelH{axes[kind.steps[0].axis]}")(joint.lead / (2 * np.pi))
    plain = [step for step in kind.steps if step.coordinate is not None]
    models = [getattr(pin, f"JointModel{'R' if step.kind == 'turn' else 'P'}{axes[step.axis]}")() for step in plain]
    if kind.quaternion is not None:
        models.append(pin.JointModelSpherical())
    if len(models) == 1:
        return models[0]
    composite = pin.JointModelComposite(len(models))
    for model in models:
        composite.addJoint(model)
    return composite
