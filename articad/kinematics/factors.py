"""Factors of the constraints' Jacobians, computed in one thread of BLAS.

BLAS spreads large inputs over threads that busy-wait. When other programs use the processors, that takes a hundred times as long as one
thread alone, and a Jacobian of twenty loops is already large.
"""

from __future__ import annotations

from contextlib import AbstractContextManager, nullcontext
from functools import cache
from typing import Any

import numpy as np

from articad.arrays import FloatArray

_SHARED = 2000  # entries of a matrix; BLAS begins to use threads at four times as many


def svd(A: FloatArray, *, full: bool = False) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return U, σ and Vᵗ of a matrix `(m, n)`: min(m, n) vectors of each, or with `full` all `(m, m)` and `(n, n)`."""
    with one_thread(A.size):
        U, s, Vt = np.linalg.svd(A, full_matrices=full)
    return U, s, Vt


def singular_values(A: FloatArray) -> FloatArray:
    """Return σ of a matrix."""
    with one_thread(A.size):
        return np.asarray(np.linalg.svd(A, compute_uv=False), dtype=float)


def right_singular(A: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return σ of a matrix `(m, n)` and all its right singular vectors `(n, n)`: those of its null space are the last rows.

    Loops have far more rows than freedoms; computing the unused left vectors `(m, m)` would take most of the time.
    """
    _, s, Vt = svd(A, full=A.shape[0] < A.shape[1])
    return s, Vt


def least_squares(A: FloatArray, b: FloatArray, dropped: float) -> FloatArray:
    """Return the shortest x that minimises |A x - b|; singular values below a share of the largest count as zero."""
    with one_thread(A.size):
        return np.asarray(np.linalg.lstsq(A, b, rcond=dropped)[0], dtype=float)


def one_thread(entries: int) -> AbstractContextManager[Any]:
    """Limit BLAS to one thread for matrices with this many entries; small ones use one anyway."""
    return _pools().limit(limits=1, user_api="blas") if entries > _SHARED else nullcontext()


@cache
def _pools() -> Any:
    from threadpoolctl import ThreadpoolController  # noqa: PLC0415 - few mechanisms are so large

    return ThreadpoolController()
