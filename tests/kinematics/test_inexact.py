"""Rounded connectors: the loops close and move as the exact ones do, and the finding says by how much the data were off."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from articad.connectors import SE3
from articad.errors import LoopError
from articad.kinematics import Coupling, Joint, Mechanism
from articad.kinematics.inexact import ANGLE_TOLERANCE, POSITION_TOLERANCE
from tests.kinematics.linkages import at, bennett, four_bar, from_rest, misaligned, mismatch, scissor, slider_crank, stewart, watt
from tests.strategies import random_pose

MAKERS: dict[str, Callable[[], Mechanism]] = {
    "four_bar": four_bar,
    "slider_crank": slider_crank,
    "watt": watt,
    "bennett": lambda: bennett(1.0),
    "scissor": lambda: scissor(2, phi=0.6),
}


def reframed(mechanism: Mechanism, seed: int) -> Mechanism:
    """Return the same mechanism with a random frame for every part and the ground: no axis lies along a coordinate axis."""
    rng = np.random.default_rng(seed)
    frames = {part: random_pose(rng, 50.0) for part in mechanism.parts}
    joints = [
        replace(j, T_parent_connector=frames[j.parent] @ j.T_parent_connector, T_child_connector=frames[j.child] @ j.T_child_connector)
        for j in mechanism.joints
    ]
    return Mechanism(mechanism.parts, mechanism.ground, joints)


def rounded(frame: SE3, places: int, axis_places: int) -> SE3:
    """Return the frame that a reader makes of an origin, a z axis and an x axis written with so many decimals."""
    o, z, x = (np.round(v, d) for v, d in ((frame.translation, places), (frame.z_axis, axis_places), (frame.x_axis, axis_places)))
    return SE3.from_axes(tuple(o), tuple(z), tuple(x - (x @ z) / (z @ z) * z))


def with_digits(mechanism: Mechanism, places: int, axis_places: int) -> Mechanism:
    def cut(j: Joint) -> Joint:
        parent, child = (rounded(T, places, axis_places) for T in (j.T_parent_connector, j.T_child_connector))
        return replace(j, T_parent_connector=parent, T_child_connector=child)

    return Mechanism(mechanism.parts, mechanism.ground, [cut(j) for j in mechanism.joints])


def check_rounding(name: str, seed: int, places: int, axis_places: int) -> None:
    exact = reframed(MAKERS[name](), seed)
    mechanism = with_digits(exact, places, axis_places)
    driver = mechanism.drivers[0].name
    assert mechanism.mobility == exact.mobility == 1
    assert driver == exact.drivers[0].name
    ours, theirs = mechanism.feasible_range(driver), exact.feasible_range(driver)
    if "singular" not in {theirs.lower_reason, theirs.upper_reason}:  # links longer by a micrometre pass a flat scissor's singularity
        assert (ours.lower_reason, ours.upper_reason) == (theirs.lower_reason, theirs.upper_reason)
    off = max(10.0**-places, 100.0 * 10.0**-axis_places)  # mm: an axis is off by its rounding times a lever
    q = exact.rest + 0.2
    assert max(mismatch(mechanism, q)) < 1e-8
    distance = mechanism.poses(q).distance_to(exact.poses(q)).max()
    assert distance < 300 * off
    correction = mechanism.correction
    if correction is None:  # it closes to the solver's own tolerance
        assert off < 1e-6
        assert "W_LOOP_INEXACT" not in mechanism.findings().codes
        return
    (found,) = mechanism.findings().of("W_LOOP_INEXACT")
    assert found.value == correction.distance < 20 * off
    assert correction.angle < 20 * off / 30
    assert correction.within
    if off < 1e-8:
        return
    assert max(correction.distance, 30 * correction.angle) > 1e-4 * off  # digits that fit by luck: once in a few hundred roundings 6e-4


@pytest.mark.parametrize("name", MAKERS)
@pytest.mark.parametrize(("places", "axis_places"), [(3, 16), (4, 16), (6, 6), (16, 4), (16, 9), (12, 12), (9, 7)])
def test_a_rounded_linkage_moves_as_the_exact_one(name: str, places: int, axis_places: int) -> None:
    check_rounding(name, 7, places, axis_places)


@settings(max_examples=15)
@given(st.sampled_from(sorted(MAKERS)), st.integers(0, 2**16), st.integers(3, 12), st.integers(5, 12))
def test_any_linkage_in_any_frame_moves_with_any_number_of_digits(name: str, seed: int, places: int, axis_places: int) -> None:
    check_rounding(name, seed, places, axis_places)


@pytest.mark.soak
@settings(max_examples=400, deadline=None)
@given(st.sampled_from(sorted(MAKERS)), st.integers(0, 2**32 - 1), st.integers(3, 12), st.integers(5, 12))
def test_many_linkages_move_with_any_number_of_digits(name: str, seed: int, places: int, axis_places: int) -> None:
    check_rounding(name, seed, places, axis_places)


@pytest.mark.parametrize("make", [*MAKERS.values(), stewart, lambda: scissor(10)])
def test_exact_connectors_are_not_changed_by_a_bit(make: Callable[[], Mechanism]) -> None:
    exact = make()
    for mechanism in (exact, reframed(exact, 3)):
        assert mechanism.correction is None
        assert mechanism.joints is mechanism.given_joints
        assert "W_LOOP_INEXACT" not in mechanism.findings().codes


@pytest.mark.parametrize("tilt", [1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4])
def test_an_axis_tilted_within_the_tolerance_is_told_and_the_crank_turns_for_ever(tilt: float) -> None:
    for mechanism in (misaligned(tilt), four_bar(tilt=tilt)):
        assert mechanism.mobility == 1
        reach = mechanism.feasible_range("crank")
        assert (reach.lower_reason, reach.upper_reason) == ("endless", "endless")
        assert mechanism.correction is not None
        assert 0.3 * tilt < mechanism.correction.angle < tilt
        assert mechanism.findings().of("W_LOOP_INEXACT")[0].limit == mechanism.correction.distance_tolerance >= POSITION_TOLERANCE


def test_a_door_with_two_hinges_a_nanometre_apart_turns() -> None:
    hinges = [
        from_rest("low", "revolute", "frame", "door", at(0), driver=True),
        from_rest("high", "revolute", "frame", "door", at(0, 1e-6, 50)),
    ]
    door = Mechanism(("frame", "door"), "frame", hinges)
    assert door.mobility == 1
    assert door.feasible_range("low").upper_reason == "endless"
    assert door.correction is not None
    assert 1e-7 < door.correction.distance < 1e-6
    far = Mechanism(("frame", "door"), "frame", [hinges[0], from_rest("high", "revolute", "frame", "door", at(0, 0.1, 50))])
    assert far.mobility == 0
    assert "E_LOOP_LOCKED" in far.findings().codes


def test_the_moved_frames_are_the_ones_that_everything_sees() -> None:
    mechanism = with_digits(reframed(watt(), 1), 4, 6)
    assert mechanism.correction is not None
    assert mechanism.joints is mechanism.correction.joints
    assert mechanism.branch.layout.joints == mechanism.layout.joints == mechanism.joints
    assert max(mismatch(mechanism, mechanism.rest + 0.3)) < 1e-9
    moved = {(one.part, one.connector): one for one in mechanism.correction.moved}
    for given_joint, used in zip(mechanism.given_joints, mechanism.joints, strict=True):
        one = moved[used.parent, used.parent_connector]
        assert given_joint.T_parent_connector.distance_to(used.T_parent_connector) == pytest.approx(one.distance, abs=1e-12)
        assert given_joint.T_parent_connector.angle_to(used.T_parent_connector) == pytest.approx(one.angle, abs=1e-12)


@pytest.mark.parametrize("degrees", [0.02, 0.3, 1.206])
def test_axes_askew_beyond_the_tolerance_are_named_with_their_angle(degrees: float) -> None:
    tilt = SE3.rot_x(math.radians(degrees))
    plain = slider_crank(crank=0.5)
    joints = [replace(j, T_child_connector=j.T_child_connector @ tilt) if j.name == "small_end" else j for j in plain.joints]
    mechanism = Mechanism(plain.parts, plain.ground, joints)
    with pytest.raises(LoopError, match=rf"piston\.\w+ and piston\.\w+ are {degrees:.3f}° out of parallel") as caught:
        mechanism.poses(plain.rest)
    assert "0.000 mm" not in str(caught.value)
    assert "Lengthen" not in str(caught.value)
    with pytest.raises(LoopError, match=rf"coupler\.\w+ and coupler\.\w+ are {degrees:.3f}° out of parallel"):
        four_bar(tilt=math.radians(degrees)).poses([1.0])
    assert math.radians(degrees) > ANGLE_TOLERANCE


@pytest.mark.parametrize("degrees", [0.3, 1.206])
@pytest.mark.parametrize("about", ["x", "y"])
@pytest.mark.parametrize("name", ["pin_b", "pin_c", "rocker"])
def test_the_angle_is_that_of_the_axis_which_is_askew(name: str, about: str, degrees: float) -> None:
    """Whatever joint and direction: other frames, turned by less, explain most of what is wrong but not all of it."""
    plain = four_bar()
    tilt = (SE3.rot_x if about == "x" else SE3.rot_y)(math.radians(degrees))
    joints = [replace(j, T_child_connector=j.T_child_connector @ tilt) if j.name == name else j for j in plain.joints]
    (found,) = Mechanism(plain.parts, plain.ground, joints).findings().of("E_LOOP_OPEN", "E_LOOP_LOCKED")
    assert f"{degrees:.3f}°" in found.message


def test_a_pin_out_of_the_plane_beyond_the_tolerance_is_named_with_its_distance() -> None:
    plain = four_bar()
    joints = [replace(j, T_child_connector=j.T_child_connector @ at(0, 0, 0.1)) if j.name == "pin_b" else j for j in plain.joints]
    mechanism = Mechanism(plain.parts, plain.ground, joints)
    (found,) = mechanism.findings().of("E_LOOP_OPEN")
    assert "would have to move by 0.100 mm" in found.message
    joints = [replace(j, T_child_connector=j.T_child_connector @ at(0, 0, 0.001)) if j.name == "pin_b" else j for j in plain.joints]
    assert Mechanism(plain.parts, plain.ground, joints).mobility == 1


@pytest.mark.parametrize("offset", [1e-3, 0.01, 0.3])
def test_couplings_that_contradict_each_other_are_no_matter_of_axes(offset: float) -> None:
    linkage = four_bar()
    joints = [
        *linkage.joints,
        from_rest("motor", "revolute", "frame", "pinion", at(-60)),
        from_rest("second", "revolute", "frame", "wheel", at(-90)),
    ]
    couplings = [
        Coupling("mesh", "gear", "motor", "crank", 0.5, math.radians(60)),
        Coupling("one", "gear", "motor", "second", -2.0),
        Coupling("two", "gear", "motor", "second", -2.0, offset),
    ]
    (found,) = Mechanism((*linkage.parts, "pinion", "wheel"), "frame", joints, couplings).findings()
    assert found.code == "E_COUPLING_REST"
    assert found.message == "Couplings contradict each other."
    assert found.hint == "Set their offsets from the rest values."
