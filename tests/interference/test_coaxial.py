"""Parts that turn about one axis: what outlines show of them is never other than what a boolean finds."""

from __future__ import annotations

import math

import numpy as np
import pytest

from articad.connectors import SE3
from articad.geometry import TriMesh, box, cylinder, merged
from articad.interference import check as check_module
from articad.interference import coaxial as coaxial_module
from articad.interference.check import Scene, check_scene
from articad.interference.coaxial import Coaxial
from articad.interference.overlap import volume
from tests.interference.mechanisms import at, block_with_bore, joint, random_rotation

IDENTITY = SE3.identity()
ANGLES = np.linspace(0, 2 * math.pi, 13)


@pytest.fixture(autouse=True)
def _at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(coaxial_module, "_WORTH_OUTLINES", 1)


def hinged(a: TriMesh, b: TriMesh, C_a: SE3 = IDENTITY, C_b: SE3 = IDENTITY, kind: str = "revolute") -> Scene:
    return Scene.of({"a": a, "b": b}, [joint("j", kind, "a", "b", at_parent=C_a, at_child=C_b)])


def apart(scene: Scene, T: SE3) -> bool:
    return Coaxial.of(scene).apart(scene, "a", "b", T.matrix[:3])


def test_a_pin_in_its_bore_needs_no_boolean_however_it_is_turned(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = hinged(block_with_bore(40, 10, 5.2, 48), merged([cylinder(5.0, 20, 48), cylinder(9.0, 4, 48).transformed(at(0, 0, 12))]))
    monkeypatch.setattr(check_module, "measured", None)
    for angle in ANGLES:
        report = check_scene(scene, {"a": IDENTITY, "b": SE3.rot_z(angle)})
        assert report.ok
        assert report.pairs[0].verdict == "clear"


def test_it_is_asked_only_from_the_time_when_it_pays(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(coaxial_module, "_WORTH_OUTLINES", 3)
    scene = hinged(block_with_bore(40, 10, 5.2, 48), cylinder(5.0, 20, 48))
    assert [apart(scene, SE3.rot_z(angle)) for angle in ANGLES[:4]] == [False, False, True, True]


def test_what_is_inside_without_touching_is_not_apart() -> None:
    scene = hinged(cylinder(20, 40, 48), cylinder(5, 10, 48))
    assert not any(apart(scene, SE3.rot_z(angle)) for angle in ANGLES)
    assert not check_scene(scene, {"a": IDENTITY, "b": SE3.rot_z(0.3)}).ok


def test_a_pin_as_wide_as_its_bore_is_not_told_apart_by_its_outline() -> None:
    for radius in (5.2, 5.2 * math.cos(math.pi / 48), 5.3):
        scene = hinged(block_with_bore(40, 10, 5.2, 48), cylinder(radius, 20, 48))
        assert not any(apart(scene, SE3.rot_z(angle)) for angle in ANGLES)


def test_an_axis_that_is_off_says_nothing() -> None:
    scene = hinged(block_with_bore(40, 10, 5.2, 48), cylinder(5.0, 20, 48))
    assert apart(scene, at(0, 0, 1) @ SE3.rot_z(1.0))
    assert not apart(scene, at(1e-4, 0, 0))
    assert not apart(scene, SE3.rot_x(1e-5))


def test_arms_that_miss_or_meet_each_other_are_told_by_where_they_are() -> None:
    arm = box(40, 4, 4).transformed(at(22, 0, 0))
    scene = hinged(arm, arm.transformed(at(0, 0, 1)))
    told = [apart(scene, SE3.rot_z(angle)) for angle in ANGLES]
    assert not told[0]
    assert told[6]


@pytest.mark.parametrize("kind", ["revolute", "cylindrical"])
def test_nothing_that_is_called_apart_has_anything_in_common(kind: str) -> None:
    rng = np.random.default_rng(11)
    told = meeting = 0
    for _ in range(60):
        shapes = [
            box(*rng.uniform(2, 20, 3)),
            merged([box(*rng.uniform(2, 12, 3)), cylinder(3, 8, 12).transformed(at(*rng.uniform(12, 20, 3)))]),
        ]
        C_a, C_b = (at(*rng.uniform(-12, 12, 3)) @ random_rotation(rng) for _ in range(2))
        scene = hinged(shapes[0], shapes[1], C_a, C_b, kind)
        for angle in rng.uniform(0, 2 * math.pi, 4):
            flip = SE3.rot_x(math.pi) if rng.random() < 0.5 else IDENTITY
            T = C_a @ at(0, 0, float(rng.uniform(-5, 5))) @ SE3.rot_z(float(angle)) @ flip @ C_b.inverse()
            common = volume(scene.bodies["a"], scene.bodies["b"], T.matrix[:3])
            if apart(scene, T):
                told += 1
                assert common < 1e-12
            meeting += common > 1e-9
    assert told > 30
    assert meeting > 30
