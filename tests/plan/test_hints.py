"""Hints work when they are followed literally: a scripted repairer that reads nothing but hints mends every planted fault.

The repairer changes plans by address only, as `edit_plan` does: so each finding's `where` is also shown to be an address.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable
from typing import Any

import pytest

from articad.errors import PlanError
from articad.findings import Finding
from articad.findings.codes import CODES
from articad.plan.amending import amended
from articad.plan.check import check_plan
from articad.plan.schema import AssemblyPlan
from articad_bench.obeying import followed
from tests.obedience import assert_heals, worse
from tests.plan.samples import DATA, Json, check, chest, pair
from tests.plan.test_check import CASES, TURNING, Case, gears_with
from tests.plan.test_schema import changed

MOST_STEPS = 10
FOUR_BAR = json.loads((DATA / "pinned_four_bar.json").read_text())

LINKAGES = [
    Case("E_DRIVER", amended(FOUR_BAR, {"joints.knee.driver": True}), "joints.knee", "already drive(s)"),
    Case("E_LOOP_LIMIT", amended(FOUR_BAR, {"joints.swing.angle_deg": ["tc - 5", "tc + 5"]}), "joints.drive", "the limit of swing"),
    Case("E_LOOP_LIMIT", amended(FOUR_BAR, {"joints.knee.angle_deg": [-120, 120]}), "joints.drive", "the limit of knee"),
    Case(
        "E_DEAD_POINT",
        amended(FOUR_BAR, {"joints.drive.driver": None, "joints.swing.driver": True, "joints.swing.angle_deg": [0, 359]}),
        "joints.swing",
        "a dead point",
    ),
    Case("E_MATE_OFFSET", amended(FOUR_BAR, {"parameters.tb.value": 10}), "joints.close", "mm apart"),
    Case(
        "W_DUP_CONNECTOR_USE",
        amended(FOUR_BAR, {"parts.base.connectors.a.kind": "hinge_axis"}),
        "parts.base.connectors.a",
        "drive and press",
    ),
    Case(
        "E_COUPLING_LOCKED",
        gears_with(
            lambda plan: plan["couplings"].append({"name": "again", "type": "gear", "teeth": [1, 3], **TURNING}),
            type="gear",
            teeth=[1, 2],
            **TURNING,
        ),
        "couplings.tie",
        "cannot move",
    ),
]
ALL = [*CASES, *LINKAGES]


def faults(plan: Json) -> list[Finding]:
    return [finding for finding in check(plan) if finding.severity != "info"]


def said(findings: list[Finding]) -> set[tuple[str, str, str]]:
    return {(finding.code, finding.where, finding.message) for finding in findings}


@pytest.mark.parametrize("case", ALL, ids=lambda case: f"{case.code}-{case.where}")
def test_each_change_that_a_hint_offers_heals_or_changes_its_finding(case: Case) -> None:
    finding = next(
        each for each in check(case.plan).of(case.code) if each.where == case.where and case.words in f"{each.message} {each.hint}"
    )
    plans = followed(finding, json.loads(json.dumps(case.plan)))  # a list of the case may hold one object twice
    assert plans, f"no rule for: {finding.hint}"
    for plan in plans:
        assert said([finding]).isdisjoint(said(list(check(plan)))), finding.hint


RANKS = [
    {"E_NAME", "E_DUP_NAME"},
    {"E_EXPRESSION", "E_EXPRESSION_CYCLE", "E_NONFINITE", "E_PARAMETER_BOUNDS", "E_MATERIAL_UNKNOWN", "E_COUNT", "E_DENSITY", "E_FRICTION"},
    {"E_ENVELOPE_VALUE", "E_DERIVE_UNKNOWN", "E_DERIVE_CYCLE", "E_DERIVE_COUNT", "E_AXIS_ZERO", "E_AXIS_PARALLEL", "E_AXIS_NOT_ORTHOGONAL"},
    {"E_LIMITS_MISSING", "E_LIMITS_ORDER", "E_LIMITS_KIND", "E_REST_OUTSIDE_LIMITS", "E_EFFORT", "E_LEAD_ZERO", "E_FIT", "E_ALLOW"},
    {"E_PART_UNKNOWN", "E_CONNECTOR_UNKNOWN", "E_JOINT_UNKNOWN", "E_JOINT_SELF", "E_NO_GROUND", "E_NO_CONNECTORS", "E_DERIVE_JOINT"},
    {"E_JOINT_DUP", "E_DISCONNECTED", "E_NOT_TREE", "E_REVERSE_UNSUPPORTED", "E_ENVIRONMENT", "E_REST_AUTO"},
    {"E_MATE_OFFSET", "E_MATE_FLIP", "E_MATE_TILT", "E_MATE_ROLL", "E_SCALE", "E_COUPLING", "E_COUPLING_AXES", "E_COUPLING_RATIO"},
    {"E_LOOP_OPEN", "E_LOOP_LOCKED", "E_COUPLING_LOCKED", "E_COUPLING_REST", "E_DRIVER", "E_DOF_MISMATCH"},
    {"E_LOOP_LIMIT", "E_DEAD_POINT"},
]
"""In which order the check judges: what is wrong with a name, a number or a frame hides what later ones would say of it."""
CHECKS_MORE = {"I_REST_AUTO"}  # its hint says how to have one more check, which then tells what it finds


def rank(code: str) -> int:
    return next((place for place, codes in enumerate(RANKS) if code in codes), len(RANKS))


@pytest.mark.parametrize("case", [case for case in ALL if case.code not in CHECKS_MORE], ids=lambda case: f"{case.code}-{case.where}")
def test_no_hint_advises_what_another_code_refuses(case: Case) -> None:
    """A change that a hint offers brings no error, but for those that the plan's own fault had hidden from the check."""
    if case.code in OF_JUDGEMENT:
        pytest.skip(OF_JUDGEMENT[case.code])
    plan = json.loads(json.dumps(case.plan))
    finding = next(each for each in check(plan).of(case.code) if each.where == case.where and case.words in f"{each.message} {each.hint}")
    for after in followed(finding, plan):
        new = [one for one in worse(check(plan), check(after)) if rank(one.code) <= rank(case.code)]
        assert not new, f"{finding.hint}\n{new}"


