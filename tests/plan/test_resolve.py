"""Resolving: numbers, frames, images and couplings of a plan, against values worked out by hand."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from articad.connectors import SE3, Plane, rest_mismatch
from articad.errors import PlanError
from articad.kinematics import Joint, JointType, Mechanism
from articad.plan.evaluation import Evaluation
from articad.plan.motions import motion
from articad.plan.resolve import ResolvedPlan, resolve
from articad.plan.schema import AssemblyPlan
from tests.plan.samples import Json, check, chest, connector, document, gears, joint, only, pair, part

X, Z = [1, 0, 0], [0, 0, 1]


def resolved(plan: Json, **parameters: float) -> ResolvedPlan:
    return resolve(AssemblyPlan.from_json(plan), **parameters)


def axes(result: ResolvedPlan, part_name: str, name: str) -> tuple[list[float], list[float], list[float]]:
    """Return o, z and x of a connector, rounded."""
    frame = result.parts[part_name].connectors[name].frame
    return tuple(np.round(v, 9).tolist() for v in (frame.translation, frame.z_axis, frame.x_axis))


def joint_of(result: ResolvedPlan, name: str) -> Joint:
    return next(joint for joint in result.joints if joint.name == name)


def rolls(result: ResolvedPlan) -> list[float]:
    """Return how far each joint's connectors are turned against each other at rest [rad], from the definition of D."""
    found = []
    for each in result.joints:
        D = rest_mismatch(
            result.parts[each.parent].T_rest,
            each.T_parent_connector,
            each.motion(each.rest),
            each.mate,
            each.T_child_connector,
            result.parts[each.child].T_rest,
        )
        R = D.rotation
        found.append(abs(math.atan2(R[1, 0] - R[0, 1], R[0, 0] + R[1, 1])))
    return found


# ---------------------------------------------------------------- numbers


def test_the_wardrobes_numbers() -> None:
    result = resolved(document("wardrobe"))
    assert result.parameters["door_bottom"] == 18 + 3 + 2 * 203 + 18
    assert result.parts["door_left"].dimensions == {"width": 448.5, "height": 1355.0, "thickness": 18.0, "inset": 6.0}
    assert result.parts["cabinet"].envelope == (900.0, 521.0, 1800.0)
    assert result.parts["door_left"].T_rest.translation.tolist() == [-444.0, -15.0, 445.0]
    assert result.parts["door_right"].material.name == "lacquer"
    assert (result.materials["plywood"].density, result.materials["plywood"].friction) == (650.0, 0.6)
    assert result.parts["cabinet"].parent_joint is None
    assert result.parts["drawer_upper"].parent_joint == "slide_upper"
    assert result.fits["hinge_left"].gap_max == 0.4
    assert result.fits["slide_upper"].contact == "forbidden"
    assert result.fits["slide_upper"].gap_max == 3.5
    assert joint_of(result, "slide_lower").limits.upper == (0.75 * 479,)


def test_an_override_moves_everything_that_follows() -> None:
    result = resolved(document("wardrobe"), width=1000.0)
    assert result.overrides == {"width": 1000.0}
    assert result.parts["door_left"].dimensions["width"] == 498.5
    assert result.parts["door_left"].T_rest.translation[0] == -494.0
    np.testing.assert_allclose(rolls(result), 0.0, atol=1e-12)
    replaced = resolved(document("wardrobe"), drawer_pitch=300.0)  # a parameter that is an expression
    assert replaced.parameters["door_bottom"] == 18 + 3 + 600 + 18


def test_an_override_that_is_no_parameter_or_out_of_bounds_is_refused() -> None:
    with pytest.raises(PlanError, match="E_PARAMETER_UNKNOWN") as error:
        resolved(document("wardrobe"), wdith=1.0)
    assert "Did you mean 'width'?" in error.value.findings[0].hint
    with pytest.raises(PlanError, match="E_PARAMETER_BOUNDS") as error:
        resolved(document("wardrobe"), width=2000.0)
    finding = error.value.findings[0]
    assert (finding.value, finding.limit, finding.unit) == (2000.0, 1400.0, "mm")


def test_counts_are_whole_and_angles_stay_degrees() -> None:
    plan = chest()
    part(plan, "box")["dimensions"] = {"slots_count": "2 + 1", "tilt_deg": 30, "width": "width", "offset": -2}
    dimensions = resolved(plan).parts["box"].dimensions
    assert dimensions == {"slots_count": 3, "tilt_deg": 30.0, "width": 300.0, "offset": -2.0}
    assert isinstance(dimensions["slots_count"], int)


def test_colours_fall_back_to_the_source_and_the_material() -> None:
    plan = document("wardrobe")
    assert resolved(plan).parts["door_right"].color == "#f4f1ea"
    part(plan, "door_left")["color"] = "#AA0000"
    assert resolved(plan).parts["door_right"].color == "#aa0000"
    part(plan, "door_right")["color"] = "#00bb00"
    assert resolved(plan).parts["door_right"].color == "#00bb00"
    assert resolved(plan).parts["door_right"].description.startswith("Flat panel")
    part(plan, "door_right")["description"] = "Mirrored."
    assert resolved(plan).parts["door_right"].description == "Mirrored."


