"""Remedies: one mistake in a plan is taken back by one change, however many findings it causes."""

from __future__ import annotations

import copy
from typing import Any

import pytest

from articad.plan.amending import amended
from articad.plan.check import check_plan
from articad.plan.remedies import advised, remedies
from articad.plan.schema import AssemblyPlan
from tests.plan.samples import Json, document, pair
from tests.plan.test_check import TURNING, gears_with


def serious(plan: Json) -> list[Any]:
    return [finding for finding in check_plan(AssemblyPlan.from_json(plan)) if finding.severity != "info"]


def offered(plan: Json) -> list[Any]:
    return list(remedies(AssemblyPlan.from_json(plan), serious(plan)))


def two_on_a_rail() -> Json:
    """Return a rail with two carriages, each on a connector of its own and posed by numbers, and a cap that a carriage holds."""
    plan = pair({"type": "slider", "travel_mm": [0, 9]}, 2)
    rail, first = plan["parts"]
    rail["connectors"] = [{**rail["connectors"][0], "name": name, "o": [at, 0, 0], "x": [1, 0, 0]} for name, at in (("c", 0), ("d", 40))]
    first["connectors"][0]["x"] = [1, 0, 0]
    first["connectors"].append({**first["connectors"][0], "name": "top", "o": [0, 0, 12]})
    first["rest_pose"] = {"at": [0, 0, 0]}
    second = {**copy.deepcopy(first), "name": "e", "rest_pose": {"at": [40, 0, 0]}, "connectors": [dict(first["connectors"][0])]}
    cap = {**copy.deepcopy(second), "name": "cap", "rest_pose": {"at": [0, 0, 12]}}
    plan["parts"] += [second, cap]
    plan["joints"] += [{**plan["joints"][0], "name": "k", "parent": "a.d", "child": "e.c"}]
    plan["joints"] += [{"name": "held", "type": "fixed", "parent": "b.top", "child": "cap.c"}]
    return plan


def test_the_sample_is_sound() -> None:
    assert serious(two_on_a_rail()) == []


SLIPS: dict[str, Json] = {
    "a pose": {"parts.b.rest_pose.at": [0, 0, 5]},
    "two poses exchanged": {"parts.b.rest_pose.at": [40, 0, 0], "parts.e.rest_pose.at": [0, 0, 0]},
    "a connector of the ground": {"parts.a.connectors.c.o": [1, 0, 0]},
    "a reversed axis": {"parts.e.connectors.c.z": [0, 0, -1]},
    "exchanged axes": {"parts.a.connectors.d.z": [1, 0, 0], "parts.a.connectors.d.x": [0, 1, 0]},
    "a turned axis": {"parts.cap.connectors.c.x": [0, 1, 0]},
    "a mate": {"joints.k.mate": "opposed"},
    "another end": {"joints.k.parent": "b.top"},
    "a joint that is fixed nowhere": {"joints.held": None},
}


@pytest.mark.parametrize("slip", SLIPS)
def test_a_slip_is_taken_back_by_one_of_the_changes_that_are_offered(slip: str) -> None:
    good = two_on_a_rail()
    bad = amended(good, SLIPS[slip])
    assert serious(bad)
    changes = offered(bad)
    assert changes
    mended = [amended(bad, change) for change in changes]
    assert all(serious(plan) == [] for plan in mended)
    if "nowhere" not in slip:  # a new joint has a name of its own
        same = [AssemblyPlan.from_json(plan).parts for plan in mended]
        assert AssemblyPlan.from_json(good).parts in same


def test_a_copy_on_the_other_side_is_put_back() -> None:
    plan = document("wardrobe")
    derived = next(each for each in plan["parts"] if each.get("derive", {}).get("move", {}).get("at"))
    at = derived["derive"]["move"]["at"]
    bad = amended(plan, {f"parts.{derived['name']}.derive.move.at": [f"-({value})" for value in at]})
    assert any(list(change) == [f"parts.{derived['name']}.derive.move.at"] for change in offered(bad))


def test_the_first_hint_states_the_changes_and_other_findings_stay() -> None:
    bad = AssemblyPlan.from_json(amended(two_on_a_rail(), SLIPS["a pose"]))
    told, found = advised(bad), check_plan(bad)
    assert [(one.code, one.where) for one in told] == [(one.code, one.where) for one in found]
    assert told[0].hint.startswith('One change ends all 2 findings: {"parts.b.rest_pose.at": [0, 0, 0]}. ')
    assert told[0].hint.endswith(found[0].hint)
    assert [one.hint for one in told[1:]] == [one.hint for one in found[1:]]


def test_a_plan_with_two_mistakes_has_no_single_remedy_and_a_sound_one_needs_none() -> None:
    bad = amended(two_on_a_rail(), {**SLIPS["a pose"], **SLIPS["a turned axis"], "parts.e.rest_pose.at": [40, 3, 0]})
    assert offered(bad) == []
    assert advised(AssemblyPlan.from_json(bad)) == check_plan(AssemblyPlan.from_json(bad))
    sound = AssemblyPlan.from_json(two_on_a_rail())
    assert advised(sound) == check_plan(sound)


@pytest.mark.parametrize("lower", [-40, -15, 0])
@pytest.mark.parametrize("slip", ["limits", "ratio", "sense"])
def test_a_range_that_a_coupling_does_not_reach_is_mended_where_it_is_wrong(lower: int, slip: str) -> None:
    """A wheel turns from `lower` to 60 degrees, the other one half as far the other way."""
    good = gears_with(lambda _plan: None, type="linear", ratio=-0.5, **TURNING)
    first, second = (name.split(".")[0] for name in TURNING["joints"])
    good = amended(good, {f"joints.{first}.angle_deg": [lower, 60], f"joints.{second}.angle_deg": [-31, 21]})
    slips = {
        "limits": (f"joints.{second}.angle_deg", [-21, 31]),
        "ratio": ("couplings.tie.ratio", -1.0),
        "sense": ("couplings.tie.ratio", 0.5),
    }
    address, value = slips[slip]
    bad = amended(good, {address: value})
    assert serious(good) == []
    assert {one.code for one in serious(bad)} == {"E_LOOP_LIMIT"}
    assert any(serious(amended(bad, change)) == [] and amended(bad, change) == good for change in offered(bad))


@pytest.mark.parametrize(
    ("kind", "type"), [("slide_axis", "slider"), ("thread_axis", "screw"), ("ball_centre", "ball"), ("hinge_axis", "revolute")]
)
@pytest.mark.parametrize("slip", ["missing", "fixed"])
def test_a_joint_that_is_missing_or_fixed_is_offered_as_its_connectors_suggest(kind: str, type: str, slip: str) -> None:  # noqa: A002
    motions: dict[str, Json] = {"slider": {"travel_mm": [0, 9]}, "screw": {"lead_mm": 3, "angle_deg": [0, 90]}, "ball": {"cone_deg": 9}}
    good = pair({"type": type, **motions.get(type, {"angle_deg": [0, 90]})}, 3 if type == "ball" else 1)
    for part in good["parts"]:
        part["connectors"][0]["kind"] = kind
    change = (
        {"joints.j": None}
        if slip == "missing"
        else {"joints.j": {k: v for k, v in good["joints"][0].items() if k in ("parent", "child")} | {"type": "fixed"}}
    )
    bad = amended(good, change)
    assert serious(good) == []
    assert serious(bad)
    first = amended(bad, offered(bad)[0])
    assert [joint["type"] for joint in first["joints"]] == [type]
    told = advised(AssemblyPlan.from_json(bad))[0].hint or ""
    assert ("The limits of the joint are examples" in told) == (type != "revolute")
