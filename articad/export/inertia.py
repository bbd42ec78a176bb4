"""Inertia in SI units, and how carrier links get some of it without changing the total.

The pseudo-inertia of a body, `[[Σ, h], [hᵀ, m]]` with second moments Σ, first moments h and mass m about one frame, adds up when bodies
are joined, and a body is physical exactly if it is positive (Wensing, Kim, Slotine 2018). A carrier is a small ball at the joint's
origin; removing it from the moved body is a subtraction of pseudo-inertias, so mass, centre and inertia of both together stay the same.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from articad.arrays import FloatArray
from articad.connectors.se3 import SE3
from articad.export.markup import rounded, tidy
from articad.geometry.mass import TRIANGLE_TOLERANCE, MassProperties

CARRIER_MASS_KG = 1e-4  # small compared with any part, but far above the minimum of simulators (1e-15)
CARRIER_INERTIA_KG_M2 = 1e-7  # of a ball of 50 mm radius and the carrier's mass: this keeps mass matrices well conditioned
CARRIER_SHARE = 0.05  # largest share of the body's pseudo-inertia that carriers take in any direction, so that it stays physical
MM_PER_M = 1000.0
LEAST_MOMENT_KG_M2 = 2e-14  # simulators reject a smaller principal moment: MuJoCo refuses 1e-14
LEAST_SHARE = 4e-9  # of the sum of second moments, in each direction of a written body: rods and plates have none in theory
DIGITS = 10  # of the largest moment of inertia: further ones depend on the processor, and would turn the axes of nearly equal moments
DUST_SHARE = 1e-13  # of a product of inertia: a smaller difference of the two moments is rounding noise
_JACOBI_SWEEPS = 8  # Jacobi's method converges quadratically: 3 by 3 matrices need at most 5
LEAST_RADIUS_M = 1e-3  # radius of gyration of a body along a direction in which its inertia gives a negative second moment


@dataclass(frozen=True, eq=False)
class Inertial:
    """Mass properties of a link.

    Attributes:
        mass: [kg].
        com: Centre of mass in the link's frame [m], `(3,)`.
        inertia: About the centre of mass, along the link's axes [kg·m²], `(3, 3)`.
    """

    mass: float
    com: FloatArray
    inertia: FloatArray

    @classmethod
    def from_part(cls, mass: MassProperties, T_link_part: SE3) -> Inertial:
        """Return a part's mass properties in its link's frame; `T_link_part` [mm]."""
        moved = mass.moved(T_link_part)
        return cls(moved.mass, moved.com / MM_PER_M, moved.inertia / MM_PER_M**2)

    @classmethod
    def carrier(cls, scale: float = 1.0) -> Inertial:
        """Return a carrier's mass properties: a ball at the frame's origin."""
        return cls(CARRIER_MASS_KG * scale, np.zeros(3), CARRIER_INERTIA_KG_M2 * scale * np.eye(3))

    def possible(self) -> Inertial:
        """Return the nearest physical body: none of its second moments is below that of a ball of 1 mm."""
        if is_possible(self.mass, self.inertia):
            return self
        moments, axes = np.linalg.eigh(np.trace(self.inertia) / 2 * np.eye(3) - self.inertia)
        least = max(self.mass * LEAST_RADIUS_M**2, LEAST_MOMENT_KG_M2)
        about_com = (axes * np.maximum(moments, least)) @ axes.T
        inertia = np.trace(about_com) * np.eye(3) - about_com
        return Inertial(self.mass, self.com, (inertia + inertia.T) / 2)

    def inside_bounds(self) -> Inertial:
        """Return this body, thickened if it is a rod or a plate, so that rounding cannot violate A + B >= C.

        The second moment in a direction is half of A + B − C; readers compute the principal moments A, B, C from the printed numbers
        with `DIGITS` digits, and MuJoCo refuses A + B < C. Rounding changes each entry by 0.5e-9 of the largest at most, so A, B, C by
        1.5e-9 (the Frobenius norm of nine such changes) and A + B − C by 4.5e-9 of it. The sum of second moments is at least the largest
        entry, so A + B − C is 8e-9 of that after second moments below `LEAST_SHARE` of their sum are raised to it. No principal moment
        changes by more than 8e-9 of the largest.
        """
        moments, axes = np.linalg.eigh(np.trace(self.inertia) / 2 * np.eye(3) - self.inertia)
        least = max(LEAST_SHARE * float(moments.sum()), LEAST_MOMENT_KG_M2)
        if moments[0] >= least:
            return self
        about_com = (axes * np.maximum(moments, least)) @ axes.T
        inertia = np.trace(about_com) * np.eye(3) - about_com
        return Inertial(self.mass, self.com, (inertia + inertia.T) / 2)

    def without_dust(self) -> Inertial:
        """Return this body without rounding noise in its centre of mass and its inertia, so that it is the same on every processor.

        Noise of the centre is proportional to the radius of gyration. The inertia has `DIGITS` digits of its largest moment.
        """
        largest = float(np.abs(self.inertia).max())
        com = rounded(tidy(self.com, math.sqrt(largest / self.mass) if self.mass > 0 else 0.0))
        if not 0.0 < largest < math.inf:
            return replace(self, com=np.array(com))
        places = DIGITS - 1 - math.floor(math.log10(largest))
        inertia = [[round(value, places) + 0.0 for value in row] for row in self.inertia.tolist()]
        return Inertial(self.mass, np.array(com), np.array(inertia))

    def principal(self) -> tuple[FloatArray, FloatArray]:
        """Return the principal moments [kg·m²], `(3,)`, and the principal axes as columns of a rotation, `(3, 3)`.

        Jacobi's method (Golub, Van Loan: Matrix Computations, 8.5): each rotation by at most 45° removes one product of inertia. Unlike a
        general solver, it leaves the axes of a diagonal matrix as they are, and turns no further than needed where moments are equal.
        """
        A, R = np.array(self.inertia, dtype=np.float64), np.eye(3)
        noise = 1e-17 * float(np.abs(A).max())
        for _ in range(_JACOBI_SWEEPS):
            for p, q in ((0, 1), (0, 2), (1, 2)):
                if abs(A[p, q]) <= noise:
                    continue
                # tan 2θ = 2 A_pq / (A_qq − A_pp); the smaller root t = tan θ of t² + 2τt − 1 = 0
                tau = (A[q, q] - A[p, p]) / (2 * A[p, q])
                if abs(tau) < DUST_SHARE:
                    tau = 0.0
                t = (1.0 if tau >= 0 else -1.0) / (abs(tau) + math.sqrt(tau * tau + 1.0))
                c = 1 / math.sqrt(t * t + 1.0)
                # J.T @ A @ J and R @ J column by column: a product of matrices rounds as the processor's library does
                for M in (A, R):
                    M[:, p], M[:, q] = c * M[:, p] - t * c * M[:, q], t * c * M[:, p] + c * M[:, q]
                A[p], A[q] = c * A[p] - t * c * A[q], t * c * A[p] + c * A[q]
        return np.diag(A).copy(), R

    @property
    def pseudo(self) -> FloatArray:
        """The pseudo-inertia `(4, 4)` about the link's origin [kg·m², kg·m, kg]."""
        P = np.empty((4, 4))
        about_com = np.trace(self.inertia) / 2 * np.eye(3) - self.inertia
        P[:3, :3] = about_com + self.mass * np.outer(self.com, self.com)
        P[:3, 3] = P[3, :3] = self.mass * self.com
        P[3, 3] = self.mass
        return P

    @classmethod
    def from_pseudo(cls, P: FloatArray) -> Inertial:
        """Return the mass properties for a pseudo-inertia."""
        mass = float(P[3, 3])
        com = P[:3, 3] / mass
        about_com = P[:3, :3] - mass * np.outer(com, com)
        return cls(mass, com, np.trace(about_com) * np.eye(3) - about_com)

    def without_carriers(self, count: int, origin: FloatArray | None = None) -> tuple[Inertial, Inertial]:
        """Remove carriers from this body.

        Args:
            count: Number of carriers, all at one point.
            origin: That point in the link's frame [m]; the link's origin by default.

        Returns:
            The rest of the body, and one carrier about its own origin. Carriers of a very light or thin body are scaled down.
        """
        if count == 0:
            return self, Inertial.carrier()
        whole = Inertial.carrier()
        one = Inertial(whole.mass, np.zeros(3) if origin is None else np.asarray(origin, dtype=np.float64), whole.inertia).pseudo
        whitened = np.linalg.inv(np.linalg.cholesky(_positive(self.pseudo)))
        largest = float(np.linalg.eigvalsh(whitened @ (count * one) @ whitened.T)[-1])
        scale = min(1.0, float(f"{CARRIER_SHARE / largest:.9g}"))  # further digits depend on the processor
        return Inertial.from_pseudo(self.pseudo - scale * count * one), Inertial.carrier(scale)

    def halved(self, T_link_frame: SE3) -> tuple[Inertial, Inertial]:
        """Return half of this body, and the other half as seen from another frame of its link [m]."""
        R = T_link_frame.rotation
        half = Inertial(self.mass / 2, self.com, self.inertia / 2)
        return half, Inertial(self.mass / 2, T_link_frame.inverse().apply(self.com), R.T @ half.inertia @ R)


def is_possible(mass: float, inertia: FloatArray) -> bool:
    """True if some body that simulators accept has this inertia about its centre of mass [kg, kg·m²]."""
    small, middle, large = np.linalg.eigvalsh(inertia)
    return bool(mass > 0 and small >= LEAST_MOMENT_KG_M2 and large <= (small + middle) * (1 + TRIANGLE_TOLERANCE))


def _positive(P: FloatArray) -> FloatArray:
    """Thicken a body that is a plane, a line or a point by a negligible share of its size, so that it can be inverted."""
    thickness = 1e-9 * (np.trace(P[:3, :3]) + P[3, 3] * 1e-12)
    return P + np.diag([thickness, thickness, thickness, 0.0])