def test_a_plan_that_cannot_go_on_raises_all_its_errors() -> None:
    plan = chest()
    part(plan, "box")["material"] = "wod"
    connector(plan, "lid", "hinge")["z"] = [0, 0, 0]
    with pytest.raises(PlanError) as error:
        resolved(plan)
    assert error.value.findings.codes == ("E_MATERIAL_UNKNOWN", "E_AXIS_ZERO")


def test_a_mate_that_does_not_meet_is_no_obstacle_to_resolving() -> None:
    plan = chest()
    part(plan, "lid")["rest_pose"] = {"at": [0, 0, 0]}
    assert not check(plan).ok
    assert resolved(plan).mechanism.nq == 1


def test_efforts_and_velocities_reach_their_coordinates() -> None:
    stated = {"effort_n": 5, "effort_n_mm": 100, "velocity_mm_s": 20, "velocity_deg_s": 180}
    form = {"type": "cylindrical", "travel_mm": [0, 9], "angle_deg": "endless", **stated}
    both = joint_of(resolved(pair(form, 2)), "j")
    assert (both.effort, both.velocity) == ((5.0, 100.0), (20.0, math.pi))
    assert joint_of(resolved(pair({"type": "ball", "cone_deg": 9, "effort_n_mm": 3}, 3)), "j").effort == (3.0,) * 4
    plain = joint_of(resolved(pair({"type": "slider", "travel_mm": [0, 1], "velocity_mm_s": 2}, 1)), "j")
    assert (plain.effort, plain.velocity) == ((), (2.0,))


def test_limits_and_rest_are_radians_and_endless_is_infinite() -> None:
    form = {"type": "screw", "lead_mm": -2, "angle_deg": "endless", "rest_deg": 180}
    screw = joint_of(resolved(pair(form, 1)), "j")
    assert (screw.limits.lower, screw.limits.upper) == ((-math.inf,), (math.inf,))
    assert (screw.rest, screw.lead) == ((math.pi,), -2.0)
    ball = joint_of(resolved(pair({"type": "ball", "cone_deg": 90, "twist_deg": [-180, 90]}, 3)), "j")
    assert (ball.limits.cone, ball.limits.twist) == (math.pi / 2, (-math.pi, math.pi / 2))


def test_the_mechanism_is_made_once_and_rests_where_the_plan_says() -> None:
    result = resolved(document("wardrobe"))
    assert result.mechanism is result.mechanism
    assert isinstance(result.mechanism, Mechanism)
    for name, pose in result.mechanism.rest_poses().items():
        assert pose.allclose(result.parts[name].T_rest)


def test_a_ground_with_a_rest_pose_carries_the_assembly() -> None:
    plan = chest()
    part(plan, "box")["rest_pose"] = {"at": [0, 0, 500]}
    part(plan, "lid")["rest_pose"] = {"at": [0, 100, 580]}
    assert not check(plan)
    assert resolved(plan).mechanism.rest_poses()["lid"].translation.tolist() == [0.0, 100.0, 580.0]


def test_a_pose_turns_about_its_point_and_then_shifts() -> None:
    plan = chest()
    part(plan, "box")["rest_pose"] = {"at": [1, 2, 3], "about": [10, 0, 0], "axis": [0, 0, 5], "angle_deg": 90}
    T = resolved(plan).parts["box"].T_rest
    np.testing.assert_allclose(T.apply([10, 0, 0]), [11, 2, 3], atol=1e-12)
    np.testing.assert_allclose(T.apply([12, 0, 0]), [11, 4, 3], atol=1e-12)


def test_connectors_in_the_assemblys_frame_are_brought_into_the_part() -> None:
    plan = chest()
    part(plan, "lid")["rest_pose"] = {"at": [0, 100, 80], "axis": [1, 0, 0], "angle_deg": 37}
    connector(plan, "lid", "hinge").update(frame="assembly", o=[0, 100, 80], z=[1, 0, 0], x=[0, 0, 1])
    assert not check(plan)
    frame = resolved(plan).parts["lid"].connectors["hinge"].frame
    np.testing.assert_allclose(frame.translation, 0, atol=1e-12)
    turned = math.radians(37)
    np.testing.assert_allclose(frame.x_axis, [0, math.sin(turned), math.cos(turned)], atol=1e-12)


# ---------------------------------------------------------------- rule 3: implicit x


def without_x(*references: str) -> Json:
    """Return the wardrobe without the x of these connectors."""
    plan = document("wardrobe")
    for reference in references:
        part_name, name = reference.split(".")
        connector(plan, part_name, name).pop("x")
    return plan


