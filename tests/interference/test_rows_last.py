"""Fast forms of small sums give the same numbers as NumPy's cross products, norms and reductions, to the last bit."""

from __future__ import annotations

import numpy as np
import pytest

from articad.certificates.clearing import shortest_between
from articad.certificates.rows_last import cross, length, lengths, over_three, rows_last
from articad.certificates.spread import Spread
from articad.certificates.trail import OF_A, OF_B, Trail
from tests.interference.test_slides import mixed


@pytest.mark.parametrize("shape", [(500, 3), (100, 5, 3), (50, 4, 3, 3)])
def test_small_sums_are_those_of_numpy(shape: tuple[int, ...]) -> None:
    rng = np.random.default_rng(1)
    a, b = (rng.normal(size=shape) * 10.0 ** rng.integers(-4, 4, size=shape) for _ in range(2))
    product = np.cross(a, b)
    found = cross(rows_last(a), rows_last(b))
    assert all(np.array_equal(one.T, product[..., k]) for k, one in enumerate(found))
    assert np.array_equal(lengths(a), np.linalg.norm(a, axis=-1))
    assert np.array_equal(length(rows_last(a)).T, np.linalg.norm(a, axis=-1))
    for ufunc in (np.add, np.minimum, np.maximum):
        assert np.array_equal(over_three(ufunc, a), ufunc.reduce(a, axis=-1))


def test_bounds_of_several_points_are_those_of_each_alone() -> None:
    rng = np.random.default_rng(2)
    spread = Spread(mixed(rng))
    spread.add(rng.uniform(-1, 1, (6, len(spread.chain.freedoms))), rng.uniform(0, 0.3, (6, len(spread.factors))))
    box, size = rng.integers(6, size=40), rng.uniform(0, 2, 40)
    u, points = rng.normal(size=(40, 5, 3)), rng.normal(size=(40, 3, 3)) * 20
    first, second = spread.first_order(box, u, points, None), spread.second_order(box, u, points, size)
    for k in range(3):
        assert np.array_equal(first[:, :, k], spread.first_order(box, u, points[:, k], None))
        assert np.array_equal(second[:, :, k], spread.second_order(box, u, points[:, k], size))


def test_a_distance_does_not_depend_on_the_rows_beside_it() -> None:
    rng = np.random.default_rng(3)
    p, q = (rng.normal(size=(60, 3, 3)) * 5 for _ in range(2))
    for flat in (False, True):
        gaps, ways = shortest_between(p, q, flat=flat)
        for k in range(60):
            gap, way = shortest_between(p[k : k + 1], q[k : k + 1], flat=flat)
            assert (gap[0], *way[0]) == (gaps[k], *ways[k])


def test_directions_of_a_trail_are_written_once_and_in_order() -> None:
    rng = np.random.default_rng(4)
    trail, told = Trail(), np.empty((90, 4))
    rows = rng.permutation(trail.begin(90))
    for some, kind in ((rows[:50], OF_A), (rows[50:], OF_B)):
        along = rng.choice([-1.0, -0.5, -0.0, 0.0, 0.5], size=(len(some), 3))
        trail.settle(some, kind, along)
        told[some] = np.column_stack([np.full(len(some), kind), along + 0.0])
    unique, where = np.unique(told, axis=0, return_inverse=True)
    written = trail.written()
    assert written.along.tobytes() == unique[:, 1:].tobytes()
    assert written.codes.tolist() == where.ravel().tolist()
    assert written.of_a == int((unique[:, 0] == OF_A).sum())
