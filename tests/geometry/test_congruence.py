"""Solids of one shape: any rotation and shift, but no mirror image, and nothing that differs by more than the mesh is off."""

from __future__ import annotations

import numpy as np
import pytest

from articad.connectors.se3 import SE3
from articad.geometry.congruence import same_shape
from articad.geometry.mesh import TriMesh, merged
from articad.geometry.part import Solid
from articad.geometry.shapes import box, cylinder

TURNED = SE3.trans(7.0, -3.0, 11.0) @ SE3.rot_x(0.7) @ SE3.rot_z(-1.9)
MIRROR = np.diag([-1.0, 1.0, 1.0, 1.0])


def tower(*blocks: tuple[float, float, float, float, float]) -> Solid:
    """Boxes that stand beside each other without contact: width, depth, height, and the place of the corner in x and y."""
    return Solid.from_mesh(merged([box(w, d, h).transformed(SE3.trans(x + w / 2, y + d / 2, h / 2)) for w, d, h, x, y in blocks]))


HANDED = tower((10, 20, 30, 0, 0), (5, 5, 50, 15, 0), (8, 3, 9, 0, 25))
SYMMETRIC = tower((10, 20, 30, 0, 0), (5, 5, 50, 15, 0), (5, 5, 50, 15, 15))


def moved(solid: Solid) -> Solid:
    return Solid.from_mesh(solid.mesh.transformed(TURNED))


def mirrored(solid: Solid) -> Solid:
    return Solid.from_mesh(solid.mesh.reflected(MIRROR))


@pytest.mark.parametrize("solid", [HANDED, SYMMETRIC, tower((7, 7, 7, 0, 0)), Solid.from_mesh(cylinder(15, 60))])
def test_a_moved_solid_has_the_same_shape(solid: Solid) -> None:
    assert same_shape(solid, moved(solid))
    assert same_shape(moved(solid), solid)


def test_a_mirror_image_has_the_same_shape_only_if_the_solid_is_symmetric() -> None:
    assert not same_shape(HANDED, moved(mirrored(HANDED)))
    assert same_shape(SYMMETRIC, moved(mirrored(SYMMETRIC)))


def test_equal_volume_and_area_are_not_one_shape() -> None:
    far = tower((10, 20, 30, 0, 0), (5, 5, 50, 25, 0), (8, 3, 9, 0, 25))
    assert HANDED.volume == pytest.approx(far.volume)
    assert HANDED.area == pytest.approx(far.area)
    assert not same_shape(HANDED, far)


def test_a_twentieth_of_a_millimetre_is_another_shape() -> None:
    assert not same_shape(tower((10, 20, 30, 0, 0)), tower((10.05, 20, 30, 0, 0)))


def test_faces_divided_into_other_triangles_do_not_matter() -> None:
    one = box(10, 20, 30)
    corners = one.triangles.copy()
    assert same_shape(Solid.from_mesh(one), Solid.from_mesh(TriMesh(one.vertices, np.roll(corners, 1, axis=1)[::-1])))
