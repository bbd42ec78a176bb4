"""Mass properties and their algebra: moved, mirrored, combined."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from articad.arrays import FloatArray
from articad.connectors.se3 import SE3
from articad.errors import InvalidSolidError

M3_PER_MM3 = 1e-9
SYMMETRY_TOLERANCE = 1e-9  # relative; an inertia computed in floating point is symmetric up to the last bits
TRIANGLE_TOLERANCE = 1e-9  # relative; a flat plate satisfies Ixx + Iyy = Izz exactly


@dataclass(frozen=True, eq=False)
class MassProperties:
    """Mass, its centre, and the inertia about that centre, all in one frame.

    Attributes:
        mass: [kg].
        com: Centre of mass [mm], `(3,)`.
        inertia: About the centre of mass, along the frame's axes [kg·mm²], `(3, 3)`.

    Raises:
        InvalidSolidError: If the mass is negative, a number is not finite or the inertia is not symmetric.
    """

    mass: float
    com: FloatArray
    inertia: FloatArray

    def __post_init__(self) -> None:
        com = np.array(self.com, dtype=np.float64)
        inertia = np.array(self.inertia, dtype=np.float64)
        mass = float(self.mass)
        if com.shape != (3,) or inertia.shape != (3, 3):
            raise InvalidSolidError(
                f"Mass properties need a centre (3,) and an inertia (3, 3), not {com.shape} and {inertia.shape}.", status="shape"
            )
        if not (np.isfinite(mass) and np.isfinite(com).all() and np.isfinite(inertia).all()):
            raise InvalidSolidError("Mass properties are not finite.", status="nonfinite")
        if mass < 0:
            raise InvalidSolidError(
                f"A mass must not be negative, but this one is {mass:.6g} kg; check whether the mesh is inside out.", status="negative"
            )
        if np.abs(inertia - inertia.T).max() > SYMMETRY_TOLERANCE * max(np.abs(inertia).max(), np.finfo(float).tiny):
            raise InvalidSolidError("An inertia must be symmetric.", status="asymmetric")
        inertia = (inertia + inertia.T) / 2
        for array in (com, inertia):
            array.flags.writeable = False
        object.__setattr__(self, "mass", mass)
        object.__setattr__(self, "com", com)
        object.__setattr__(self, "inertia", inertia)

    @classmethod
    def from_solid(cls, volume: float, com: ArrayLike, inertia_mm5: ArrayLike, density: float) -> Self:
        """Return the mass of a homogeneous solid.

        Args:
            volume: [mm³].
            com: Centre of the volume [mm], `(3,)`.
            inertia_mm5: Inertia about the centre at density one [mm⁵], `(3, 3)`.
            density: [kg/m³].
        """
        per_mm3 = density * M3_PER_MM3
        return cls(volume * per_mm3, np.asarray(com, dtype=np.float64), np.asarray(inertia_mm5, dtype=np.float64) * per_mm3)

    @classmethod
    def none(cls) -> Self:
        """Return a mass of zero at the origin."""
        return cls(0.0, np.zeros(3), np.zeros((3, 3)))

    @classmethod
    def combined(cls, several: Iterable[MassProperties]) -> Self:
        """Return the combined mass of several bodies, all given in one frame. Without any: zero mass, at the origin."""
        bodies = list(several)
        mass = sum(body.mass for body in bodies)
        if mass == 0:
            com = np.mean([body.com for body in bodies], axis=0) if bodies else np.zeros(3)
        else:
            # about the first centre, so that bodies far from the origin lose no digits
            base = bodies[0].com
            com = base + sum((body.mass * (body.com - base) for body in bodies), np.zeros(3)) / mass
        return cls(mass, com, sum((body.inertia_about(com) for body in bodies), np.zeros((3, 3))))

    def inertia_about(self, point: ArrayLike) -> FloatArray:
        """Return the inertia about another point [kg·mm²], `(3, 3)` (Steiner)."""
        arm = self.com - np.asarray(point, dtype=np.float64)
        return self.inertia + self.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))

    def moved(self, T: SE3) -> MassProperties:
        """Return the same body in the frame into which `T` maps."""
        R = T.rotation
        return MassProperties(self.mass, R @ self.com + T.translation, R @ self.inertia @ R.T)

    def mirrored(self, S: ArrayLike) -> MassProperties:
        """Return the mirror image under a reflection: the centre is mapped, the inertia becomes S I S.

        Args:
            S: A reflection `(4, 4)`, its last column in mm.

        Raises:
            InvalidSolidError: If it is not a reflection.
        """
        matrix = np.asarray(S, dtype=np.float64)
        Q = matrix[:3, :3]
        if matrix.shape != (4, 4) or np.abs(Q @ Q.T - np.eye(3)).max() > SYMMETRY_TOLERANCE or not np.linalg.det(Q) < 0:
            raise InvalidSolidError("A mirror image needs a (4, 4) matrix whose linear part is a reflection.", status="matrix")
        return MassProperties(self.mass, Q @ self.com + matrix[:3, 3], Q @ self.inertia @ Q.T)

    def scaled(self, factor: float) -> MassProperties:
        """Return a body of the same shape with `factor` times the mass."""
        return MassProperties(self.mass * factor, self.com, self.inertia * factor)

    @property
    def principal_moments(self) -> FloatArray:
        """Eigenvalues of the inertia, ascending [kg·mm²], `(3,)`."""
        return np.asarray(np.linalg.eigvalsh(self.inertia), dtype=np.float64)

    @property
    def is_physical(self) -> bool:
        """True if some body could have this inertia: positive, and no principal moment above the sum of the others."""
        small, middle, large = self.principal_moments
        return bool(self.mass > 0 and small > 0 and large <= (small + middle) * (1 + TRIANGLE_TOLERANCE))

    def __repr__(self) -> str:
        return f"MassProperties({self.mass:.6g} kg, com {self.com.tolist()} mm)"
