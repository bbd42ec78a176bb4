"""Gaps of a surface: small ones are closed, openings are left."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from articad.export.convex import manifold
from articad.geometry.capping import capped, without_gaps
from articad.geometry.mesh import TriMesh
from articad.geometry.shapes import box, cylinder


def fine(mesh: TriMesh, times: int = 3) -> TriMesh:
    """A mesh with each triangle quartered a few times."""
    for _ in range(times):
        a, b, c = (mesh.vertices[mesh.triangles[:, i]] for i in range(3))
        ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
        corners = np.concatenate([np.stack(one, axis=1) for one in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
        mesh = TriMesh(corners.reshape(-1, 3), np.arange(3 * len(corners), dtype=np.int32).reshape(-1, 3)).welded()
    return mesh


def without(mesh: TriMesh, gone: NDArray[np.bool_]) -> TriMesh:
    return TriMesh(mesh.vertices, mesh.triangles[~gone])


@pytest.mark.parametrize("seed", range(6))
def test_a_flat_side_with_random_small_gaps_is_closed_as_it_was(seed: int) -> None:
    """Also gaps that share a corner, and triangles that no other touches."""
    whole = fine(box(30, 20, 10))
    rng = np.random.default_rng(seed)
    flat = np.flatnonzero(np.ptp(whole.vertices[whole.triangles][:, :, 2], axis=1) == 0)
    open_ = without(whole, np.isin(np.arange(len(whole.triangles)), rng.choice(flat, 6, replace=False)))

    closed = capped(open_)

    assert not open_.is_closed
    assert closed is not None
    assert closed.is_closed
    assert closed.volume == pytest.approx(whole.volume, rel=1e-12)
    assert manifold(closed).volume() == pytest.approx(whole.volume, rel=1e-9)


def test_loose_triangles_of_a_file_without_indices_are_joined_first() -> None:
    whole = fine(cylinder(10, 20), 1)
    loose = TriMesh(whole.vertices[whole.triangles].reshape(-1, 3), np.arange(3 * len(whole.triangles), dtype=np.int32).reshape(-1, 3))
    closed = without_gaps(without(loose, np.arange(len(loose.triangles)) == 7))

    assert closed.is_closed
    assert closed.volume == pytest.approx(whole.volume, rel=1e-2)


def test_an_opening_that_is_meant_is_left() -> None:
    """A box without its lid, and a single triangle."""
    whole = box(30, 20, 10)
    lid = (whole.vertices[whole.triangles][:, :, 2] == whole.bounds[1, 2]).all(axis=1)
    tray = without(whole, lid)

    assert capped(tray) is None
    assert without_gaps(tray) is tray
    assert capped(TriMesh(np.eye(3), np.array([[0, 1, 2]], dtype=np.int32))) is None
    assert without_gaps(whole) is whole
