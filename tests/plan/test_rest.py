"""The rest check: every mate error with its number, and a hint that mends it."""

from __future__ import annotations

import math
import re
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from articad.findings import Finding, Findings
from tests.plan.samples import Json, check, chest, connector, document, joint, only, pair, part

MATES = ("E_MATE_FLIP", "E_MATE_TILT", "E_MATE_ROLL", "E_MATE_OFFSET")
_ASSIGNMENT = re.compile(r"(o|z|x) of (\w+)\.(\w+) to \(([^)]*)\)")


def mended(plan: Json, findings: Findings) -> Json:
    """Return the plan with the connector values that the hints name."""
    for finding in findings.of(*MATES):
        for key, part_name, name, numbers in _ASSIGNMENT.findall(finding.hint):
            connector(plan, part_name, name)[key] = [float(number) for number in numbers.split(",")]
    return plan


def test_a_plan_whose_connectors_meet_has_no_finding() -> None:
    assert not check(chest())


def test_flip_names_the_mate_and_the_axis() -> None:
    plan = chest()
    connector(plan, "lid", "hinge")["z"] = [-1, 0, 0]
    finding = only(check(plan), "E_MATE_FLIP")
    assert finding.where == "joints.hinge"
    assert finding.message == "The z axes of box.hinge and lid.hinge oppose at rest (angle 180.0°) but mate is 'aligned'."
    assert finding.hint == "Set mate to 'opposed', or set z of lid.hinge to (1, 0, 0)."
    assert finding.value == pytest.approx(180)
    assert (finding.limit, finding.unit, finding.parts) == (0.05, "deg", ("box", "lid"))


def test_flip_of_an_opposed_mate_says_that_the_axes_agree() -> None:
    plan = chest()
    joint(plan, "hinge")["mate"] = "opposed"
    finding = only(check(plan), "E_MATE_FLIP")
    assert finding.message == "The z axes of box.hinge and lid.hinge agree at rest (angle 0.0°) but mate is 'opposed'."
    assert finding.hint.startswith("Set mate to 'aligned'")


def test_a_flip_that_is_not_a_half_turn_is_not_mended_by_the_mate() -> None:
    plan = chest()
    connector(plan, "lid", "hinge")["z"] = [-1, 1, 0]
    finding = only(check(plan), "E_MATE_FLIP")
    assert finding.value == pytest.approx(135)
    assert finding.hint == "Set z of lid.hinge to (1, 0, 0)."


def test_an_axis_is_mended_together_with_an_x_that_is_wrong_too() -> None:
    plan = chest()
    connector(plan, "lid", "hinge").update(z=[1, 0.2, 0], x=[-0.2, 1, 0])
    assert only(check(plan), "E_MATE_TILT").hint == "Set z of lid.hinge to (1, 0, 0) and x of lid.hinge to (0, 0, 1)."


def test_tilt_names_the_angle_and_the_corrected_axes() -> None:
    plan = chest()
    connector(plan, "lid", "hinge")["z"] = [1, math.tan(math.radians(10)), 0]
    finding = only(check(plan), "E_MATE_TILT")
    assert finding.message == "The z axes of box.hinge and lid.hinge are tilted by 10° at rest (mate 'aligned')."
    assert finding.hint == "Set z of lid.hinge to (1, 0, 0)."
    assert finding.value == pytest.approx(10)
    assert finding.limit == 0.05


def test_roll_names_x_and_the_rest_value() -> None:
    plan = chest()
    connector(plan, "lid", "hinge")["x"] = [0, -1, 0]  # +90° about z = X from (0, 0, 1)
    finding = only(check(plan), "E_MATE_ROLL")
    assert finding.message == "The x axes of box.hinge and lid.hinge differ by 90.0° about z: the part would be turned."
    assert finding.hint == "Set x of lid.hinge to (0, 0, 1), or rest_deg of the joint to 90."
    assert finding.value == pytest.approx(90)
    assert (finding.limit, finding.unit) == (0.05, "deg")


@pytest.mark.parametrize("mate", ["aligned", "opposed"])
@pytest.mark.parametrize("angle", [-100, -30, 20, 75])
def test_the_rest_value_that_roll_names_mends_it(mate: str, angle: float) -> None:
    plan = pair({"type": "revolute", "angle_deg": [-180, 180], "mate": mate}, 1)
    connector(plan, "a", "c")["x"] = [1, 0, 0]
    turned = math.radians(angle)
    connector(plan, "b", "c").update(z=[0, 0, 1 if mate == "aligned" else -1], x=[math.cos(turned), math.sin(turned), 0])
    finding = only(check(plan), "E_MATE_ROLL")
    rest = re.search(r"rest_deg of the joint to (-?[\d.]+)", finding.hint)
    assert rest
    joint(plan, "j")["rest_deg"] = float(rest[1])
    assert not check(plan).of(*MATES)


