"""Configuration: the coordinates of all joints, by name."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType

import numpy as np
import numpy.typing as npt

from articad.arrays import FloatArray
from articad.connectors import SE3, quaternion
from articad.errors import KinematicsError, LimitError, UnknownJointError
from articad.kinematics.joints import LIMIT_SLACK, Joint, JointType, swing, twist

_ENDLESS_ANGLE = math.pi  # rad: range of random angles of an endless joint, in both directions
_ENDLESS_TRAVEL = 100.0  # mm: range of random travels of an endless joint, in both directions


@dataclass(frozen=True, eq=False)
class Configuration:
    """Coordinates of a set of joints, one configuration or a batch of them.

    Attributes:
        joints: In the order in which they are declared.
        columns: `(*batch, n)` read-only: all their coordinates in order [rad, mm].

    Raises:
        KinematicsError: If the number of columns is not that of the joints' coordinates, or a value is not finite.
    """

    joints: tuple[Joint, ...]
    columns: FloatArray

    def __post_init__(self) -> None:
        columns = np.array(self.columns, dtype=np.float64)
        if columns.ndim == 0 or columns.shape[-1] != self._offsets[-1]:
            raise KinematicsError(f"The joints have {self._offsets[-1]} coordinates; the array has shape {columns.shape}.")
        if not np.isfinite(columns).all():
            raise KinematicsError("E_NONFINITE: a coordinate is NaN or infinite.")
        columns.setflags(write=False)
        object.__setattr__(self, "columns", columns)

    @cached_property
    def _offsets(self) -> tuple[int, ...]:
        sizes = [len(joint.type.coordinates) for joint in self.joints]
        return tuple(int(n) for n in np.concatenate([[0], np.cumsum(sizes)]))

    @cached_property
    def _index(self) -> dict[str, int]:
        return {joint.name: i for i, joint in enumerate(self.joints)}

    # --- making one

    @classmethod
    def neutral(cls, joints: Sequence[Joint]) -> Configuration:
        """Return the configuration in which every J is the identity, whatever the limits."""
        return cls(tuple(joints), np.array([value for joint in joints for value in joint.type.neutral]))

    @classmethod
    def rest(cls, joints: Sequence[Joint]) -> Configuration:
        """Return the configuration of the rest pose."""
        return cls(tuple(joints), np.array([value for joint in joints for value in joint.rest]))

    @classmethod
    def of(cls, joints: Sequence[Joint], values: Mapping[str, float | Sequence[float]]) -> Configuration:
        """Return the rest configuration with some joints set.

        Args:
            joints: All joints.
            values: By joint name: a number for a joint of one coordinate, else one number per coordinate [rad, mm].

        Raises:
            UnknownJointError: If there is no joint of that name.
            KinematicsError: If the number of values is wrong.
        """
        rest = cls.rest(joints)
        columns = rest.columns.copy()
        for name, value in values.items():
            part = rest._slice(name)  # noqa: SLF001 - a method of its own class
            given = np.atleast_1d(np.asarray(value, dtype=np.float64))
            if given.shape != (part.stop - part.start,):
                raise KinematicsError(f"Joint {name!r} has {part.stop - part.start} coordinate(s); {given.size} given.")
            columns[part] = given
        return cls(tuple(joints), columns)

    @classmethod
    def random(cls, joints: Sequence[Joint], rng: np.random.Generator, batch: tuple[int, ...] = ()) -> Configuration:
        """Return configurations drawn uniformly within the limits; endless coordinates within half a turn or 100 mm."""
        parts = [_random(joint, rng, batch) for joint in joints]
        return cls(tuple(joints), np.concatenate([np.empty((*batch, 0)), *parts], axis=-1))

    # --- reading

    @property
    def batch_shape(self) -> tuple[int, ...]:
        """Shape of the batch; () for one configuration."""
        return self.columns.shape[:-1]

    @cached_property
    def values(self) -> Mapping[str, tuple[float, ...]]:
        """The coordinates of each joint by name; only for a single configuration."""
        if self.batch_shape:
            raise KinematicsError("A batch of configurations has arrays: use configuration[joint].")
        return MappingProxyType({joint.name: tuple(float(v) for v in self[joint.name]) for joint in self.joints})

    def __getitem__(self, joint: str) -> FloatArray:
        """Return the coordinates `(*batch, n_coordinates)` of a joint."""
        return self.columns[..., self._slice(joint)]

    def _slice(self, joint: str) -> slice:
        if joint not in self._index:
            raise UnknownJointError(joint, self._index)
        i = self._index[joint]
        return slice(self._offsets[i], self._offsets[i + 1])

    def motion(self, joint: str) -> SE3:
        """Return J(q) `(*batch)` of a joint."""
        columns = self[joint]
        return self.joints[self._index[joint]].motion(columns)

    # --- limits

    def violations(self, slack: float = LIMIT_SLACK) -> tuple[LimitError, ...]:
        """Return one error per coordinate that exceeds its limits by more than `slack` [rad, mm], with the worst value.

        For a ball, its cone (reported as `joint.swing`) and its twist (`joint.twist`) are checked.
        """
        errors = []
        for joint in self.joints:
            for name, unit, values, lower, upper in _bounded(joint, self[joint.name]):
                excess = np.maximum(lower - values, values - upper)
                if excess.size and excess.max() > slack:
                    errors.append(LimitError(name, float(values.flat[np.argmax(excess)]), lower, upper, unit))
        return tuple(errors)

    def require_within_limits(self) -> Configuration:
        """Return this configuration.

        Raises:
            LimitError: For the first coordinate that is outside its limits.
        """
        for error in self.violations():
            raise error
        return self

    def clamp(self) -> Configuration:
        """Return the nearest configuration within the limits, joint by joint."""
        parts = [_clamped(joint, self[joint.name]) for joint in self.joints]
        return Configuration(self.joints, np.concatenate([np.empty((*self.batch_shape, 0)), *parts], axis=-1))

    def interpolate(self, other: Configuration, s: npt.ArrayLike) -> Configuration:
        """Return the configuration at the fraction `s` between this one and `other`; balls turn about one axis by the smaller angle."""
        fraction = np.asarray(s, dtype=np.float64)[..., None]
        columns = self.columns + fraction * (other.columns - self.columns)
        for joint in self.joints:
            if joint.type.quaternion is not None:
                part = self._slice(joint.name)
                part = slice(part.start + joint.type.quaternion, part.stop)
                start, end = SE3.from_quaternion(self.columns[..., part]), SE3.from_quaternion(other.columns[..., part])
                columns[..., part] = start.interpolate(end, s).quaternion
        return Configuration(self.joints, columns)

    def __repr__(self) -> str:
        if self.batch_shape:
            return f"Configuration(batch={self.batch_shape}, joints={list(self._index)})"
        return f"Configuration({', '.join(f'{name}={values}' for name, values in self.values.items())})"


def _bounded(joint: Joint, values: FloatArray) -> list[tuple[str, str, FloatArray, float, float]]:
    """Return the bounded quantities: name, unit, values `(*batch)`, lower, upper."""
    if joint.type is JointType.FREE:
        return []
    if joint.type is not JointType.BALL:
        return [(c.name, c.unit, values[..., i], c.lower, c.upper) for i, c in enumerate(joint.columns)]
    limits = []
    if joint.limits.cone is not None:
        limits.append((f"{joint.name}.swing", "rad", np.asarray(swing(values)), 0.0, joint.limits.cone))
    if joint.limits.twist is not None:
        limits.append((f"{joint.name}.twist", "rad", np.asarray(twist(values)), *joint.limits.twist))
    return limits


def _random(joint: Joint, rng: np.random.Generator, batch: tuple[int, ...]) -> FloatArray:
    if joint.type is JointType.FREE:
        turned = rng.normal(size=(*batch, 4))
        place = np.array(joint.rest[:3]) + rng.uniform(-_ENDLESS_TRAVEL, _ENDLESS_TRAVEL, (*batch, 3))
        return np.concatenate([place, quaternion.positive(quaternion.normalized(turned))], axis=-1)
    if joint.type is JointType.BALL:
        low, high = joint.limits.twist or (-math.pi, math.pi)
        direction, tilt = rng.uniform(-math.pi, math.pi, batch), (joint.limits.cone or math.pi) * np.sqrt(rng.random(batch))
        return _ball(np.asarray(direction), np.asarray(tilt), np.asarray(rng.uniform(low, high, batch)))
    columns = [np.empty((*batch, 0))]
    for c in joint.columns:
        span = _ENDLESS_ANGLE if c.unit == "rad" else _ENDLESS_TRAVEL
        low = c.lower if math.isfinite(c.lower) else min(c.rest, c.upper) - span
        high = c.upper if math.isfinite(c.upper) else max(c.rest, c.lower) + span
        columns.append(np.asarray(rng.uniform(low, high, batch))[..., None])
    return np.concatenate(columns, axis=-1)


def _ball(direction: FloatArray, tilt: FloatArray, turn: FloatArray) -> FloatArray:
    """Return quaternions `(*batch, 4)` that turn by `turn` about z and then swing by `tilt` about an axis perpendicular to z."""
    level = np.stack([np.cos(direction), np.sin(direction), np.zeros_like(direction)], axis=-1)
    spin = np.stack([np.zeros_like(turn), np.zeros_like(turn), turn], axis=-1)
    return quaternion.positive(quaternion.multiply(quaternion.exp(level * tilt[..., None]), quaternion.exp(spin)))


def _clamped(joint: Joint, values: FloatArray) -> FloatArray:
    if joint.type is JointType.FREE:
        return values
    if joint.type is not JointType.BALL:
        return np.clip(values, joint.limits.lower, joint.limits.upper)
    x, y, z, w = np.moveaxis(values, -1, 0)
    low, high = joint.limits.twist or (-math.pi, math.pi)
    turn = np.clip(twist(values), low, high)
    tilt = np.minimum(swing(values), math.pi if joint.limits.cone is None else joint.limits.cone)
    # q = swing ⊗ twist: the swing's axis is (x, y) rotated forward by half the twist
    direction = np.arctan2(y, x) + np.arctan2(z, w)
    return _ball(direction, tilt, turn)
