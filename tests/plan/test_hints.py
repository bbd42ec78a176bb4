"""Hints work when they are followed literally: a scripted repairer that reads nothing but hints mends every planted fault.

The repairer changes plans by address only, as `edit_plan` does: so each finding's `where` is also shown to be an address.
"""

from __future__ import annotations

import json
import re

import pytest

from articad.findings import Finding
from articad.mcp.skill import skill
from articad.plan.amending import amended
from articad_bench.obeying import followed
from tests.plan.samples import Json, check, pair
from tests.plan.test_check import CASES, TURNING, Case, gears_with

MOST_STEPS = 10
(FOUR_BAR,) = (json.loads(text) for text in re.findall(r"```json\n(.*?)```", skill(), re.DOTALL) if '"four_bar"' in text)

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
    plans = followed(finding, case.plan)
    assert plans, f"no rule for: {finding.hint}"
    for plan in plans:
        assert said([finding]).isdisjoint(said(list(check(plan)))), finding.hint


OF_JUDGEMENT = {"W_CHIRAL", "E_DERIVE_CYCLE"}  # whether the other hand is meant; what a part is like that is not derived


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