@pytest.mark.parametrize(
    "missing",
    [
        ["cabinet.hinge_left"],
        ["door_left.hinge"],
        ["cabinet.hinge_right"],
        ["cabinet.hinge_left", "door_left.hinge"],
        ["cabinet.hinge_left", "door_left.hinge", "cabinet.hinge_right"],
        ["cabinet.runner_upper", "drawer_lower.slide", "cabinet.runner_lower"],
    ],
)
def test_a_wardrobe_without_x_is_the_wardrobe(missing: list[str]) -> None:
    plan = without_x(*missing)
    assert not check(plan)
    stated, chosen = resolved(document("wardrobe")), resolved(plan)
    for name in stated.parts:
        for key, wanted in stated.parts[name].connectors.items():
            assert chosen.parts[name].connectors[key].frame.allclose(wanted.frame), f"{name}.{key}"


def test_a_mirrored_door_is_not_turned_over_by_the_rule() -> None:
    chosen = resolved(without_x("cabinet.hinge_left", "door_left.hinge", "cabinet.hinge_right"))
    assert axes(chosen, "cabinet", "hinge_left")[2] == X
    assert axes(chosen, "door_right", "hinge")[2] == [-1, 0, 0]
    assert axes(chosen, "cabinet", "hinge_right")[2] == [-1, 0, 0]  # not the world's X


def test_a_connector_whose_x_is_chosen_is_roll_free_and_its_image_too() -> None:
    chosen = resolved(without_x("door_left.hinge", "cabinet.hinge_right"))
    free = {(name, key): c.roll_free for name, each in chosen.parts.items() for key, c in each.connectors.items()}
    assert [key for key, value in free.items() if value] == [("cabinet", "hinge_right"), ("door_left", "hinge"), ("door_right", "hinge")]


@pytest.mark.parametrize(("z", "x"), [([0, 0, 1], [1, 0, 0]), ([1, 0, 0], [0, 1, 0]), ([0, 1, 0], [1, 0, 0]), ([1, 1, 0], [0, 0, 1])])
def test_where_neither_has_an_x_the_parent_takes_the_least_parallel_world_axis(z: list[float], x: list[float]) -> None:
    plan = pair({"type": "revolute", "angle_deg": [0, 90]}, 1)
    part(plan, "a")["rest_pose"] = part(plan, "b")["rest_pose"] = {"axis": [1, 2, 3], "angle_deg": 50}
    for name in ("a", "b"):
        connector(plan, name, "c").update(frame="assembly", z=z)
    result = resolved(plan)
    assert not check(plan)
    for name in ("a", "b"):
        connector_x = result.parts[name].T_rest.rotate(result.parts[name].connectors["c"].frame.x_axis)
        np.testing.assert_allclose(connector_x, x, atol=1e-9)


def test_the_rest_angle_is_taken_into_account() -> None:
    for given_side, other in (("a", "b"), ("b", "a")):
        plan = pair({"type": "revolute", "angle_deg": [-90, 90], "rest_deg": 30}, 1)
        connector(plan, given_side, "c")["x"] = X
        result = resolved(plan)
        turn = math.radians(30 if other == "b" else -30)
        np.testing.assert_allclose(result.parts[other].connectors["c"].frame.x_axis, [math.cos(turn), math.sin(turn), 0], atol=1e-12)


def test_joints_between_parts_that_are_not_derived_come_first() -> None:
    plan = without_x("cabinet.hinge_left", "door_left.hinge", "cabinet.hinge_right")
    plan["joints"] = [joint(plan, name) for name in ("hinge_right", "slide_upper", "hinge_left", "slide_lower")]
    assert not check(plan)
    assert axes(resolved(plan), "cabinet", "hinge_right")[2] == [-1, 0, 0]


def test_the_first_joint_of_a_shared_connector_decides_and_the_second_is_checked() -> None:
    plan = pair({"type": "revolute", "angle_deg": [0, 90]}, 2)
    plan["parts"].append(
        {
            "name": "d",
            "material": "steel",
            "description": "",
            "connectors": [{"name": "c", "o": [0, 0, 0], "z": Z, "x": [0, 1, 0], "label": ""}],
        }
    )
    connector(plan, "b", "c")["x"] = X
    plan["joints"].append({"name": "k", "type": "revolute", "parent": "a.c", "child": "d.c", "angle_deg": [0, 90]})
    finding = only(check(plan), "E_MATE_ROLL")
    assert finding.where == "joints.k"
    assert finding.hint == "Set x of d.c to (1, 0, 0), or rest_deg of the joint to 90."


def test_a_source_without_joints_takes_the_world_axis_before_its_images() -> None:
    plan = pair({"type": "fixed"}, 0)
    connector(plan, "b", "c")["name"] = "other"
    part(plan, "b")["connectors"].append({"name": "c", "o": [0, 0, 0], "z": Z, "label": ""})
    move = {"axis": Z, "angle_deg": 90}
    plan["parts"].append({"name": "d", "derive": {"from": "b", "op": "rigid", "move": move}})
    part(plan, "a")["connectors"].append({"name": "d", "o": [0, 0, 0], "z": Z, "label": ""})
    plan["joints"].append({"name": "k", "type": "fixed", "parent": "a.d", "child": "d.other"})
    result = resolved(plan)
    assert axes(result, "b", "other")[2] == X
    assert axes(result, "a", "d")[2] == [0, 1, 0]
    assert check(plan).ok


