"""Fits by name: in plans and in Python, from the name to the play that is measured."""

from __future__ import annotations

from typing import Any

import pytest

from articad.errors import PlanError
from articad.plan.brief import brief
from articad.plan.check import check_plan
from articad.plan.fit_names import PRINTED_MM, named_gap
from articad.plan.resolve import Fit, resolve
from articad.plan.schema import AssemblyPlan
from tests.plan.samples import pair

REVOLUTE = {"type": "revolute", "angle_deg": [0, 90]}


def plan(fit: Any, **joint: Any) -> AssemblyPlan:
    return AssemblyPlan.from_json(pair({**REVOLUTE, "fit": fit} | joint, 1))


def resolved_fit(fit: Any) -> Fit:
    return resolve(plan(fit)).fits["j"]


@pytest.mark.parametrize(
    "stated",
    ["25 H7/g6", {"name": "25 H7/g6"}, {"name": "H7/g6", "nominal_mm": 25}, {"name": "H7/g6", "nominal_mm": "5 * 5"}],
    ids=str,
)
def test_a_name_stands_for_half_the_differences_of_the_diameters(stated: Any) -> None:
    fit = resolved_fit(stated)
    assert (fit.gap_min, fit.gap_max, fit.nominal, fit.contact) == pytest.approx((0.0035, 0.0205, 25.0, "allowed"))
    assert fit == Fit.named(fit.name or "", 25)


def test_a_name_alone_awaits_the_bore() -> None:
    fit = resolved_fit("H8/f7")
    assert (fit.gap_min, fit.gap_max, fit.nominal) == (None, None, None)
    assert fit.sized(20).gap_max == pytest.approx(0.037)
    assert Fit.named("H8/f7") == fit


@pytest.mark.parametrize("name", ["loose", "sliding"])
def test_printing_classes_need_no_diameter(name: str) -> None:
    fit = resolved_fit(name)
    assert (fit.gap_min, fit.gap_max) == PRINTED_MM[name]
    assert fit == Fit.named(name)


def test_other_fields_are_kept() -> None:
    fit = resolved_fit({"name": "sliding", "within_mm": 6, "contact": "forbidden"})
    assert (fit.within, fit.contact) == (6.0, "forbidden")


def test_an_interference_is_modelled_with_equal_diameters() -> None:
    assert named_gap("H7/p6", 60) == (0.0, 0.0, True)
    assert named_gap("H7/k6", 40) == pytest.approx((0.0, 0.0115, False))
    assert named_gap("press", None).holds


@pytest.mark.parametrize(
    ("fit", "where", "words"),
    [
        ("H7g6", "joints.j.fit", "not the name of a fit"),
        ("slidng", "joints.j.fit", "Did you mean 'sliding'?"),
        ({"name": "H7/g6", "nominal_mm": 700}, "joints.j.fit", "from 1 to 500 mm"),
        ("20 H7/t6", "joints.j.fit", "no class t6 at 20 mm"),
        ({"name": "25 H7/g6", "nominal_mm": 30}, "joints.j.fit.nominal_mm", "a diameter other than 30 mm"),
        ({"name": "sliding", "gap_mm": [0, 1]}, "joints.j.fit", "both gap_mm and the name"),
        ({"nominal_mm": 30}, "joints.j.fit.nominal_mm", "without the name"),
        ("60 H7/p6", "joints.j.fit", "but the joint moves"),
        ("press", "joints.j.fit", "but the joint moves"),
    ],
    ids=str,
)
def test_what_a_name_cannot_state_is_reported(fit: Any, where: str, words: str) -> None:
    found = [finding for finding in check_plan(plan(fit)) if finding.code == "E_FIT"]
    assert [finding.where for finding in found] == [where]
    assert words in found[0].message + found[0].hint


def test_a_press_fit_holds_a_fixed_joint() -> None:
    assert "E_FIT" not in check_plan(AssemblyPlan.from_json(pair({"type": "fixed", "fit": "60 H7/p6"}, 0))).codes


def test_the_brief_of_a_part_tells_the_name_and_the_gap() -> None:
    told = brief(resolve(plan("25 H7/g6")), "b")["connectors"]["c"]["joints"][0]["fit"]
    assert told == {"gap_mm": [0.0035, 0.0205], "within_mm": None, "contact": "allowed", "name": "25 H7/g6", "nominal_mm": 25.0}


def test_a_plan_with_a_name_is_written_and_read() -> None:
    for fit in ("H7/g6", {"name": "25 H7/g6", "nominal_mm": 25}):
        assert AssemblyPlan.loads(plan(fit).dumps()) == plan(fit)


def test_python_states_a_fit_by_name() -> None:
    assert Fit.named("25 H7/g6") == Fit(0.0035, 0.0205, None, "allowed", "25 H7/g6", 25.0)
    with pytest.raises(PlanError, match="a diameter other"):
        Fit.named("25 H7/g6", 30)
    with pytest.raises(PlanError, match="not the name of a fit"):
        Fit.named("tight")