def test_a_rest_value_outside_the_limits_is_not_proposed() -> None:
    plan = chest()
    connector(plan, "lid", "hinge")["x"] = [0, 1, 0]
    assert only(check(plan), "E_MATE_ROLL").hint == "Set x of lid.hinge to (0, 0, 1)."
    plan = pair({"type": "fixed"}, 0)
    connector(plan, "a", "c")["x"] = [1, 0, 0]
    connector(plan, "b", "c")["x"] = [0, 1, 0]
    assert only(check(plan), "E_MATE_ROLL").hint == "Set x of b.c to (1, 0, 0)."


def test_a_whole_turn_is_taken_off_a_proposed_rest_value() -> None:
    plan = pair({"type": "revolute", "angle_deg": [0, 350], "rest_deg": 340}, 1)
    connector(plan, "a", "c")["x"] = [1, 0, 0]
    connector(plan, "b", "c")["x"] = [math.cos(math.radians(40)), math.sin(math.radians(40)), 0]
    assert only(check(plan), "E_MATE_ROLL").hint.endswith("or rest_deg of the joint to 40.")


def test_offset_names_the_vector_the_origin_and_the_rest_pose() -> None:
    plan = chest()
    part(plan, "lid")["rest_pose"] = {"at": [3, 100, 84]}
    finding = only(check(plan), "E_MATE_OFFSET")
    assert finding.message == ("box.hinge and lid.hinge are 5 mm apart at rest: lid.hinge is off by (3, 0, 4) mm in the assembly's frame.")
    assert finding.hint == "Set o of lid.hinge to (-3, 0, -4), or rest_pose.at of lid to (0, 100, 80)."
    assert (finding.value, finding.limit, finding.unit) == (5.0, 0.01, "mm")


def test_offset_along_a_slide_names_the_rest_travel() -> None:
    plan = pair({"type": "slider", "travel_mm": [0, 50]}, 1)
    connector(plan, "b", "c")["o"] = [0, 0, 12.5]
    assert only(check(plan), "E_MATE_OFFSET").hint.endswith(", or rest_mm of the joint to 12.5.")
    joint(plan, "j")["rest_mm"] = 12.5
    assert not check(plan).of(*MATES)
    connector(plan, "b", "c")["o"] = [0, 0, -12.5]
    joint(plan, "j")["rest_mm"] = 0
    assert "rest_mm" not in only(check(plan), "E_MATE_OFFSET").hint
    connector(plan, "b", "c")["o"] = [1, 0, 12.5]
    assert "rest_mm" not in only(check(plan), "E_MATE_OFFSET").hint


def test_a_connector_in_the_assemblys_frame_is_mended_in_that_frame() -> None:
    plan = chest()
    part(plan, "lid")["rest_pose"] = {"at": [0, 100, 80], "axis": [0, 0, 1], "angle_deg": 30}
    connector(plan, "lid", "hinge").update(frame="assembly", o=[0, 100, 81], z=[1, 0, 0], x=[0, 0, 1])
    finding = only(check(plan), "E_MATE_OFFSET")
    assert finding.hint == "Set o of lid.hinge to (0, 100, 80)."
    assert not check(mended(plan, check(plan)))


def test_the_fault_of_a_derived_childs_joint_is_mended_at_the_parent() -> None:
    plan = document("wardrobe")
    connector(plan, "cabinet", "hinge_right")["x"] = [1, 0, 0]
    finding = only(check(plan), "E_MATE_ROLL")
    assert finding.where == "joints.hinge_right"
    assert finding.message.startswith("The x axes of cabinet.hinge_right and door_right.hinge differ by 180.0° about z")
    assert finding.hint == "Set x of cabinet.hinge_right to (-1, 0, 0)."
    assert finding.value == pytest.approx(180)
    assert finding.parts == ("cabinet", "door_right")


@pytest.mark.parametrize("mate", ["aligned", "opposed"])
def test_a_parents_connector_is_mended_through_the_joints_own_motion(mate: str) -> None:
    form = {"type": "cylindrical", "travel_mm": [0, 50], "angle_deg": [-90, 90], "rest_mm": 12, "rest_deg": 35, "mate": mate}
    plan = pair(form, 4)
    connector(plan, "b", "c").update(o=[5, 6, 7], z=[0.1, 0.2, 1], x=[1, 0, -0.1])
    part(plan, "a")["connectors"].append({"name": "d", "o": [9, 9, 9], "z": [1, 1, 1], "x": [1, -1, 0], "label": ""})
    plan["parts"].append({"name": "e", "derive": {"from": "b", "op": "rigid", "move": {"at": [40, 0, 0], "angle_deg": 20}}})
    plan["joints"].append({"name": "k", "derive": {"from": "j", "op": "rigid"}, "parent": "a.d", "child": "e.c"})
    assert {finding.where for finding in check(plan).of(*MATES)} == {"joints.j", "joints.k"}
    for _ in range(2):  # an axis that is turned over hides the roll until it is right
        plan = mended(plan, check(plan))
    assert not check(plan).of(*MATES)