def test_an_unused_connector_takes_the_world_axis() -> None:
    plan = chest()
    part(plan, "box")["connectors"].append({"name": "spare", "o": [0, 0, 0], "z": [1, 0, 0], "label": ""})
    assert axes(resolved(plan), "box", "spare")[2] == [0, 1, 0]


unit = st.floats(-1, 1)
directions = st.tuples(unit, unit, unit).filter(lambda v: math.hypot(*v) > 0.1)


@settings(max_examples=50)
@given(directions, directions, st.floats(-180, 180), st.floats(-170, 170), st.sampled_from(["aligned", "opposed"]), st.integers(0, 2))
def test_after_the_rule_nothing_is_rolled_at_rest(z: Any, axis: Any, angle: float, rest: float, mate: str, stated: int) -> None:
    plan = pair({"type": "revolute", "angle_deg": [-170, 170], "rest_deg": rest, "mate": mate}, 1)
    part(plan, "b")["rest_pose"] = {"axis": list(axis), "angle_deg": angle}
    away = -1 if mate == "opposed" else 1
    connector(plan, "a", "c").update(z=list(z))
    connector(plan, "b", "c").update(frame="assembly", z=[away * c for c in z])
    if stated:
        across = np.cross(z, [0.6, -0.5, 0.62])
        if np.linalg.norm(across) > 0.05:
            connector(plan, "ab"[stated - 1], "c")["x"] = [float(c) for c in across]
            if stated == 1:
                connector(plan, "a", "c")["frame"] = "assembly"
    assert max(rolls(resolved(plan))) < 1e-9
    assert check(plan).ok


# ---------------------------------------------------------------- derived parts


def test_the_mirrored_door_of_the_reference() -> None:
    """kinematics §9: q_L = -60° and q_R = +60° put the two handles at mirrored places."""
    handle = (-235.9807621135, -644.0896534381, 550.0)
    hinge = {"name": "hinge", "o": [0, 0, 0], "z": Z, "x": X, "label": ""}
    plan: Json = {
        "schema": "articad.plan/1",
        "name": "doors",
        "ground": "frame",
        "freedoms": 2,
        "materials": [{"name": "wood", "density_kg_m3": 650, "color": "#c8a46e"}],
        "parts": [
            {
                "name": "frame",
                "material": "wood",
                "description": "",
                "connectors": [
                    {"name": "hinge_l", "o": [-450, -300, 50], "z": Z, "x": X, "label": ""},
                    {"name": "hinge_r", "o": [450, -300, 50], "z": Z, "x": [-1, 0, 0], "label": ""},
                ],
            },
            {"name": "door_l", "material": "wood", "description": "", "rest_pose": {"at": [-450, -300, 50]}, "connectors": [hinge]},
            {"name": "door_r", "derive": {"from": "door_l", "op": "mirror", "plane": {"point": [0, 0, 0], "normal": X}}},
        ],
        "joints": [
            {"name": "l", "type": "revolute", "parent": "frame.hinge_l", "child": "door_l.hinge", "angle_deg": [-110, 0]},
            {"name": "r", "derive": {"from": "l", "op": "mirror"}, "parent": "frame.hinge_r", "child": "door_r.hinge"},
        ],
    }
    assert check(plan).ok
    result = resolved(plan)
    derivation = result.parts["door_r"].derivation
    assert derivation is not None
    assert derivation.S is not None
    # the point of the left door that is at the handle's reference place at -60°, in the door's own frame
    poses = dict(zip(result.mechanism.parts, result.mechanism.poses(np.radians([-60.0, 60.0])), strict=True))
    in_door = poses["door_l"].inverse().apply(handle)
    in_mirrored = derivation.S @ [*in_door, 1.0]
    np.testing.assert_allclose(poses["door_r"].apply(in_mirrored[:3]), (235.9807621135, -644.0896534381, 550), atol=1e-9)
    assert np.degrees(joint_of(result, "r").limits.lower + joint_of(result, "r").limits.upper).tolist() == pytest.approx([0, 110])
    assert np.linalg.det(derivation.S[:3, :3]) == pytest.approx(-1)


def test_a_mirror_keeps_the_rest_pose_and_reflects_inside_the_part() -> None:
    result = resolved(document("wardrobe"))
    left, right = result.parts["door_left"], result.parts["door_right"]
    assert right.T_rest.allclose(left.T_rest)
    assert right.derivation is not None
    assert (right.derivation.source, right.derivation.op) == ("door_left", "mirror")
    world = Plane(np.zeros(3), np.array([1.0, 0, 0])).matrix
    corner = left.T_rest.apply([-6, -6, 0])
    assert right.derivation.S is not None
    mirrored = right.T_rest.apply((right.derivation.S @ [-6, -6, 0, 1])[:3])
    np.testing.assert_allclose(mirrored, (world @ [*corner, 1])[:3], atol=1e-9)
    assert right.envelope == left.envelope


def test_a_rigid_copy_moves_the_rest_pose_only() -> None:
    result = resolved(document("wardrobe"))
    lower, upper = result.parts["drawer_lower"], result.parts["drawer_upper"]
    assert (upper.T_rest.translation - lower.T_rest.translation).tolist() == [0.0, 0.0, 203.0]
    assert upper.connectors == lower.connectors
    assert upper.derivation is not None
    assert (upper.derivation.op, upper.derivation.S) == ("rigid", None)


