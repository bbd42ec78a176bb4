"""Factors of Jacobians: the same as NumPy's, in one thread of BLAS where they are large."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from threadpoolctl import ThreadpoolController, threadpool_limits

from articad.kinematics import factors
from tests.fuzz.readers import CORPUS, attempt


@pytest.fixture
def threads(monkeypatch: pytest.MonkeyPatch) -> list[tuple[str, int, int]]:
    """Which factor NumPy was asked for, how many threads BLAS might use for it, and how large its matrix was."""
    if not ThreadpoolController().select(user_api="blas").info():
        pytest.skip("The number of threads of this NumPy's BLAS cannot be set")  # as on macOS
    found: list[tuple[str, int, int]] = []
    for name in ("svd", "lstsq", "solve"):
        asked = getattr(np.linalg, name)

        def seen(*arguments: Any, name: str = name, asked: Any = asked, **options: Any) -> Any:
            number = max(pool["num_threads"] for pool in ThreadpoolController().select(user_api="blas").info())
            found.append((name, number, arguments[0].size))
            return asked(*arguments, **options)

        monkeypatch.setattr(np.linalg, name, seen)
    return found


def test_large_factors_take_one_thread_and_leave_the_others_to_the_caller(threads: list[tuple[str, int, int]]) -> None:
    rng = np.random.default_rng(3)
    large, small = rng.normal(size=(240, 30)), rng.normal(size=(6, 4))
    with threadpool_limits(2, user_api="blas"):
        for A in (large, small):
            factors.svd(A)
            factors.singular_values(A)
            factors.right_singular(A)
            factors.least_squares(A, A[:, 0], 1e-10)
    assert [number for _, number, _ in threads] == [1] * 4 + [2] * 4


@pytest.mark.parametrize("file", ["many_loops.xml", "loops_that_do_not_close.xml"])
def test_twenty_loops_are_closed_in_one_thread(file: str, threads: list[tuple[str, int, int]]) -> None:
    """Files of 2.7 kB, found by fuzzing, took half a minute on a machine with other work, and a tenth of a second alone."""
    with threadpool_limits(2, user_api="blas"):
        attempt("mjcf", (CORPUS / "mjcf" / file).read_bytes())
    assert "svd" in {name for name, _, _ in threads}
    assert {number for _, number, size in threads if size > factors._SHARED} <= {1}  # loops apart are small, whatever their number


@pytest.mark.parametrize("shape", [(240, 30), (6, 4), (4, 6), (3, 3), (30, 240)])
def test_right_singular_vectors_span_the_null_space_last(shape: tuple[int, int]) -> None:
    rng = np.random.default_rng(4)
    rank = min(shape) - 1
    A = rng.normal(size=(shape[0], rank)) @ rng.normal(size=(rank, shape[1]))
    s, Vt = factors.right_singular(A)
    assert Vt @ Vt.T == pytest.approx(np.eye(shape[1]), abs=1e-12)
    assert np.abs(A @ Vt[rank:].T).max() < 1e-11 * s[0]
    assert s[:rank].min() > 1e-6 * s[0]
