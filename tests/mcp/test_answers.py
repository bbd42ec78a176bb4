"""Answers are short, in the plan's units, and say what was proven, tried and lost."""

from __future__ import annotations

import json
import math
from typing import Any

from articad.mcp.answers import changed, compact, drivers, engines, losses, proof, steps, trials, verdict
from articad.mcp.skill import page


def test_answers_have_no_spaces_no_nulls_and_six_digits() -> None:
    assert compact({"a": math.pi, "b": None, "c": [1.0, {"d": None, "e": "é"}]}) == '{"a":3.14159,"c":[1.0,{"e":"é"}]}'


def test_drivers_are_told_in_the_units_of_the_plan() -> None:
    rows: list[dict[str, Any]] = [
        {"name": "lid", "unit": "rad", "lower": -math.pi / 2, "upper": 0.0, "rest": 0.0},
        {"name": "wheel", "unit": "rad", "lower": None, "upper": None, "rest": 0.0},
        {"name": "drawer", "unit": "mm", "lower": 0.0, "upper": 250.0, "rest": 0.0},
    ]
    assert json.loads(compact(drivers(rows))) == [
        {"name": "lid", "unit": "deg", "range": [-90, 0], "rest": 0},
        {"name": "wheel", "unit": "deg", "rest": 0},
        {"name": "drawer", "unit": "mm", "range": [0, 250], "rest": 0},
    ]


def test_a_proof_tells_only_ranges_that_are_narrower_than_declared() -> None:
    freedoms = [{"name": "lid", "turn": [0, 0, 1]}, {"name": "crank", "turn": [0, 0, 1]}, {"name": "slide", "turn": [0, 0, 0]}]
    report = {
        "claims": [1, 2, 3],
        "asked": ["lid"],
        "epsilon_mm": 0.001,
        "mechanism": {"joints": [{"freedoms": freedoms}]},
        "ranges": [
            {"joint": "lid", "declared": [0.0, math.pi], "free": [0.0, math.pi / 2]},
            {"joint": "crank", "declared": [-math.pi, math.pi], "free": [-math.pi, math.pi]},
            {"joint": "slide", "declared": [0.0, 10.0], "free": [0.0, 9.0]},
        ],
    }
    told = proof(report)
    assert told["free_only_in"] == {"lid": [0.0, 90.0], "slide": [0.0, 9.0]}
    assert (told["claims"], told["clearance_of_at_least_mm"]) == (3, 0.001)


def test_what_simulators_did_is_one_line_each() -> None:
    reach = {"joint": "turn", "share": 1.0}
    rows = [
        {"engine": "mujoco", "loads": True, "speed_at_rest": 0.0, "residual": 2e-6, "reaches": [reach, {**reach, "share": 0.4}]},
        {"engine": "pybullet", "loads": None},
        {"engine": "other", "loads": False, "message": "no mass"},
    ]
    assert trials({"engines": rows}) == [
        "mujoco: loads, 0 rad/s or m/s at rest, 1 of 2 driven joints reach their ends, loops open by 0.002 mm",
        "pybullet: not installed",
        "other: does not load: no mass",
    ]
    assert engines({"engines": rows}) == "loads in mujoco; not in other: no mass"


def test_a_loss_is_told_once_with_how_often_and_where() -> None:
    rows = [{"lost": "mass and inertia", "where": f"parts.p{index}"} for index in range(5)] + [{"lost": "limits", "where": "joints.a"}]
    assert losses(rows) == ["mass and inertia (5: parts.p0, parts.p1, parts.p2 …)", "limits (1: joints.a)"]


def test_the_fields_of_a_derivation_come_with_those_that_it_contains() -> None:
    told = page("derive")
    assert "`count`" in told
    assert "`normal`" in told


def _finding(code: str, where: str, severity: str) -> dict[str, Any]:
    return {"code": code, "where": where, "severity": severity, "message": f"{code} at {where}.", "hint": "Mend it.", "route": "design"}


def test_the_answer_on_a_clean_plan_is_short_however_many_notes_it_has() -> None:
    for count in (0, 1, 3, 50):
        report = {"ok": True, "findings": [_finding("I_REDUNDANT", f"joints.closing_joint_{n}", "info") for n in range(count)]}
        answer = verdict(report)
        assert len(compact(answer)) <= 400
        assert answer["ok"]
        assert len(answer.get("notes", [])) >= min(count, 3)


def test_errors_and_warnings_are_never_shortened_to_notes() -> None:
    report = {
        "ok": False,
        "findings": [_finding("E_COUNT", "a", "error"), _finding("W_DRIVER", "b", "warning"), _finding("I_X", "c", "info")],
    }
    answer = verdict(report)
    assert [(finding["code"], finding["hint"]) for finding in answer["findings"]] == [("E_COUNT", "Mend it."), ("W_DRIVER", "Mend it.")]
    assert answer["notes"] == ["I_X c"]


def test_a_change_returns_what_is_new_and_names_what_remains() -> None:
    old, kept, new = _finding("E_COUNT", "a", "error"), _finding("W_DRIVER", "b", "warning"), _finding("E_FIT", "c", "error")
    answer = changed([old, kept], {"ok": False, "findings": [kept, new]})
    assert ([finding["code"] for finding in answer["findings"]], answer["gone"], answer["remaining"]) == (["E_FIT"], 1, ["W_DRIVER b"])


def test_an_order_of_assembly_is_a_line_for_each_step() -> None:
    order = {
        "steps": [
            {"parts": ["base"], "subassembly": None, "moves": [], "strength": "proven"},
            {"parts": ["lid"], "subassembly": None, "moves": [{"direction": [0, 0, -1], "length_mm": 40.04}], "strength": "permitted"},
        ]
    }
    assert steps(order) == ["base: start", "lid: (0, 0, -1) 40.04, by force"]
    assert steps({}) is None