def test_a_move_acts_in_the_assemblys_frame_after_the_sources_rest_pose() -> None:
    plan = pair({"type": "fixed"}, 0)
    part(plan, "b")["rest_pose"] = {"at": [100, 0, 0], "angle_deg": 90}
    for name, derive in (
        ("once", {"from": "b", "op": "rigid", "move": {"at": [10, 0, 0]}}),
        ("row", {"from": "b", "op": "pattern", "count": 2, "step": {"at": [10, 0, 0]}}),
    ):
        plan["parts"].append({"name": name, "derive": derive})
    plan["joints"] += [{"name": name, "type": "fixed", "parent": "a.c", "child": f"{name}.c"} for name in ("once", "row_1", "row_2")]
    parts = resolved(plan).parts
    for name, x in (("once", 110), ("row_1", 110), ("row_2", 120)):
        np.testing.assert_allclose(parts[name].T_rest.translation, [x, 0, 0], atol=1e-12)


def pattern(count: Any = 3, step: Json | None = None) -> Json:
    """Return a ring of pegs."""
    plan = pair({"type": "fixed"}, 0)
    connector(plan, "b", "c").update(o=[10, 0, 0], x=X)
    connector(plan, "a", "c").update(o=[10, 0, 0], x=X)
    step = step or {"axis": Z, "angle_deg": 90}
    plan["parts"].append({"name": "peg", "derive": {"from": "b", "op": "pattern", "count": count, "step": step}})
    return plan


def test_a_pattern_numbers_its_copies_and_moves_each_a_step_further() -> None:
    plan = pattern("1 + 2")
    result = resolve_only(plan)
    assert list(result.parts) == ["a", "b", "peg_1", "peg_2", "peg_3"]
    for copy in (1, 2, 3):
        T = result.parts[f"peg_{copy}"].T_rest
        turn = copy * math.pi / 2
        np.testing.assert_allclose(T.apply([10, 0, 0]), [10 * math.cos(turn), 10 * math.sin(turn), 0], atol=1e-12)
        assert result.parts[f"peg_{copy}"].derivation is not None


def resolve_only(plan: Json) -> ResolvedPlan:
    """Resolve a plan of parts that no joint holds, by fixing each to the first."""
    for index in range(1, 10):
        name = f"peg_{index}"
        turn = index * math.pi / 2
        if index <= 3:
            o = [10 * math.cos(turn), 10 * math.sin(turn), 0]
            part(plan, "a")["connectors"].append({"name": name, "o": o, "z": Z, "label": ""})
            plan["joints"].append({"name": name, "type": "fixed", "parent": f"a.{name}", "child": f"{name}.c"})
    assert check(plan).ok, check(plan)
    return resolved(plan)


def test_derived_parts_may_derive_from_derived_parts_in_any_order() -> None:
    plan = document("wardrobe")
    plan["freedoms"] = 5
    again = {"from": "door_right", "op": "mirror", "plane": {"point": [0, 0, 0], "normal": X}}
    plan["parts"].insert(0, {"name": "door_again", "derive": again})
    part(plan, "cabinet")["connectors"].append({"name": "again", "o": [-444, -15, 445], "z": Z, "x": X, "label": ""})
    derived = {"name": "again", "derive": {"from": "hinge_right", "op": "mirror"}, "parent": "cabinet.again", "child": "door_again.hinge"}
    plan["joints"].insert(0, derived)
    assert check(plan).ok, check(plan)
    result = resolved(plan)
    assert result.parts["door_again"].connectors["hinge"].frame.allclose(result.parts["door_left"].connectors["hinge"].frame)
    first, third = joint_of(result, "hinge_left"), joint_of(result, "again")
    assert (first.limits, first.rest, first.mate) == (third.limits, third.rest, third.mate)


@settings(max_examples=40)
@given(directions, st.tuples(*[st.floats(-500, 500)] * 3), directions, st.floats(-180, 180))
def test_mirrored_twice_is_the_part_itself(normal: Any, point: Any, axis: Any, angle: float) -> None:
    plan = pair({"type": "fixed"}, 0)
    part(plan, "b")["rest_pose"] = {"at": [30, -20, 10], "axis": list(axis), "angle_deg": angle}
    connector(plan, "b", "c").update(z=[0.3, 0.2, 1], x=[1, 0, -0.3])
    plane = {"point": list(point), "normal": list(normal)}
    plan["parts"] += [
        {"name": "once", "derive": {"from": "b", "op": "mirror", "plane": plane}},
        {"name": "twice", "derive": {"from": "once", "op": "mirror", "plane": plane}},
    ]
    plan["joints"] += [{"name": name, "type": "fixed", "parent": "a.c", "child": f"{name}.c"} for name in ("once", "twice")]
    result = resolved(plan)
    once, twice = result.parts["once"].derivation, result.parts["twice"].derivation
    assert once is not None
    assert twice is not None
    assert once.S is not None
    assert twice.S is not None
    np.testing.assert_allclose(once.S @ twice.S, np.eye(4), atol=1e-9)
    assert result.parts["twice"].connectors["c"].frame.allclose(result.parts["b"].connectors["c"].frame, mm=1e-9)


