"""Equations of linkages whose constraints have a multiple root, extended so that the root becomes simple.

On some sets of closed configurations the rank of the constraints' Jacobian J is everywhere smaller than the dimension of the set implies
(a platform on eight parallel rods). Newton's method then converges only linearly, and the smallest singular value says nothing about
other branches. That J keeps its low rank is an equation itself: with the left and right null vectors U₂ and N of J,

    S(q) = U₂ᵀ J(q) N = 0,    dS = U₂ᵀ dJ N,

is the Schur complement of the part of full rank. Loops and S together have a simple root where one such step is enough (deflation:
Leykin, Verschelde, Zhao 2006; isosingular sets: Hauenstein, Wampler 2013). S depends on the choice of U₂ and N, but |S| and the
Gauss-Newton steps do not, so each configuration has its own null vectors.
"""

from __future__ import annotations

import numpy as np

from articad.arrays import FloatArray
from articad.kinematics.factors import singular_values, svd
from articad.kinematics.loops import ClosureSystem
from articad.kinematics.mobility import Mobility

_SIMPLE = 1e-4  # σ/σ₁ of an equation that counts, at a simple root
_WEIGHT = 10.0  # weight of S: second derivatives of loops are about a tenth of the first ones; the solutions do not depend on it
_DIFFERENCE = 1e-5  # rad, or lengths L: step of the central differences of J, with an error of 1e-11


def regularized(system: ClosureSystem, analysis: Mobility) -> ClosureSystem | None:
    """Return equations with a simple root at the point of the analysis: the system itself, or a deflated one.

    Args:
        system: The equations.
        analysis: Their mobility.

    Returns:
        None if one deflation does not make the root simple.
    """
    if not analysis.multiple:
        return system
    size = system.ties.basis(system.active).size
    deflated = DeflatedSystem(system, size - analysis.mobility - analysis.multiple)
    closed = deflated.close(analysis.Q, system.active)
    if not closed.ok:
        return None
    s = singular_values(deflated.ties.basis(system.active).of(deflated.evaluate_one(closed.Q)[1]))
    return deflated if int((s > _SIMPLE * s[0]).sum()) == size - analysis.mobility else None


class DeflatedSystem(ClosureSystem):
    """Equations of loops and couplings; between both, the equations that keep the rank of the loops' Jacobian.

    Args:
        plain: The equations themselves.
        rank: Rank of the loops' Jacobian in the independent motions of all active freedoms, on the whole set of closed configurations.
    """

    smooth_rows = False  # its rows turn with the null vectors

    def __init__(self, plain: ClosureSystem, rank: int) -> None:
        self.__dict__.update(plain.__dict__)
        self._one = None  # S needs batches, also for one configuration
        self._plain, self._rank = plain, rank
        self._motions = self.ties.basis(self.active)
        self._held = (plain.n_loop_rows - rank) * (self._motions.size - rank)  # equations that keep the rank
        self.n_loop_rows = plain.n_loop_rows + self._held
        self.n_rows = plain.n_rows + self._held

    def evaluate(self, Q: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return residuals `(batch, rows)` and their Jacobian `(batch, rows, freedoms)`, scaled, at `Q` `(batch, columns)`."""
        r, J = self._plain.evaluate(Q)
        U2, N, S = self._null_vectors(J)
        batch, n = N.shape[:2]
        # dS along y is U₂ᵀ (dJ along y) N; second derivatives commute except for terms that vanish with S, so this is U₂ᵀ (dJ along N) y
        ends = self.move(Q[:, None, None], _DIFFERENCE * np.stack([N, -N], axis=2))
        loops = self._plain.n_loop_rows
        J_ends = self._plain.evaluate(ends.reshape(2 * batch * n, Q.shape[1]))[1][:, :loops].reshape(batch, n, 2, loops, J.shape[2])
        dJ = (J_ends[:, :, 0] - J_ends[:, :, 1]) / (2 * _DIFFERENCE)
        dS = _WEIGHT * (U2.swapaxes(-1, -2)[:, None] @ dJ).swapaxes(1, 2).reshape(batch, self._held, J.shape[2])
        return self._joined(r, S), np.concatenate([J[:, :loops], dS, J[:, loops:]], axis=1)

    def residual(self, Q: FloatArray) -> FloatArray:
        """Return the residuals alone `(batch, rows)`."""
        r, J = self._plain.evaluate(Q)
        return self._joined(r, self._null_vectors(J)[2])

    def _joined(self, r: FloatArray, S: FloatArray) -> FloatArray:
        loops = self._plain.n_loop_rows
        return np.concatenate([r[:, :loops], S, r[:, loops:]], axis=1)

    def _null_vectors(self, J: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return U₂ `(batch, rows, left)`, N `(batch, right, freedoms)` and S `(batch, left · right)`."""
        A, k = self._motions.of(J[:, : self._plain.n_loop_rows]), self._rank
        U, s, Vt = svd(A, full=True)
        U2, V2 = U[:, :, k:], Vt[:, k:]
        S = np.zeros((len(J), U2.shape[2], V2.shape[1]))
        i = np.arange(s.shape[1] - k)
        S[:, i, i] = _WEIGHT * s[:, k:]
        return U2, self._motions.step(V2), S.reshape(len(J), self._held)
