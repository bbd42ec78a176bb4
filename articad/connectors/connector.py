"""Connectors: named frames on parts, where joints attach."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from articad.arrays import FloatArray
from articad.connectors import quaternion
from articad.connectors.se3 import SE3
from articad.errors import ConnectorError
from articad.findings import Finding

_NORMAL_ZERO = 1e-9  # length below which a normal has no direction
_K = np.array([1.0, -1.0, 1.0, 1.0])  # the diagonal of K: y is reversed after a reflection, so that the frame is right-handed again


@dataclass(frozen=True, eq=False)
class Plane:
    """A mirror plane.

    Attributes:
        point: Any of its points `(3,)` [mm].
        normal: Its unit normal `(3,)`; given with any length.

    Raises:
        ConnectorError: E_AXIS_ZERO, E_NONFINITE.
    """

    point: FloatArray
    normal: FloatArray

    def __post_init__(self) -> None:
        point, normal = np.array(self.point, dtype=np.float64), np.array(self.normal, dtype=np.float64)
        if point.shape != (3,) or normal.shape != (3,) or not np.isfinite([point, normal]).all():
            raise _plane_error("E_NONFINITE", "A plane needs a point and a normal of three finite numbers each.")
        length = quaternion.length(normal)
        if length < _NORMAL_ZERO:
            raise _plane_error("E_AXIS_ZERO", "The plane's normal has zero length.")
        for name, vector in (("point", point), ("normal", normal / length)):
            vector.setflags(write=False)
            object.__setattr__(self, name, vector)

    @property
    def matrix(self) -> FloatArray:
        """The reflection `(4, 4)`: linear part I − 2nnᵀ, determinant −1."""
        S = np.eye(4)
        S[:3, :3] -= 2.0 * np.outer(self.normal, self.normal)
        S[:3, 3] = 2.0 * (self.normal * self.point).sum() * self.normal
        return S


@dataclass(frozen=True)
class Drift:
    """Deviation of a frame from its target, in components that are meaningful at an axis.

    Attributes:
        radial: Distance from the z axis [mm].
        along: Distance along the z axis [mm], without sign.
        axis: Angle between the two z axes [rad], 0 … π.
        roll: Signed angle about z [rad].
    """

    radial: float
    along: float
    axis: float
    roll: float

    @classmethod
    def of(cls, D: SE3) -> Drift:
        """Return the components of a single mismatch D."""
        R, t = D.rotation, D.translation
        return cls(
            radial=float(np.hypot(t[0], t[1])),
            along=float(abs(t[2])),
            axis=float(np.arctan2(np.hypot(R[0, 2], R[1, 2]), R[2, 2])),  # acos(R33), accurate near 0 as well
            roll=float(np.arctan2(R[1, 0] - R[0, 1], R[0, 0] + R[1, 1])),
        )


@dataclass(frozen=True)
class Connector:
    """A named frame on a part.

    Attributes:
        name: Unique within the part.
        frame: C in the part's frame: origin, z along the joint's axis, x the zero of its angle.
        label: Free text for whoever builds the part.
        kind: hinge_axis, slide_axis, shaft_axis, bore_axis, ball_centre, mount_face, gear_axis, thread_axis or frame.
        roll_free: True if x was chosen by rule, not stated; then only origin and z are compared.
    """

    name: str
    frame: SE3
    label: str = ""
    kind: str = "frame"
    roll_free: bool = False

    def moved(self, T: SE3) -> Connector:
        """Return the same connector with its frame moved by T."""
        return replace(self, frame=T @ self.frame)

    def mirrored(self, S: npt.ArrayLike) -> Connector:
        """Return the connector of the mirrored part: S · C · diag(1, −1, 1), right-handed again.

        Args:
            S: Reflection `(4, 4)` in the part's frame.
        """
        return replace(self, frame=SE3.from_matrix(quaternion.product(np.asarray(S, dtype=np.float64), self.frame.matrix * _K)))

    def drift(self, realised: SE3) -> Drift:
        """Return the deviation of a realised frame from this one."""
        return Drift.of(self.frame.inverse() @ realised)


def _plane_error(code: str, message: str) -> ConnectorError:
    finding = Finding(code=code, where="plane", message=message, hint="Give a point and a normal, such as (1, 0, 0).")
    return ConnectorError(f"{code} plane: {message}", findings=[finding])