def test_every_error_of_a_plan_has_its_place_in_the_order_of_the_check() -> None:
    """A code without a place would be taken for one that nothing hides."""
    errors = {code for code, entry in CODES.items() if entry.stage == "plan"} | {case.code for case in ALL}
    elsewhere = {"E_SCHEMA", "E_PARAMETER_UNKNOWN", "E_NOT_SUPPORTED", "E_LEFT_HANDED", "E_NOT_ROTATION", "E_QUAT_NORM"}
    assert set.union(*RANKS) == {code for code in errors if code.startswith("E_")} - elsewhere


OF_JUDGEMENT = {
    "W_CHIRAL": "Whether the other hand is meant, and where the part stands then, only the designer knows.",
    "E_DERIVE_CYCLE": "What a part is like that is not derived, only the designer knows.",
}


@pytest.mark.parametrize("case", [case for case in ALL if case.code not in OF_JUDGEMENT], ids=lambda case: f"{case.code}-{case.where}")
def test_hints_followed_one_after_another_lead_to_a_sound_plan_and_never_back(case: Case) -> None:
    """No two hints undo each other: the repairer, which only follows hints, ends with a plan without errors and warnings."""
    start = json.loads(json.dumps(case.plan))  # a list of the case may hold one object twice
    ways, seen = [[start]], [start]
    while ways:  # depth first: a reader who finds no further hint goes back to the last alternative
        way = ways.pop()
        found = sorted(faults(way[-1]), key=lambda finding: finding.code != case.code)
        if not found:
            return
        offered = (after for finding in found for after in followed(finding, way[-1]) if after not in seen)
        after = next(offered, None) if len(way) <= MOST_STEPS else None
        if after is not None:
            seen.append(after)
            ways += [way, [*way, after]]
    raise AssertionError("\n".join(map(str, faults(start))))


