"""One small assembly per root cause, and its clean twin: the planted defect is named with its number, the twin is silent."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass

import manifold3d as m3
import numpy as np
import pytest
from numpy.random import default_rng

from articad.arrays import FloatArray
from articad.connectors import SE3
from articad.findings import Findings
from articad.geometry import TriMesh, box, cylinder, merged
from articad.interference.check import check_scene
from articad.interference.diagnosis import diagnose
from articad.interference.scene import Scene
from articad.interference.sweep import MotionSampler
from articad.kinematics.joints import Joint
from articad.kinematics.mechanism import Mechanism
from tests.interference.mechanisms import at, block_with_bore, fixed, joint, manifold_mesh

ALONG_Y = SE3.from_axes([0.0, 0, 0], [0.0, 1, 0], [1.0, 0, 0])
OUT = SE3.from_axes([0.0, 0, 0], [0.0, -1, 0], [1.0, 0, 0])


@dataclass(frozen=True)
class Fixture:
    cause: str
    route: str
    number: float
    planted: dict[str, TriMesh]
    clean: dict[str, TriMesh]
    joints: Sequence[Joint]
    clean_joints: Sequence[Joint] = ()


def cabinet(depth: float) -> TriMesh:
    shell = m3.Manifold.cube([100, depth + 5, 50], center=True) - m3.Manifold.cube([90, depth + 5, 40], center=True).translate([0, -5, 0])
    return manifold_mesh(shell)


def fork(slot: float) -> TriMesh:
    block = m3.Manifold.cube([30, 20, 30], center=True).translate([-5, 0, 0])
    if slot:
        block -= m3.Manifold.cube([40, slot, 40], center=True)
        block += m3.Manifold.cube([4, 20, 30], center=True).translate([-28, 0, 0])
        block += m3.Manifold.cube([10, 20, 30], center=True).translate([-23, 0, 0])
    return manifold_mesh(block)


def paddle(x: float, y: float) -> TriMesh:
    return box(60, 4, 10).transformed(at(x, y))


TONGUE = merged([box(40, 6, 12, center=False).transformed(at(-6, -3, -6))])
FORK_HINGE = joint("hinge", "revolute", "fork", "tongue", at_parent=ALONG_Y, at_child=ALONG_Y, lower=(-0.5,), upper=(0.5,))
SLIDE = joint("slide", "slider", "cabinet", "drawer", at_parent=OUT, at_child=OUT, lower=(0.0,), upper=(40.0,))
SLIDE_TOO_FAR = joint("slide", "slider", "cabinet", "drawer", at_parent=OUT, at_child=OUT, lower=(-4.0,), upper=(40.0,))


def flap(x: float, y: float, lower: float, upper: float) -> Joint:
    return joint("flap", "revolute", "wall", "flap", at_parent=at(x, y), at_child=at(x, y), lower=(lower,), upper=(upper,))


def rods(pitch: float) -> list[Joint]:
    return [
        joint("one", "revolute", "table", "left", lower=(-1.6,), upper=(1.6,), rest=(math.pi / 2,)),
        joint("two", "revolute", "table", "right", at_parent=at(pitch), lower=(-1.6,), upper=(1.6,), rest=(math.pi / 2,)),
    ]


PANELS = {"wall": box(50, 10, 60, center=False).transformed(at(-50)), "flap": box(50, 10, 60, center=False)}
PINS = {"left": paddle(0, 0), "right": paddle(0, 0), "table": box(160, 10, 2).transformed(at(35, 0, -7))}
HALVES = [box(10, 10, 10), box(10, 10, 10).transformed(at(12))]

FIXTURES = [
    Fixture(
        "unbored_hole",
        "code",
        10.0,
        {"block": box(40, 40, 10), "pin": cylinder(5, 30, 64)},
        {"block": block_with_bore(40, 10, 5.2, 64), "pin": cylinder(5, 30, 64)},
        [joint("turn", "revolute", "block", "pin")],
    ),
    Fixture("missing_slot", "code", 6.0, {"fork": fork(0), "tongue": TONGUE}, {"fork": fork(6.4), "tongue": TONGUE}, [FORK_HINGE]),
    Fixture(
        "envelope",
        "design",
        92.0,
        {"cabinet": cabinet(90), "drawer": box(88, 92, 38).transformed(at(y=-1.5))},
        {"cabinet": cabinet(90), "drawer": box(88, 89, 38).transformed(at(y=-2.5))},
        [SLIDE],
    ),
    Fixture(
        "envelope",
        "design",
        -4.0,
        {"cabinet": cabinet(90), "drawer": box(88, 90, 38).transformed(at(y=-2.5))},
        {"cabinet": cabinet(90), "drawer": box(88, 90, 38).transformed(at(y=-2.5))},
        [SLIDE_TOO_FAR],
        [SLIDE],
    ),
    Fixture("pivot_on_face", "design", 0.0, PANELS, PANELS, [flap(0, 5, 0.0, 1.5)], [flap(0, 0, -1.5, 0.0)]),
    Fixture("pitch", "design", 50.0, PINS, PINS, rods(50.0), rods(70.0)),
    Fixture(
        "multi_solid",
        "code",
        2.0,
        {"base": box(40, 40, 4).transformed(at(z=-7)), "part": merged(HALVES)},
        {"base": box(40, 40, 4).transformed(at(z=-7)), "part": box(22, 10, 10).transformed(at(6))},
        [joint("lift", "slider", "base", "part", lower=(0.0,), upper=(5.0,))],
    ),
    Fixture(
        "not_touching",
        "code",
        3.0,
        {"base": box(40, 40, 4), "part": box(10, 10, 10).transformed(at(z=10))},
        {"base": box(40, 40, 4), "part": box(10, 10, 10).transformed(at(z=7))},
        [fixed("glue", "base", "part")],
    ),
    Fixture(
        "floating",
        "design",
        20.0,
        {"base": box(40, 40, 4), "part": box(10, 10, 10).transformed(at(z=27))},
        {"base": box(40, 40, 4), "part": box(10, 10, 10).transformed(at(z=7.5))},
        [joint("lift", "slider", "base", "part", lower=(0.0,), upper=(5.0,))],
    ),
]


def findings(meshes: dict[str, TriMesh], joints: Sequence[Joint]) -> Findings:
    ground = next(joint.parent for joint in joints)
    mechanism = Mechanism(tuple(meshes), ground, joints)
    scene = Scene.of(meshes, joints, deflection=0.01)
    sampler = MotionSampler(scene, mechanism)
    found = (
        check_scene(scene, mechanism.rest_poses(), ground=ground).findings + sampler.run(None, steps=36, together=True, samples=0).findings
    )
    return diagnose(scene, mechanism.tree, found)


@pytest.mark.parametrize("fixture", FIXTURES, ids=lambda fixture: fixture.cause)
def test_the_planted_defect_is_named_with_its_cause_actor_and_number(fixture: Fixture) -> None:
    found = findings(fixture.planted, fixture.joints)
    causes = {finding.cause for finding in found}
    assert fixture.cause in causes
    assert causes == {fixture.cause}
    (first, *_) = [finding for finding in found if finding.cause == fixture.cause]
    assert first.route == fixture.route
    assert first.value == pytest.approx(fixture.number, abs=0.05)
    assert any(character.isdigit() for character in first.hint)


@pytest.mark.parametrize("fixture", FIXTURES, ids=lambda fixture: fixture.cause)
def test_nothing_is_reported_on_the_clean_twin(fixture: Fixture) -> None:
    assert not findings(fixture.clean, fixture.clean_joints or fixture.joints)


def test_a_finding_that_geometry_does_not_explain_is_left_as_it_is() -> None:
    meshes = {"a": box(10, 10, 10), "b": box(10, 10, 10).transformed(at(2, 2, 2))}
    joints = [joint("shift", "planar", "a", "b", lower=(0.0, 0.0, 0.0), upper=(1.0, 1.0, 0.1))]
    scene = Scene.of(meshes, joints)
    mechanism = Mechanism(("a", "b"), "a", joints)
    before = check_scene(scene, mechanism.rest_poses()).findings
    assert len(before) == 1
    assert diagnose(scene, mechanism.tree, before) == before


def test_the_hint_of_a_missing_hole_gives_diameter_and_depth() -> None:
    (finding, *_) = findings(FIXTURES[0].planted, FIXTURES[0].joints)
    assert "Bore block" in finding.hint
    assert "10.4 mm, 10 mm deep" in finding.hint


def test_the_hint_of_a_drawer_that_is_too_long_says_by_how_much() -> None:
    (finding, *_) = findings(FIXTURES[2].planted, FIXTURES[2].joints)
    assert "Shorten drawer by 2 mm along its y" in finding.hint


def test_the_hint_of_axes_too_close_gives_the_distance_they_need() -> None:
    (finding, *_) = [finding for finding in findings(PINS, rods(50.0)) if finding.cause == "pitch"]
    assert finding.limit == pytest.approx(2 * math.hypot(30, 2))


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("carries_the_lid", [True, False])
def test_an_axis_moved_as_the_hint_says_clears_the_two_parts(seed: int, carries_the_lid: bool) -> None:
    """A lid of random size on a wall, turned in space, with its axis inside the wall, too low; either part may be the parent."""
    rng = default_rng(seed)
    length, thick, wall, inset, low = rng.uniform((60, 6, 8, 3, 4), (140, 14, 14, 6, 9)).tolist()
    T = SE3.exp(np.concatenate([rng.uniform(-50, 50, 3), rng.normal(size=3)]))
    meshes = {
        "wall": box(60, wall, 80, center=False).transformed(T @ at(-30, 0, -80)),
        "lid": box(60, length, thick, center=False).transformed(T @ at(-30, 0, 0.2)),
    }
    frame = T @ SE3.from_axes([0, inset, -low], [1.0 if carries_the_lid else -1.0, 0, 0], [0, 1.0, 0])
    parent, child = ("wall", "lid") if carries_the_lid else ("lid", "wall")

    def hinge(shift: FloatArray) -> Joint:
        moved = SE3.from_translation(shift) @ frame
        return joint("hinge", "revolute", parent, child, at_parent=moved, at_child=moved, lower=(0.0,), upper=(1.7,))

    (finding,) = findings(meshes, [hinge(np.zeros(3))])
    assert finding.cause == "pivot_on_face"
    told = re.search(rf"Move the axis by \((\S+), (\S+), (\S+)\) mm in the frame of {parent}", finding.hint)
    assert told, finding.hint
    assert not findings(meshes, [hinge(np.array([float(number) for number in told.groups()]))])