FORMS: list[Json] = [
    {"type": "fixed"},
    {"type": "revolute", "angle_deg": [-20, 110], "rest_deg": 30},
    {"type": "revolute", "angle_deg": "endless"},
    {"type": "slider", "travel_mm": [-5, 80], "rest_mm": 7},
    {"type": "cylindrical", "travel_mm": [-5, 80], "angle_deg": [-10, 90], "rest_mm": 3, "rest_deg": 45},
    {"type": "ball", "cone_deg": 35, "twist_deg": [-20, 60]},
    {"type": "screw", "lead_mm": 4, "angle_deg": [-90, 720], "rest_deg": 90},
    {"type": "planar", "x_mm": [-5, 8], "y_mm": [-3, 9], "angle_deg": [-20, 40]},
    {"type": "universal", "a_deg": [-20, 45], "b_deg": [-30, 35]},
]


@pytest.mark.parametrize("form", FORMS, ids=lambda form: form["type"])
@pytest.mark.parametrize("mate", ["aligned", "opposed"])
def test_a_mirrored_joint_moves_the_mirror_image(form: Json, mate: str) -> None:
    """The theorem of kinematics §8, on whole plans: at mirrored coordinates, the image is the reflection of the source."""
    plan = pair({**form, "mate": mate}, 0)
    flip = -1 if mate == "opposed" else 1
    z, x = np.array([0.2, -0.4, 1.0]), np.array([1.0, 0.5, 0.0])
    connector(plan, "a", "c").update(o=[40, 5, -8], z=z.tolist(), x=x.tolist())
    connector(plan, "b", "c").update(o=[40, 5, -8], z=(flip * z).tolist(), x=x.tolist())
    n = np.array([2.0, 1.0, 0.5])
    world = Plane(np.array([3.0, 0, 0]), n)
    image = SE3.from_matrix(world.matrix @ SE3.from_axes([40, 5, -8], z, x).matrix @ np.diag([1.0, -1, 1, 1]))
    mirrored = {"name": "m", "o": image.translation.tolist(), "z": image.z_axis.tolist(), "x": image.x_axis.tolist(), "label": ""}
    part(plan, "a")["connectors"].append(mirrored)
    plane = {"point": [3, 0, 0], "normal": n.tolist()}
    plan["parts"].append({"name": "b_m", "derive": {"from": "b", "op": "mirror", "plane": plane}})
    plan["joints"].append({"name": "m", "derive": {"from": "j", "op": "mirror"}, "parent": "a.m", "child": "b_m.c"})
    plan["freedoms"] = 2 * JointType(form["type"]).freedoms
    # a rest value turns or slides the child: put it where that leads
    result = resolved(plan)
    S = result.parts["b_m"].derivation
    assert S is not None
    assert S.S is not None
    source, copy = joint_of(result, "j"), joint_of(result, "m")
    signs = source.type.mirror_signs()
    rng = np.random.default_rng(1)
    q = source.type.neutral if source.type is JointType.BALL else tuple(rng.uniform(-1, 1, len(signs)))
    if source.type is JointType.BALL:
        v = rng.normal(size=4)
        q = tuple(v / np.linalg.norm(v))
    T = result.mechanism.poses(np.concatenate([q, signs * q]) if len(signs) else np.zeros(0))
    world_b, world_m = (T[result.mechanism.part_index(name)].matrix for name in ("b", "b_m"))
    np.testing.assert_allclose(world_m @ S.S, world.matrix @ world_b, atol=1e-9)
    for low, high, sign, (mirrored_low, mirrored_high) in zip(
        source.limits.lower, source.limits.upper, signs, zip(copy.limits.lower, copy.limits.upper, strict=True), strict=False
    ):
        assert (mirrored_low, mirrored_high) == ((low, high) if sign > 0 else (-high, -low))
    assert copy.rest == tuple(value * sign for value, sign in zip(source.rest, signs, strict=True))
    assert copy.mate is source.mate
    assert not copy.driver


@pytest.mark.parametrize("form", FORMS, ids=lambda form: form["type"])
def test_a_motion_mirrored_twice_is_itself(form: Json) -> None:
    plan = AssemblyPlan.from_json(pair(form, 0))
    read = motion(plan.joints[0], Evaluation(plan, {}))  # type: ignore[arg-type]
    assert read is not None
    assert read.mirrored().mirrored() == read
    assert read.mirrored() != read or form["type"] in {"fixed", "slider"} or form.get("angle_deg") == "endless"


@pytest.mark.parametrize(("normal", "sides"), [([1, 0, 0], (1, 2, 3)), ([1, 1, 0], (2, 1, 3)), ([1, 0.5, 0], None)])
def test_an_envelope_follows_its_mirror_while_it_stays_a_box(normal: list[float], sides: tuple[float, float, float] | None) -> None:
    plan = pair({"type": "fixed"}, 0)
    part(plan, "b")["envelope_mm"] = [1, 2, 3]
    plan["parts"].append({"name": "d", "derive": {"from": "b", "op": "mirror", "plane": {"point": [0, 0, 0], "normal": normal}}})
    plan["joints"].append({"name": "k", "type": "fixed", "parent": "a.c", "child": "d.c"})
    assert resolved(plan).parts["d"].envelope == sides