Right = Callable[[re.Match[str]], Any]
MISSPELT: list[tuple[tuple[str | int, ...], Any, str, Right]] = [
    (("schema",), "articad.plan/2", r"Give (\"[\w./]+\")", lambda match: json.loads(match[1])),
    (("kernel",), "openscad", r"Give (\"\w+\") or", lambda match: json.loads(match[1])),
    (("parameters", 0, "unit"), "cm", r"Give (\"\w+\")", lambda match: json.loads(match[1])),
    (("materials", 0, "color"), "brown", r"#rrggbb", lambda _match: "#804000"),
    (("freedoms",), 1.5, "a whole number of at least 0", lambda _match: 1),
    (("tree",), "yes", "Give true or false", lambda _match: False),
    (("parts", 0, "connectors", 0, "kind"), "hinge", r"Did you mean '(\w+)'", lambda match: match[1]),
    (("joints", 0, "mate"), "opposite", r"Give (\"\w+\") or", lambda match: json.loads(match[1])),
    (("joints", 0, "type"), "revolve", r"Did you mean '(\w+)'", lambda match: match[1]),
    (("joints", 0, "type"), "hinge", r"Here it is called (\w+)\.", lambda match: match[1]),
    (("joints", 0, "type"), ..., r"Valid: fixed, (\w+)", lambda match: match[1]),
    (("joints", 0, "angle_deg"), 90, r"Give \[lower, upper\]", lambda _match: [0, 90]),
    (("joints", 0, "parent"), "box", "part.connector", lambda _match: "box.hinge"),
    (("parts", 1, "rest_pose"), "automatic", r"or (\"auto\")", lambda match: json.loads(match[1])),
    (("ground",), ..., "Add 'ground': The part that does not move", lambda _match: "box"),
    (("description",), None, "text in quotes", lambda _match: "A chest."),
    (("units",), "mm", "Allowed here: schema, name", lambda _match: ...),
    (("parts", 0, "connectors", 0, "naem"), "x", r"Did you mean 'name'\?", lambda _match: ...),
]
"""A place of the chest, what stands there instead, the words of the hint, and what its reader writes there; ... is nothing."""


def told(document: Json) -> list[Finding]:
    try:
        return list(check_plan(AssemblyPlan.from_json(document)))
    except PlanError as error:
        return list(error.findings)


@pytest.mark.parametrize(
    ("path", "wrong", "words", "right"), MISSPELT, ids=lambda value: ".".join(map(str, value)) if isinstance(value, tuple) else ""
)
def test_a_plan_of_the_wrong_form_is_read_when_its_hint_is_followed(
    path: tuple[str | int, ...], wrong: Any, words: str, right: Right
) -> None:
    before = told(changed(*path, value=wrong))
    finding = next(one for one in before if one.code == "E_SCHEMA" and re.search(words, one.hint))
    match = re.search(words, finding.hint)
    assert match
    value = right(match)
    assert_heals(finding, before, told(chest() if value is ... else changed(*path, value=value)))


JSON_ERRORS = {
    "no comma before": ('{"schema": "articad.plan/1",}', '{"schema": "articad.plan/1"}'),
    "keys and texts in double quotes": ("{'schema': 1}", '{"schema": "articad.plan/1"}'),
    "Remove one of them": ('{"name": "a", "name": "b"}', '{"name": "a"}'),
}


@pytest.mark.parametrize("words", JSON_ERRORS)
def test_a_text_that_is_no_json_is_read_when_its_hint_is_followed(words: str) -> None:
    def read(text: str) -> list[Finding]:
        try:
            AssemblyPlan.loads(text)
        except PlanError as error:
            return list(error.findings)
        return []

    fault, mended = JSON_ERRORS[words]
    finding = next(one for one in read(fault) if words in one.hint)
    assert not [one for one in read(mended) if one.message == finding.message]


