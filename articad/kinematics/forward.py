"""The only module that imports Pinocchio: a mechanism's tree as a `pinocchio.Model`, for dynamics and as an oracle."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from articad.connectors import SE3, FloatArray
from articad.errors import KinematicsError
from articad.kinematics.crossings import Crossing
from articad.kinematics.joints import Joint, JointType
from articad.kinematics.layout import QUATERNION_TOLERANCE, IndexArray

if TYPE_CHECKING:
    from articad.kinematics.mechanism import Mechanism

# pinocchio.Data allocates about this many bytes times nv³ (68 MiB at nv = 100, 4.0 GiB at nv = 400, measured with 4.1.0)
_DATA_BYTES_PER_CUBE = 64
_DATA_LIMIT_BYTES = 1 << 30
_ONE = np.ones(())  # an array: making one of a number takes longer than the signs of ten parts


class _Map(NamedTuple):
    """From the coordinates of all joints to Pinocchio's configuration.

    Attributes:
        columns: For each place in Pinocchio's q, the column of the coordinate that it comes from.
        signs: −1 where Pinocchio measures the other way.
        turned: Places of the cosine, before the sine, of each planar joint's angle; None without any.
    """

    columns: IndexArray
    signs: FloatArray
    turned: IndexArray | None


@dataclass(frozen=True, eq=False)
class CompiledModel:
    """A tree as Pinocchio holds it, joints numbered depth-first.

    Attributes:
        model: The `pinocchio.Model`; frames bear the names of the parts. Lengths are mm.
        mechanism: Where it comes from.
        crossings: The tree's joints in the order in which they were added; fixed ones have no Pinocchio joint.
        joint_ids: Pinocchio's joint of each crossing; of a fixed one the joint that carries it.
        frame_ids: Frame of each part by name.
    """

    model: Any
    mechanism: Mechanism
    crossings: tuple[Crossing, ...]
    joint_ids: tuple[int, ...]
    frame_ids: dict[str, int]

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
        map_ = self._map
        q = map_.signs * Q.take(map_.columns)
        if not q.dot(q) < np.inf:  # so that nothing below is asked for the cosine of infinity
            self.mechanism.layout.normalized(Q)
        if map_.turned is not None:  # a planar joint's angle is a direction there
            q[map_.turned] = np.cos(q[map_.turned])
            q[map_.turned + 1] = np.sin(q[map_.turned + 1])
        unit: FloatArray = self._pin.normalize(self.model, q)
        off = unit - q  # of a quaternion it is as long as its length is off
        if not off.dot(off) < QUATERNION_TOLERANCE**2:
            self.mechanism.layout.normalized(Q)  # says what is wrong, if anything is: here the errors of all balls were added
        return unit

    @cached_property
    def _map(self) -> _Map:
        columns, signs = np.zeros(self.model.nq, dtype=np.intp), np.ones(self.model.nq)
        turned: list[int] = []
        for c, joint_id in zip(self.crossings, self.joint_ids, strict=True):
            if not c.joint.type.freedoms:
                continue
            first, start = self.mechanism.layout.columns[c.joint.name].start, self.model.joints[joint_id].idx_q
            n = len(c.signs)
            columns[start : start + n] = range(first, first + n)
            signs[start : start + n] = c.signs
            if c.joint.type is JointType.PLANAR:
                turned.append(start + n - 1)
                columns[start + n], signs[start + n] = columns[start + n - 1], signs[start + n - 1]
        return _Map(columns, signs, np.array(turned, dtype=np.intp) if turned else None)

    @cached_property
    def _placed(self) -> list[Any]:
        """Pinocchio's poses of the parts, in their order: the objects in `data`, which each call moves."""
        placed = self.data.oMf.tolist()
        return [placed[self.frame_ids[part]] for part in self.mechanism.parts]

    def poses(self, Q: FloatArray) -> SE3:
        """Return the poses `(N,)` of all parts for the coordinates `(n_columns,)` of all joints.

        For one configuration this is several times faster than `Mechanism.poses`; Pinocchio's `Data` has to fit.

        Raises:
            KinematicsError: As `q`, and if `data` would take more than 1 GiB.
        """
        pin = self._pin
        pin.framesForwardKinematics(self.model, self.data, self.q(Q))
        placed = np.concatenate(list(map(pin.SE3ToXYZQUAT, self._placed))).reshape(-1, 7)
        rotations = placed[:, 3:]
        np.multiply(rotations, np.copysign(_ONE, placed[:, 6:]), out=rotations)
        return SE3.from_unit_array(placed)

    @cached_property
    def _pin(self) -> Any:
        import pinocchio  # noqa: PLC0415 - this import costs 50 ms, paid where it is used

        return pinocchio


def require_data_fits(nv: int) -> None:
    """Refuse a model whose `pinocchio.Data` would take more than 1 GiB.

    Raises:
        KinematicsError: Naming the NumPy way, which has no such limit.
    """
    size = _DATA_BYTES_PER_CUBE * nv**3
    if size > _DATA_LIMIT_BYTES:
        raise KinematicsError(
            f"pinocchio.Data of {nv} freedoms takes about {size / 2**30:.1f} GiB, more than 1 GiB. "
            "Use Mechanism.poses and Mechanism.jacobian, which work in NumPy (articad.kinematics.batch)."
        )


def compile(mechanism: Mechanism) -> CompiledModel:  # noqa: A001 - articad.kinematics.forward.compile reads as what it does
    """Return the mechanism's tree as a Pinocchio model; joints that close loops and couplings are left out.

    Part frames are body frames named after the parts. Nothing is taken over unchecked: Pinocchio accepts NaN, duplicate
    names and reversed limits silently, the mechanism refused them before.
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


def _joint_model(pin: Any, joint: Joint) -> Any:  # noqa: PLR0911 - one row per type
    match joint.type:
        case JointType.REVOLUTE:
            return pin.JointModelRZ()
        case JointType.SLIDER:
            return pin.JointModelPZ()
        case JointType.CYLINDRICAL:
            composite = pin.JointModelComposite(2)
            composite.addJoint(pin.JointModelPZ())
            composite.addJoint(pin.JointModelRZ())
            return composite
        case JointType.BALL:
            return pin.JointModelSpherical()
        case JointType.SCREW:
            return pin.JointModelHZ(joint.lead / (2 * np.pi))  # Pinocchio's pitch is length per radian
        case JointType.PLANAR:
            return pin.JointModelPlanar()
        case JointType.FREE:
            return pin.JointModelFreeFlyer()
        case _:
            return pin.JointModelUniversal(np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]))
