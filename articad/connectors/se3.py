"""SE3: rigid motions, frozen and batched."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NoReturn

import numpy as np
import numpy.typing as npt

from articad.arrays import FloatArray
from articad.connectors import quaternion
from articad.errors import ConnectorError
from articad.findings import Finding, Findings

POSE_TOLERANCE_MM = 1e-6  # tolerances of equal poses: a nanometre …
POSE_TOLERANCE_RAD = 1e-9  # … and a nanoradian: a nanometre at one metre
_QUATERNION_TOLERANCE = 1e-3  # | ‖q‖ − 1 |: the rounding of a file's few digits passes, another quantity does not
_ROTATION_TOLERANCE = 1e-6  # |RᵀR − I|: the digits of a text file pass, shear and scale do not
_AXIS_ZERO = 1e-9  # length below which an axis has no direction
_AXIS_PARALLEL = 1e-6  # |z × x| of unit axes below which x has no direction perpendicular to z
_AXIS_SILENT = 1e-6  # |x · z| from rounding: x is projected without a finding
_AXIS_PROJECTED = 0.0175  # |x · z|, 1 degree: below it x is projected with a warning, above it is an error
_LEAST_PARALLEL_TIE = 1e-9  # components this close are a tie, resolved in the order X, Y, Z


def _refuse(code: str, where: str, message: str, hint: str, value: float | None = None) -> NoReturn:
    finding = Finding(code=code, where=where, message=message, hint=hint, value=value)
    raise ConnectorError(f"{code} {where}: {message} {hint}", findings=[finding])


def _floats(values: npt.ArrayLike, tail: tuple[int, ...], name: str) -> FloatArray:
    """Return finite float64 values whose shape ends in `tail`."""
    array = np.asarray(values, dtype=np.float64)
    if array.shape[len(array.shape) - len(tail) :] != tail:
        raise ConnectorError(f"{name} has shape {array.shape}; its shape must end in {tail}.")
    if not np.isfinite(array).all():
        _refuse("E_NONFINITE", name, f"{name} contains NaN or infinity.", "Give finite numbers.")
    return array


@dataclass(frozen=True, eq=False)
class SE3:
    """Rigid motions: rotation and translation, one or a batch of them.

    Attributes:
        data: `(*batch, 7)` read-only float64: tx ty tz [mm], qx qy qz qw (unit, w ≥ 0).

    Raises:
        ConnectorError: E_NONFINITE, or E_QUAT_NORM if a quaternion is off unit length by more than 1e-3.
    """

    data: FloatArray
    __array_ufunc__ = None  # NumPy must not try `array @ SE3` element by element

    def __post_init__(self) -> None:
        given = _floats(self.data, (7,), "pose")
        norm = np.sqrt((given[..., 3:] ** 2).sum(axis=-1, keepdims=True))
        if given.size and float(np.abs(norm - 1).max()) > _QUATERNION_TOLERANCE:
            worst = float(norm.flat[np.argmax(np.abs(norm - 1))])
            _refuse("E_QUAT_NORM", "pose", f"A quaternion has length {worst:.6g}.", "Give a unit quaternion (x, y, z, w).", worst)
        object.__setattr__(self, "data", _packed(given[..., :3], given[..., 3:] / norm))

    # --- constructors

    @classmethod
    def _trusted(cls, t: FloatArray, q: FloatArray) -> SE3:
        """Return poses from values that are finite and of unit length by construction."""
        return cls.from_unit_array(_packed(t, q))

    @classmethod
    def from_unit_array(cls, data: FloatArray) -> SE3:
        """Return poses that view `data` `(*batch, 7)`, neither copied nor checked; for results of other packages' arithmetic.

        The array is made read-only. Every quaternion must be of unit length with w ≥ 0.
        """
        pose = object.__new__(cls)
        data.setflags(write=False)
        object.__setattr__(pose, "data", data)
        return pose

    @classmethod
    def identity(cls, batch: tuple[int, ...] = ()) -> SE3:
        """Return identity motions."""
        data = np.zeros((*batch, 7))
        data[..., 6] = 1.0
        return cls.from_unit_array(data)

    @classmethod
    def from_matrix(cls, M: npt.ArrayLike) -> SE3:
        """Return the poses of homogeneous matrices `(*batch, 4, 4)` [mm].

        Raises:
            ConnectorError: E_NONFINITE, E_LEFT_HANDED, E_NOT_ROTATION, or a last row other than 0 0 0 1.
        """
        matrix = _floats(M, (4, 4), "matrix")
        if np.abs(matrix[..., 3, :] - (0, 0, 0, 1)).max(initial=0.0) > _ROTATION_TOLERANCE:
            _refuse("E_NOT_ROTATION", "matrix", "The last row is not (0, 0, 0, 1).", "Give a rigid motion.")
        return cls.from_rotation(matrix[..., :3, :3], matrix[..., :3, 3])

    @classmethod
    def from_rotation(cls, R: npt.ArrayLike, translation: npt.ArrayLike | None = None) -> SE3:
        """Return the poses of rotation matrices `(*batch, 3, 3)` and translations `(*batch, 3)` [mm], zero by default.

        Raises:
            ConnectorError: E_NONFINITE, E_LEFT_HANDED (det < 0), E_NOT_ROTATION (|RᵀR − I| > 1e-6).
        """
        rotation = _floats(R, (3, 3), "rotation")
        error = np.abs(np.swapaxes(rotation, -1, -2) @ rotation - np.eye(3)).max(initial=0.0)
        if error > _ROTATION_TOLERANCE:
            _refuse(
                "E_NOT_ROTATION", "rotation", f"RᵀR differs from the identity by {error:.3g}.", "Give orthonormal columns.", float(error)
            )
        if rotation.size and np.linalg.det(rotation).min() < 0:
            _refuse("E_LEFT_HANDED", "rotation", "The determinant is −1: a mirrored frame.", "Use derive: mirror for mirrored parts.")
        return cls._trusted(_translations(translation), quaternion.from_matrix(rotation))

    @classmethod
    def from_translation(cls, t: npt.ArrayLike) -> SE3:
        """Return translations by `t` `(*batch, 3)` [mm]."""
        return cls._trusted(_floats(t, (3,), "translation"), np.array([0.0, 0.0, 0.0, 1.0]))

    @classmethod
    def from_quaternion(cls, xyzw: npt.ArrayLike, translation: npt.ArrayLike | None = None) -> SE3:
        """Return the poses of quaternions `(*batch, 4)` and translations `(*batch, 3)` [mm], zero by default."""
        q = _floats(xyzw, (4,), "quaternion")
        t = _translations(translation)
        batch = np.broadcast_shapes(q.shape[:-1], t.shape[:-1])
        return cls(np.concatenate([np.broadcast_to(t, (*batch, 3)), np.broadcast_to(q, (*batch, 4))], axis=-1))

    @classmethod
    def from_axes(cls, o: npt.ArrayLike, z: npt.ArrayLike, x: npt.ArrayLike | None = None, *, where: str = "frame") -> SE3:
        """Return the frame with origin `o` [mm], third axis along `z`, and first axis along `x` projected perpendicular to z.

        Args:
            o: Origin `(3,)` [mm].
            z: Direction `(3,)`, any length.
            x: Direction `(3,)`; by default the world axis least parallel to z.
            where: Path for the findings, such as `parts.door.connectors.hinge`.

        Raises:
            ConnectorError: With the findings of `axis_findings` if one of them is an error.
        """
        findings = axis_findings(o, z, x, where=where)
        if not findings.ok:
            raise ConnectorError("\n".join(map(str, findings.errors)), findings=findings)
        z_axis = _unit(np.asarray(z, dtype=np.float64))
        x_axis = project_across(world_x(z_axis) if x is None else _unit(np.asarray(x, dtype=np.float64)), z_axis)
        R = np.stack([x_axis, quaternion.cross(z_axis, x_axis), z_axis], axis=-1)
        return cls.from_rotation(R, o)

    @classmethod
    def from_axis_angle(cls, axis: npt.ArrayLike, angle: npt.ArrayLike, about: npt.ArrayLike | None = None) -> SE3:
        """Return rotations by `angle` `(*batch)` [rad] about `axis` `(*batch, 3)` (any length), through the point `about` [mm].

        Raises:
            ConnectorError: E_AXIS_ZERO, E_NONFINITE.
        """
        direction = _floats(axis, (3,), "axis")
        length = np.sqrt((direction * direction).sum(axis=-1, keepdims=True))
        if length.min(initial=np.inf) < _AXIS_ZERO:
            _refuse("E_AXIS_ZERO", "axis", "The axis has no direction.", "Give a direction, such as (0, 0, 1).")
        q = quaternion.exp(direction / length * _floats(angle, (), "angle")[..., None])
        centre = _translations(about)
        return cls._trusted(centre - quaternion.rotate(q, centre), q)

    @classmethod
    def rot_x(cls, angle: npt.ArrayLike) -> SE3:
        """Return rotations about x by `angle` `(*batch)` [rad]."""
        return cls._turn(angle, 0)

    @classmethod
    def rot_y(cls, angle: npt.ArrayLike) -> SE3:
        """Return rotations about y by `angle` `(*batch)` [rad]."""
        return cls._turn(angle, 1)

    @classmethod
    def rot_z(cls, angle: npt.ArrayLike) -> SE3:
        """Return rotations about z by `angle` `(*batch)` [rad]."""
        return cls._turn(angle, 2)

    @classmethod
    def _turn(cls, angle: npt.ArrayLike, axis: int) -> SE3:
        half = 0.5 * _floats(angle, (), "angle")
        q = np.zeros((*half.shape, 4))
        q[..., axis], q[..., 3] = np.sin(half), np.cos(half)
        return cls._trusted(np.zeros(3), q)

    @classmethod
    def trans(cls, x: npt.ArrayLike, y: npt.ArrayLike, z: npt.ArrayLike) -> SE3:
        """Return translations by `x`, `y`, `z` `(*batch)` [mm]."""
        return cls.from_translation(np.stack(np.broadcast_arrays(*(np.asarray(c, dtype=np.float64) for c in (x, y, z))), axis=-1))

    @classmethod
    def exp(cls, xi: npt.ArrayLike) -> SE3:
        """Return the motions of the twists `xi` `(*batch, 6)`: v [mm], then ω [rad]."""
        twist = _floats(xi, (6,), "twist")
        v, omega = twist[..., :3], twist[..., 3:]
        return cls._trusted(quaternion.exp_translation(omega, v), quaternion.exp(omega))

    @classmethod
    def stack(cls, poses: Sequence[SE3]) -> SE3:
        """Return the poses along a new first batch axis."""
        return cls.from_unit_array(np.stack([pose.data for pose in poses]))

    # --- views

    @property
    def batch_shape(self) -> tuple[int, ...]:
        """Shape of the batch; () for a single pose."""
        return self.data.shape[:-1]

    @property
    def translation(self) -> FloatArray:
        """Translations `(*batch, 3)` [mm]."""
        return self.data[..., :3]

    @property
    def quaternion(self) -> FloatArray:
        """Unit quaternions `(*batch, 4)`, x y z w, w ≥ 0."""
        return self.data[..., 3:]

    @property
    def rotation(self) -> FloatArray:
        """Rotation matrices `(*batch, 3, 3)`."""
        return quaternion.to_matrix(self.quaternion)

    @property
    def matrix(self) -> FloatArray:
        """Homogeneous matrices `(*batch, 4, 4)`."""
        M = np.zeros((*self.batch_shape, 4, 4))
        M[..., :3, :3], M[..., :3, 3], M[..., 3, 3] = self.rotation, self.translation, 1.0
        return M

    @property
    def x_axis(self) -> FloatArray:
        """First axes `(*batch, 3)`."""
        return self.rotation[..., :, 0]

    @property
    def y_axis(self) -> FloatArray:
        """Second axes `(*batch, 3)`."""
        return self.rotation[..., :, 1]

    @property
    def z_axis(self) -> FloatArray:
        """Third axes `(*batch, 3)`."""
        return self.rotation[..., :, 2]

    # --- group

    def inverse(self) -> SE3:
        """Return the inverse motions."""
        q = quaternion.conjugate(self.quaternion)
        return SE3._trusted(-quaternion.rotate(q, self.translation), q)

    def __matmul__(self, other: SE3) -> SE3:
        """Return the composition: first `other`, then `self`; batches broadcast."""
        if not isinstance(other, SE3):
            return NotImplemented
        q = self.quaternion
        return SE3._trusted(self.translation + quaternion.rotate(q, other.translation), quaternion.multiply(q, other.quaternion))

    def apply(self, points: npt.ArrayLike) -> FloatArray:
        """Return the images of `points` `(*points, 3)` [mm]; batch and points broadcast, so one pose takes `(n, 3)`."""
        return quaternion.rotate(self.quaternion, np.asarray(points, dtype=np.float64)) + self.translation

    def rotate(self, vectors: npt.ArrayLike) -> FloatArray:
        """Return the images of directions `(*vectors, 3)`, which a translation does not change."""
        return quaternion.rotate(self.quaternion, np.asarray(vectors, dtype=np.float64))

    def log(self) -> FloatArray:
        """Return the twists `(*batch, 6)` of these motions: v [mm], then ω [rad], |ω| ≤ π."""
        omega = quaternion.log(self.quaternion)
        return np.concatenate([quaternion.log_translation(omega, self.translation), omega], axis=-1)

    def adjoint(self) -> FloatArray:
        """Return the matrices `(*batch, 6, 6)` that map a twist [v; ω] of the inner frame to the outer one."""
        R, t = self.rotation, self.translation
        Ad = np.zeros((*self.batch_shape, 6, 6))
        Ad[..., :3, :3] = Ad[..., 3:, 3:] = R
        Ad[..., :3, 3:] = np.swapaxes(quaternion.cross(t[..., None, :], np.swapaxes(R, -1, -2)), -1, -2)
        return Ad

    def interpolate(self, other: SE3, s: npt.ArrayLike) -> SE3:
        """Return the poses at the fraction `s` of the screw motion from these to `other`: 0 here, 1 there."""
        return self @ SE3.exp(np.asarray(s, dtype=np.float64)[..., None] * (self.inverse() @ other).log())

    # --- comparison

    def angle_to(self, other: SE3) -> FloatArray:
        """Return the angles `(*batch)` [rad] of the rotations between these and `other`, 0 … π."""
        q = quaternion.multiply(quaternion.conjugate(self.quaternion), other.quaternion)
        angle: FloatArray = 2.0 * np.arctan2(np.sqrt((q[..., :3] ** 2).sum(axis=-1)), np.abs(q[..., 3]))
        return angle

    def distance_to(self, other: SE3) -> FloatArray:
        """Return the distances `(*batch)` [mm] between the origins of these and `other`."""
        distance: FloatArray = np.sqrt(((self.translation - other.translation) ** 2).sum(axis=-1))
        return distance

    def allclose(self, other: SE3, mm: float = POSE_TOLERANCE_MM, rad: float = POSE_TOLERANCE_RAD) -> bool:
        """Return whether all poses agree within `mm` and `rad`."""
        return bool((self.distance_to(other) <= mm).all() and (self.angle_to(other) <= rad).all())

    def __eq__(self, other: object) -> bool:
        return isinstance(other, SE3) and self.data.shape == other.data.shape and bool((self.data == other.data).all())

    def __hash__(self) -> int:
        return hash((self.data.shape, (self.data + 0.0).tobytes()))  # + 0.0: −0 equals 0

    # --- batch

    def __getitem__(self, index: Any) -> SE3:
        """Return the poses at `index` of the batch axes."""
        key = index if isinstance(index, tuple) else (index,)
        if any(part is Ellipsis for part in key):
            key = (*key, slice(None))
        elif not self.batch_shape:
            raise IndexError("a single pose has no batch to index")
        data = self.data[key]
        if data.ndim == 0 or data.shape[-1] != 7:
            raise IndexError(f"{index!r} is too long for the batch {self.batch_shape}")
        return SE3.from_unit_array(data)

    def reshape(self, *batch: int) -> SE3:
        """Return the same poses with another batch shape."""
        return SE3.from_unit_array(self.data.reshape(*batch, 7))

    def __len__(self) -> int:
        if not self.batch_shape:
            raise TypeError("a single pose has no length")
        return self.batch_shape[0]

    def __iter__(self) -> Iterator[SE3]:
        return (self[i] for i in range(len(self)))

    def __repr__(self) -> str:
        if self.batch_shape:
            return f"SE3(batch={self.batch_shape})"
        return f"SE3(t=({', '.join(f'{c:.6g}' for c in self.translation)}), xyzw=({', '.join(f'{c:.6g}' for c in self.quaternion)}))"


def axis_findings(o: npt.ArrayLike, z: npt.ArrayLike, x: npt.ArrayLike | None = None, *, where: str = "frame") -> Findings:
    """Return all faults of a frame given as origin, z and x.

    Args:
        o: Origin `(3,)` [mm].
        z: Direction `(3,)`, any length.
        x: Direction `(3,)`, or None if a rule chooses it.
        where: Path of the frame, such as `parts.door.connectors.hinge`.

    Returns:
        E_NONFINITE, E_AXIS_ZERO, E_AXIS_PARALLEL, E_AXIS_NOT_ORTHOGONAL, W_AXIS_NOT_ORTHOGONAL; empty for a good frame.
    """
    given = {key: _vector(value, f"{where}.{key}") for key, value in (("o", o), ("z", z), ("x", x)) if value is not None}
    findings = []
    for key, vector in given.items():
        if not np.isfinite(vector).all():
            findings.append(_axis_finding("E_NONFINITE", f"{where}.{key}", f"{_text(vector)} is not finite.", "Give finite numbers."))
        elif key != "o" and np.linalg.norm(vector) < _AXIS_ZERO:
            hint = (
                f"Give a direction, such as {_text(_z_across(given.get('x')))}." if key == "z" else "Give a direction perpendicular to z."
            )
            findings.append(_axis_finding("E_AXIS_ZERO", f"{where}.{key}", f"{_text(vector)} has no direction.", hint))
    if not findings and "x" in given:
        findings.extend(_right_angle_findings(_unit(given["z"]), _unit(given["x"]), f"{where}.x"))
    return Findings(findings)


def _z_across(x: FloatArray | None) -> FloatArray:
    """Return a z `(3,)` perpendicular to x, upwards where that is possible."""
    up = np.array([0.0, 0.0, 1.0])
    if x is None or not np.isfinite(x).all() or np.linalg.norm(x) < _AXIS_ZERO or abs(x @ up) < _AXIS_PARALLEL:
        return up
    return world_x(x)


def _right_angle_findings(z: FloatArray, x: FloatArray, where: str) -> list[Finding]:
    along = float(x @ z)
    angle = float(np.degrees(np.arctan2(np.linalg.norm(quaternion.cross(z, x)), along)))
    if np.linalg.norm(quaternion.cross(z, x)) < _AXIS_PARALLEL:
        hint = f"Choose x perpendicular to z, such as {_text(project_across(world_x(z), z))}."
        return [_axis_finding("E_AXIS_PARALLEL", where, f"x {_text(x)} is parallel to z {_text(z)}.", hint)]
    if abs(along) <= _AXIS_SILENT:
        return []
    right = _text(project_across(x, z))
    message = f"x makes {angle:.4g}° with z."
    if abs(along) > _AXIS_PROJECTED:
        return [_axis_finding("E_AXIS_NOT_ORTHOGONAL", where, message, f"Did you mean x={right}?", angle)]
    return [_axis_finding("W_AXIS_NOT_ORTHOGONAL", where, f"{message} It was projected.", f"Set x to {right}.", angle)]


def _axis_finding(code: str, where: str, message: str, hint: str, angle: float | None = None) -> Finding:
    if angle is None:
        return Finding(code=code, where=where, message=message, hint=hint)
    return Finding(code=code, where=where, message=message, hint=hint, value=angle, limit=90.0, unit="deg")


def world_x(z: npt.ArrayLike) -> FloatArray:
    """Return the world axis `(3,)` least parallel to `z`, projected perpendicular to it: X before Y before Z on ties within 1e-9."""
    direction = _unit(np.asarray(z, dtype=np.float64))
    components = np.abs(direction)
    first = int(np.argmax(components <= components.min() + _LEAST_PARALLEL_TIE))
    return project_across(np.eye(3)[first], direction)


def project_across(x: FloatArray, z: FloatArray) -> FloatArray:
    """Project x perpendicular to the unit vector z; twice, because one projection leaves rounding proportional to x · z."""
    for _ in range(2):
        x = _unit(x - (x * z).sum() * z)
    return x


def _unit(v: FloatArray) -> FloatArray:
    unit: FloatArray = v / quaternion.length(v)
    return unit


def _vector(value: npt.ArrayLike, where: str) -> FloatArray:
    vector = np.asarray(value, dtype=np.float64)
    if vector.shape != (3,):
        raise ConnectorError(f"{where} has shape {vector.shape}; three numbers are needed.")
    return vector


def _text(v: FloatArray) -> str:
    return f"({', '.join(f'{c + 0.0:.6g}' for c in v)})"


def _translations(t: npt.ArrayLike | None) -> FloatArray:
    return np.zeros(3) if t is None else _floats(t, (3,), "translation")


def _packed(t: FloatArray, q: FloatArray) -> FloatArray:
    """Return a new array `(*batch, 7)` with w ≥ 0."""
    batch = t.shape[:-1] if t.shape[:-1] == q.shape[:-1] else np.broadcast_shapes(t.shape[:-1], q.shape[:-1])
    data = np.empty((*batch, 7))
    data[..., :3] = t
    data[..., 3:] = quaternion.positive(q)
    data.setflags(write=False)
    return data