FORMS: dict[str, Json] = {
    "fixed": {},
    "revolute": {"angle_deg": "endless"},
    "slider": {"travel_mm": [0, 9]},
    "cylindrical": {"travel_mm": [0, 9], "angle_deg": "endless"},
    "ball": {"cone_deg": 30},
    "screw": {"lead_mm": 2, "angle_deg": "endless"},
    "planar": {"x_mm": [0, 9], "y_mm": [0, 9], "angle_deg": "endless"},
    "universal": {"a_deg": [-9, 9], "b_deg": [-9, 9]},
}


@pytest.mark.parametrize("kind", ["frame", "mount_face"])
@pytest.mark.parametrize("first", FORMS)
@pytest.mark.parametrize("second", FORMS)
def test_the_advice_on_a_shared_connector_suits_both_of_its_joints(kind: str, first: str, second: str) -> None:
    """No way out of W_DUP_CONNECTOR_USE is refused by W_CONNECTOR_KIND."""
    plan = pair({"type": first, **FORMS[first]}, 1)
    plan["parts"][0]["connectors"][0]["kind"] = kind
    plan["parts"].append({**plan["parts"][1], "name": "e"})
    plan["joints"].append({"name": "k", "type": second, "parent": "a.c", "child": "e.c", **FORMS[second]})
    (finding,) = check(plan).of("W_DUP_CONNECTOR_USE")
    before = said(list(check(plan).of("W_CONNECTOR_KIND")))
    for after in followed(finding, plan):
        found = check(after)
        assert not found.of("W_DUP_CONNECTOR_USE")
        if "Set its kind" in (finding.hint or "") and after["parts"][0]["connectors"][0]["kind"] == "shaft_axis":
            assert not found.of("W_CONNECTOR_KIND")
        else:
            assert len(found.of("W_CONNECTOR_KIND")) <= max(len(before), 1)


RESTING = [(low, high, rest) for low in (-120, -15, 10) for high in (60, 110) for rest in (low, (low + high) / 2, high) if abs(rest) > 7]


@pytest.mark.parametrize(("low", "high", "rest"), RESTING)
@pytest.mark.parametrize("slip", ["radians", "sign"])
def test_limits_in_radians_or_with_the_wrong_sign_that_miss_the_rest_value_are_told_as_meant(
    low: int, high: int, rest: float, slip: str
) -> None:
    good = pair({"type": "revolute", "angle_deg": [low, high], "rest_deg": rest}, 1)
    wrong = [round(math.radians(low), 4), round(math.radians(high), 4)] if slip == "radians" else [-high, -low]
    bad = amended(good, {"joints.j.angle_deg": wrong})
    outside = [finding for finding in check(bad) if finding.code == "E_REST_OUTSIDE_LIMITS"]
    if wrong[0] <= rest <= wrong[1]:
        assert not outside
        return
    meant = followed(outside[0], bad)[0]["joints"][0]["angle_deg"]
    assert meant == pytest.approx([low, high], abs=0.01)


@pytest.mark.parametrize("thickness", [3, 8, 18])
@pytest.mark.parametrize("elsewhere", [True, False])
def test_a_wall_like_foil_is_told_as_its_like_or_as_thick_as_its_connectors_reach(thickness: int, elsewhere: bool) -> None:
    plan = pair({"type": "revolute", "angle_deg": [0, 90]}, 1)
    wall, other = plan["parts"]
    wall["dimensions"] = {"thickness": 0.01, "width": 70}
    other["dimensions"] = {"width": 70} | ({"thickness": thickness} if elsewhere else {})
    wall["connectors"].append({**wall["connectors"][0], "name": "far", "o": [70, 0, thickness]})
    (found,) = [finding for finding in check(plan) if finding.where == f"parts.{wall['name']}.dimensions.thickness"]
    offered = [each["parts"][0]["dimensions"]["thickness"] for each in followed(found, plan)]
    assert thickness in offered
    assert ("'thickness' of" in (found.hint or "")) == elsewhere