def test_between_two_derived_parts_the_hint_names_the_source() -> None:
    plan = document("wardrobe")
    plan["freedoms"] = 3
    handle = {
        "name": "knob",
        "material": "lacquer",
        "description": "",
        "rest_pose": {"at": [0, -40, 900]},
        "connectors": [{"name": "foot", "o": [0, 0, 0], "z": [0, 1, 0], "x": [1, 0, 0], "label": ""}],
    }
    part(plan, "door_left")["connectors"].append({"name": "knob", "o": [400, -30, 500], "z": [0, 1, 0], "x": [1, 0, 0], "label": ""})
    mirror = {"from": "knob", "op": "mirror", "plane": {"point": [0, 0, 0], "normal": [1, 0, 0]}}
    plan["parts"] += [handle, {"name": "knob_right", "derive": mirror}]
    plan["joints"] += [{"name": "knob_right", "type": "fixed", "parent": "door_right.knob", "child": "knob_right.foot"}]
    finding = next(finding for finding in check(plan).of("E_MATE_OFFSET") if finding.where == "joints.knob_right")
    assert "which comes from knob: change it there, or what knob_right derives by" in finding.hint


def test_two_faults_of_one_joint_are_both_told() -> None:
    plan = chest()
    connector(plan, "lid", "hinge").update(z=[-1, 0, 0], o=[0, 0, 1])
    assert check(plan).codes == ("E_MATE_FLIP", "E_MATE_OFFSET")


@pytest.mark.parametrize(("offset", "angle"), [(0.0099, 0.0), (0.0, 0.049)])
def test_faults_below_the_tolerance_pass(offset: float, angle: float) -> None:
    plan = chest()
    connector(plan, "lid", "hinge").update(o=[offset, 0, 0], z=[1, math.tan(math.radians(angle)), 0], x=[0, 0, 1])
    assert not check(plan)


@pytest.mark.parametrize("joint_type", ["ball", "planar", "universal"])
def test_joints_without_a_rest_value_rest_at_zero(joint_type: str) -> None:
    limits: dict[str, Json] = {
        "ball": {"cone_deg": 30},
        "planar": {"x_mm": [-1, 1], "y_mm": [-1, 1], "angle_deg": "endless"},
        "universal": {"a_deg": [-40, 40], "b_deg": [-40, 40]},
    }
    freedoms = {"ball": 3, "planar": 3, "universal": 2}
    plan = pair({"type": joint_type, **limits[joint_type]}, freedoms[joint_type])
    assert not check(plan)
    connector(plan, "b", "c")["o"] = [0, 0, 1]
    assert check(plan).codes == ("E_MATE_OFFSET",)


unit = st.floats(-1, 1)
axes = st.tuples(unit, unit, unit).filter(lambda v: math.hypot(*v) > 0.1)
points = st.tuples(*[st.floats(-2000, 2000)] * 3)
JOINTS: list[Json] = [
    {"type": "fixed"},
    {"type": "revolute", "angle_deg": [-170, 170], "rest_deg": 40},
    {"type": "slider", "travel_mm": [-90, 90], "rest_mm": -30},
    {"type": "cylindrical", "travel_mm": [-90, 90], "angle_deg": "endless", "rest_mm": 7, "rest_deg": -60},
    {"type": "screw", "lead_mm": 5, "angle_deg": "endless", "rest_deg": 500},
    {"type": "ball", "cone_deg": 30},
]


@settings(max_examples=60)
@given(st.sampled_from(JOINTS), st.sampled_from(["aligned", "opposed"]), points, axes, points, axes, st.data())
def test_the_hints_mend_any_two_connectors(form: Json, mate: str, o: Any, z: Any, at: Any, axis: Any, data: st.DataObject) -> None:
    plan = pair({**form, "mate": mate}, {"fixed": 0, "cylindrical": 2, "ball": 3}.get(form["type"], 1))
    frame = data.draw(st.sampled_from(["part", "assembly"]))
    part(plan, "b")["rest_pose"] = {"at": list(at), "axis": list(axis), "angle_deg": data.draw(st.floats(-180, 180))}
    connector(plan, "a", "c").update(o=list(data.draw(points)), z=list(data.draw(axes)))
    connector(plan, "b", "c").update(o=list(o), z=list(z), frame=frame)
    for name in ("a", "b"):
        if data.draw(st.booleans()):
            across = np.cross(connector(plan, name, "c")["z"], [0.3, 0.4, 0.5])
            if np.linalg.norm(across) > 0.05:
                connector(plan, name, "c")["x"] = [float(c) for c in across]
    assert not check(mended(plan, check(plan))).of(*MATES)


def test_findings_are_sorted_and_json() -> None:
    plan = chest()
    part(plan, "lid")["rest_pose"] = {"at": [0, 100, 85]}
    report = check(plan).to_json()
    assert report["ok"] is False
    assert report["findings"][0]["route"] == "design"
    assert isinstance(check(plan)[0], Finding)