# ---------------------------------------------------------------- rule 7: placed by a joint


def lever(mate: str = "aligned", **lever_joint: Any) -> Json:
    """Return a box, a lever placed by its hinge, and a knob fixed to the lever, placed by that."""
    form = {"type": "revolute", "angle_deg": [-90, 90], "rest_deg": 30, "mate": mate, **lever_joint}
    plan = pair(form, 1)
    connector(plan, "a", "c").update(o=[0, 0, 50], x=X)
    connector(plan, "b", "c").update(o=[5, 0, 0], x=X)
    part(plan, "b")["rest_pose"] = "auto"
    part(plan, "b")["connectors"].append({"name": "tip", "o": [105, 0, 0], "z": X, "label": ""})
    foot = {"name": "foot", "o": [0, 0, 0], "z": [0, 0, -1], "label": ""}
    plan["parts"].append({"name": "knob", "material": "steel", "description": "", "rest_pose": "auto", "connectors": [foot]})
    plan["joints"].append({"name": "k", "type": "fixed", "parent": "knob.foot", "child": "b.tip", "mate": "opposed"})
    return plan


@pytest.mark.parametrize("mate", ["aligned", "opposed"])
def test_auto_places_a_part_from_its_joint_whichever_way_that_is_declared(mate: str) -> None:
    plan = lever(mate)
    findings = check(plan)
    assert findings.ok
    (note,) = findings.of("I_REST_AUTO")
    assert note.message.endswith(": b (j), knob (k).")
    result = resolved(plan)
    sign = -1 if mate == "opposed" else 1
    turn = math.radians(30)
    tip = [100 * math.cos(turn), 100 * math.sin(turn), 50]
    np.testing.assert_allclose(result.parts["b"].T_rest.apply([105, 0, 0]), tip, atol=1e-9)
    np.testing.assert_allclose(result.parts["b"].T_rest.rotate([0, 0, 1]), [0, 0, sign], atol=1e-12)
    np.testing.assert_allclose(result.parts["knob"].T_rest.translation, tip, atol=1e-9)
    for name, pose in result.mechanism.rest_poses().items():
        assert pose.allclose(result.parts[name].T_rest), name


@pytest.mark.parametrize("mate", ["aligned", "opposed"])
def test_auto_places_the_parent_of_a_joint_that_is_declared_the_other_way(mate: str) -> None:
    plan = pair({"type": "revolute", "angle_deg": [-90, 90], "rest_deg": 30, "mate": mate, "parent": "b.c", "child": "a.c"}, 1)
    connector(plan, "a", "c").update(o=[0, 0, 50], x=X)
    connector(plan, "b", "c").update(o=[5, 0, 0], x=X)
    part(plan, "b")["rest_pose"] = "auto"
    assert check(plan).codes == ("I_REST_AUTO",)
    result = resolved(plan)
    turn = math.radians(-30 if mate == "aligned" else 30)
    np.testing.assert_allclose(result.parts["b"].T_rest.rotate([1, 0, 0]), [math.cos(turn), math.sin(turn), 0], atol=1e-12)
    assert max(rolls(result)) < 1e-12
    assert result.mechanism.rest_poses()["b"].allclose(result.parts["b"].T_rest)


def test_a_part_that_hangs_on_an_image_of_an_auto_part_is_placed() -> None:
    plan = lever()
    plan["freedoms"] = 2
    plane = {"point": [0, 0, 0], "normal": [0, 1, 0]}
    plan["parts"].insert(0, {"name": "twin", "derive": {"from": "b", "op": "mirror", "plane": plane}})
    plan["joints"].insert(0, {"name": "t", "derive": {"from": "j", "op": "mirror"}, "parent": "a.t", "child": "twin.c"})
    part(plan, "a")["connectors"].append({"name": "t", "o": [0, 0, 50], "z": Z, "x": X, "label": ""})
    foot = {"name": "foot", "o": [0, 0, 0], "z": X, "x": Z, "label": ""}
    plan["parts"].insert(0, {"name": "cap", "material": "steel", "description": "", "rest_pose": "auto", "connectors": [foot]})
    plan["joints"].append({"name": "cap", "type": "fixed", "parent": "twin.tip", "child": "cap.foot"})
    assert check(plan).ok, check(plan)
    result = resolved(plan)
    turn = math.radians(-30)
    np.testing.assert_allclose(result.parts["cap"].T_rest.translation, [100 * math.cos(turn), 100 * math.sin(turn), 50], atol=1e-9)
    for name, pose in result.mechanism.rest_poses().items():
        assert pose.allclose(result.parts[name].T_rest), name


