"""Gears that are drawn with their teeth mesh all the way round."""

from __future__ import annotations

import math
from dataclasses import replace

import manifold3d as m3
import numpy as np
import pytest

from articad.geometry import Part
from articad.kinematics.joints import JointType
from articad_bench.gear_checks import lean
from articad_bench.subject import Subject
from tests.bench.test_cheats import solid
from tests.bench.test_checks import form, product
from tests.interference.mechanisms import manifold_mesh

pytestmark = pytest.mark.slow


@pytest.mark.parametrize(("left", "meshes"), [((80, 80), True), ((80, 12), False), ((12, 80), False)])
def test_a_wheel_with_teeth_in_some_places_does_not_mesh(left: tuple[float, float], meshes: bool) -> None:
    """Of 36 teeth those in a strip across the wheel are left."""
    gears = product("gears_18_36")
    mesh = gears.parts["large"].mesh
    assert mesh is not None
    whole = solid(mesh)
    teeth = whole ^ m3.Manifold.cube([*left, 80], center=True)
    cut = Part.from_mesh("large", manifold_mesh(teeth + (whole ^ m3.Manifold.cylinder(99, 33.5, 33.5, 96, center=True))))
    subject = Subject(replace(gears, parts={**gears.parts, "large": replace(gears.parts["large"], solid=cut.solid)}))

    assert form({"kind": "meshes", "teeth": [18, 36]}).judge(subject).ok is meshes


@pytest.mark.parametrize("teeth", [(18, 36), (36, 18), (12, 24), (9, 18), (36, 72)])
def test_wheels_of_the_same_ratio_and_other_numbers_of_teeth_are_told_apart(teeth: tuple[int, int]) -> None:
    check = form({"kind": "meshes", "teeth": teeth})

    assert check.judge(Subject(product("gears_18_36"))).ok is (sorted(teeth) == [18, 36])


@pytest.mark.parametrize("wheel", ["small", "large"])
@pytest.mark.parametrize("share", [0.0, 0.1, 0.3])
def test_wheels_whose_teeth_lean_are_no_spur_gears(wheel: str, share: float) -> None:
    """Each point of a wheel turns by this share of the pitch from the circle of the roots to that of the tips."""
    gears = product("gears_18_36")
    teeth = {"small": 18, "large": 36}[wheel]
    mesh = gears.parts[wheel].mesh
    assert mesh is not None
    x, y, z = mesh.vertices.T
    radius = np.hypot(x, y)
    angle = np.arctan2(y, x) + share * math.tau / teeth * np.clip((radius - (teeth - 2.5)) / 4.5, 0, 1)
    bent = Part.from_mesh(wheel, replace(mesh, vertices=np.stack([radius * np.cos(angle), radius * np.sin(angle), z], axis=1)))
    subject = Subject(replace(gears, parts={**gears.parts, wheel: replace(gears.parts[wheel], solid=bent.solid)}))
    joint = next(one for one in gears.joints if wheel in {one.parent, one.child} and one.type is JointType.REVOLUTE)

    assert lean(subject, joint, teeth) == pytest.approx(share / 4.5 * 2, abs=0.02)  # a module of 2 between the outer two of three circles
    assert form({"kind": "meshes", "teeth": [18, 36]}).judge(subject).ok is (share == 0)