def test_other_connectors_of_an_auto_part_may_be_given_in_the_assemblys_frame() -> None:
    plan = lever()
    turn = math.radians(30)
    tip = [100 * math.cos(turn), 100 * math.sin(turn), 50]
    connector(plan, "b", "tip").update(frame="assembly", o=tip, z=[math.cos(turn), math.sin(turn), 0])
    assert check(plan).ok
    np.testing.assert_allclose(axes(resolved(plan), "b", "tip")[0], [105, 0, 0], atol=1e-9)


@pytest.mark.parametrize(
    ("change", "where", "words"),
    [
        (lambda plan: part(plan, "a").update(rest_pose="auto"), "parts.a.rest_pose", "The ground cannot"),
        (lambda plan: connector(plan, "b", "c").update(frame="assembly"), "parts.b.rest_pose", "given in the assembly's frame"),
    ],
)
def test_what_cannot_be_placed_by_a_joint_says_why(change: Any, where: str, words: str) -> None:
    plan = lever()
    change(plan)
    finding = only(check(plan), "E_REST_AUTO")
    assert finding.where == where
    assert words in finding.message


def test_parts_that_wait_for_each_other_say_so() -> None:
    plan = lever()
    plan["freedoms"] = 0
    move = {"at": [0, 0, 10]}
    plan["parts"].append({"name": "copy", "derive": {"from": "knob", "op": "rigid", "move": move}})
    joint(plan, "k").update(parent="knob.foot", child="copy.foot")
    plan["joints"].append({"name": "t", "type": "fixed", "parent": "b.tip", "child": "copy.foot"})
    finding = only(check(plan), "E_REST_AUTO")
    assert "wait for each other to be placed: knob -> copy -> knob" in finding.message


# ---------------------------------------------------------------- couplings


def row(plan: Json) -> tuple[str, str, float, float]:
    (coupling,) = resolved(plan).couplings
    return coupling.a, coupling.b, coupling.ratio, coupling.offset


def test_the_rows_of_all_couplings() -> None:
    both = {"joints": ["turn_small", "turn_large"]}
    assert row(gears(type="gear", teeth=[20, 40], **both)) == ("turn_small", "turn_large", -0.5, 0.0)
    assert row(gears(type="gear", teeth=[20, 40], internal=True, **both))[2] == 0.5
    assert row(gears(type="belt", radii_mm=[10, 40], **both))[2] == 0.25
    assert row(gears(type="rack", module_mm=2, teeth=20, joints=["turn_small", "slide"]))[2] == 20.0
    assert row(gears(type="screw", lead_mm=4, joints=["turn_small", "slide"]))[2] == 4 / (2 * math.pi)
    linear = row(gears(type="linear", ratio=2, joints=["turn_small", "slide"]))
    assert linear[2] == pytest.approx(2 / math.radians(1))
    assert row(gears(type="linear", ratio=-3, **both))[2] == pytest.approx(-3)


def test_antiparallel_axes_turn_a_gear_and_a_belt_over() -> None:
    for form, ratio in (({"type": "gear", "teeth": [20, 40]}, 0.5), ({"type": "belt", "radii_mm": [10, 40]}, -0.25)):
        plan = gears(joints=["turn_small", "turn_large"], **form)
        connector(plan, "frame", "q")["z"] = connector(plan, "large", "c")["z"] = [0, 0, -1]
        assert row(plan)[2] == ratio


def test_the_constant_follows_from_the_rest_values() -> None:
    plan = gears(type="gear", teeth=[20, 40], joints=["turn_small", "turn_large"])
    joint(plan, "turn_small")["rest_deg"] = 30
    joint(plan, "turn_large")["rest_deg"] = 10
    assert row(plan)[3] == pytest.approx(math.radians(10 + 0.5 * 30))


def test_a_cylindrical_joint_is_coupled_by_its_coordinate() -> None:
    plan = gears(type="screw", lead_mm=4, joints=["turn_small", "slide.travel"])
    joint(plan, "slide").update(type="cylindrical", angle_deg="endless")
    assert row(plan)[1] == "slide.travel"
    plan["couplings"][0] = {"name": "tie", "type": "belt", "radii_mm": [1, 1], "joints": ["turn_small", "slide.angle"]}
    assert row(plan)[1] == "slide.angle"


def test_the_four_bar_rests_on_its_reference_angles() -> None:
    """kinematics §9: coupler 29.0719076623°, rocker 95.1956999317° for a crank at 60°."""
    result = resolved(document("geared_four_bar"))
    ends = (("coupler", "b"), ("coupler", "c"), ("rocker", "d"))
    pins = {name: result.parts[part_name].connectors[name].frame.translation for part_name, name in ends}
    coupler, rocker = pins["c"] - pins["b"], pins["c"] - pins["d"]
    assert math.degrees(math.atan2(coupler[1], coupler[0])) == pytest.approx(29.0719076623, abs=1e-10)
    assert math.degrees(math.atan2(rocker[1], rocker[0])) == pytest.approx(95.1956999317, abs=1e-10)
    assert [coupling.ratio for coupling in result.couplings] == [-0.5]
    assert [waiver.max_depth for waiver in result.waivers] == [0.05]
    assert max(rolls(result)) < 1e-12
