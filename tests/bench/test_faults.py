"""Planted faults: the cases, the trial of some that take seconds, the table, and, as a long run, all of them."""

from __future__ import annotations

import copy
import json
from collections import Counter
from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest

from articad.cli import main
from articad.findings import Finding
from articad.kernels.kernel import BuildCache
from articad.plan.remedies import advised
from articad.plan.schema import AssemblyPlan
from articad_bench.fault_reasons import REASONS
from articad_bench.fault_repair import healed
from articad_bench.fault_run import KINDS, FaultRun
from articad_bench.fault_table import page, report
from articad_bench.fault_trial import Row, Tools, programs, tried
from articad_bench.faulty import OBEDIENT, PRODUCTS, Fault, Kind, Product, chosen

KIND = {kind.name: kind for kind in KINDS}


@cache
def tools() -> Tools:
    return Tools.default()


@cache
def every() -> FaultRun:
    return FaultRun.of()


def planted(product: str, kind: str) -> Fault:
    (fault,) = chosen([KIND[kind]], [Product.named(product)], 1)
    return fault


def made(kind: str, good: Product, bad: Product, *names: str) -> Fault:
    return Fault(KIND[kind], good, bad, "by hand", frozenset(names))


def test_there_are_forty_kinds_and_four_hundred_cases_over_twenty_products() -> None:
    assert len(KIND) == len(KINDS) >= 40
    assert len(PRODUCTS) == len(every().products) == 20
    assert len(every().faults) >= 400
    assert {fault.kind.name for fault in every().faults} == set(KIND)
    assert len({fault.digest for fault in every().faults}) == len({fault.name for fault in every().faults}) == len(every().faults)


def test_no_case_is_the_good_product() -> None:
    for fault in every().faults:
        assert (fault.bad.plan, fault.bad.scripts) != (fault.good.plan, fault.good.scripts), fault.name
        scripts = {part: text.split(OBEDIENT)[0] for part, text in fault.bad.scripts.items()}  # authors follow faulty connectors
        changed = {"plan": fault.bad.plan != fault.good.plan, "script": scripts != fault.good.scripts}
        assert [side for side, is_changed in changed.items() if is_changed] == [fault.kind.side], fault.name


def test_a_case_depends_on_its_own_kind_and_product_alone() -> None:
    products = [Product.named(name) for name in ("hinge_butt_pin", "gears_18_36")]
    few = {fault.name: fault.digest for fault in chosen(KINDS, products[:1], 1)}
    more = {fault.name: fault.digest for fault in chosen(KINDS[::-1], products, 2)}
    assert few.items() <= more.items()


def test_some_cases_are_spread_over_the_kinds() -> None:
    some = FaultRun.of(some=30)
    assert len(some.faults) == 30
    assert max(Counter(fault.kind.name for fault in some.faults).values()) == 1


@pytest.mark.parametrize(
    ("product", "kind", "code"),
    [
        ("hinge_butt_pin", "limit_order", "E_LIMITS_ORDER"),
        ("hinge_butt_pin", "fit_impossible", "E_FIT"),
        ("hinge_butt_pin", "density_unit", "W_DENSITY"),
        ("four_bar", "joint_fixed", "E_MATE_ROLL"),
        ("wardrobe", "axis_reversed", "E_MATE_FLIP"),
        ("wardrobe", "joint_missing", "E_DISCONNECTED"),
        ("gears_18_36", "connector_unknown", "E_CONNECTOR_UNKNOWN"),
        ("door_bifold", "origin_off_5", "E_MATE_OFFSET"),  # the mistake is two joints away
        ("toggle_clamp", "limit_sign", "E_LOOP_LIMIT"),  # of the joint that ends the driver's range
    ],
)
def test_a_faulty_plan_is_refused_before_any_part_is_built(product: str, kind: str, code: str) -> None:
    row = tried(planted(product, kind), tools())
    assert row.stage == "plan"
    assert any(found[0].startswith(code) for found in row.findings)
    assert not row.escaped
    assert row.named
    assert row.addressed


@pytest.mark.parametrize(
    ("kind", "code"),
    [("two_solids", "E_NOT_ONE_SOLID"), ("dimension_misspelt", "E_SCRIPT_ERROR"), ("connector_turned", "E_CONNECTOR_DRIFT")],
)
def test_a_faulty_script_breaks_its_contract(kind: str, code: str) -> None:
    row = tried(planted("bookcase_low", kind), tools())
    assert row.stage == "build"
    assert row.findings[0][0] == code
    assert row.named
    assert row.addressed


@pytest.mark.parametrize(("product", "part"), [("hinge_butt_pin", "pin"), ("rod_tie_two_balls", "stud")])
def test_the_same_product_by_another_script_is_no_escape(product: str, part: str) -> None:
    """Also with balls, whose coordinates are quaternions."""
    good = Product.named(product)
    bad = replace(good, scripts={**good.scripts, part: good.scripts[part] + "\n# another script\n"})
    row = tried(made("literal_number", good, bad, part), tools())
    assert row.equivalent
    assert not row.escaped


@pytest.mark.parametrize(("kind", "outcome"), [("unit_inch", "valid"), ("shape_off", "escaped")])
def test_another_product_without_a_finding_is_an_escape_or_in_a_plan_another_valid_answer(kind: str, outcome: str) -> None:
    """The back is 1 mm narrower, which the checks of the task allow."""
    good = Product.named("bookcase_low")
    plan = copy.deepcopy(good.plan)
    back = next(part for part in plan["parts"] if part["name"] == "back")
    back["dimensions"]["width"] = back["dimensions"]["width"] - 1
    back.pop("envelope_mm", None)
    row = tried(made(kind, good, replace(good, plan=plan), "back"), tools())
    assert row.stage == "none"
    assert {"escaped": row.escaped, "valid": row.valid, "equivalent": row.equivalent} == {
        "escaped": False,
        "valid": False,
        "equivalent": False,
        outcome: True,
    }
    assert not row.named


def test_a_fit_goes_where_the_overlap_of_its_parts_goes() -> None:
    assert tried(planted("screw_jack_bottle", "axis_turned"), tools()).addressed


def test_a_finding_about_another_part_names_nothing() -> None:
    fault = planted("hinge_butt_pin", "limit_order")
    assert not tried(replace(fault, names=frozenset({"another"})), tools()).named
    assert not tried(replace(fault, kind=replace(fault.kind, causes=frozenset())), tools()).named


def test_results_are_kept_and_not_made_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run = FaultRun([planted("hinge_butt_pin", kind) for kind in ("limit_order", "fit_impossible")], ())
    first = run.work(tmp_path, Tools(tools().kernel, BuildCache(tmp_path / "cache")))
    assert first["all"]["cases"] == first["all"]["named"] == first["all"]["plan"] == 2
    assert json.loads((tmp_path / "faults.json").read_text()) == json.loads(json.dumps(first))
    text = (tmp_path / "faults.md").read_text()
    assert "| `limit_order`: limits exchanged | 1 |" in text
    monkeypatch.setattr("articad_bench.fault_run.tried", None)  # calling it would fail
    assert run.work(tmp_path, tools()) == json.loads((tmp_path / "faults.json").read_text()) | {"rows": first["rows"]}


def test_cases_that_are_chosen_are_tried_again_and_the_others_stay(tmp_path: Path) -> None:
    run = FaultRun([planted("hinge_butt_pin", kind) for kind in ("limit_order", "fit_impossible")], ())
    first = run.work(tmp_path, tools())
    assert [found["healed"] for found in first["rows"]] == [None, None]
    second = run.work(tmp_path, tools(), again=lambda row: row.kind == "limit_order", repair=True)
    assert [found["healed"] for found in second["rows"]] == [True, None]
    assert (second["all"]["repaired"], second["all"]["healed"]) == (1, 1)
    assert {found["programs"] for found in second["rows"]} == {programs()}


def test_hints_that_lead_to_the_good_plan_heal_and_nothing_is_built(monkeypatch: pytest.MonkeyPatch) -> None:
    fault = planted("rod_tie_two_balls", "pose_off")
    monkeypatch.setattr("articad_bench.fault_trial._assembled", None)  # calling it would fail
    row = tried(fault, tools(), repair=True)
    assert row.healed
    assert "parts.stud.rest_pose.at" in advised(AssemblyPlan.from_json(fault.bad.plan))[0].hint


def test_a_repair_ends_where_hints_lead_nowhere_or_no_product_is_green() -> None:
    fault = planted("rod_tie_two_balls", "pose_off")
    silent = [replace(one, hint="") for one in advised(AssemblyPlan.from_json(fault.bad.plan)) if one.severity != "info"]
    assert not healed(fault, silent, lambda _plan: silent, lambda _product: ())
    wrong = [replace(silent[0], hint='One change ends this finding: {"parts.rod.rest_pose.at": [9, 9, 9]}.')]
    tries: list[Product] = []

    def examine(product: Product) -> list[Finding]:
        tries.append(product)
        return silent

    assert not healed(fault, wrong, lambda _plan: (), examine)
    assert [product.plan["parts"][0]["rest_pose"] for product in tries] == [{"at": [9, 9, 9]}]
    assert healed(fault, wrong, lambda _plan: (), lambda _product: ())


def row(kind: Kind, **given: object) -> Row:
    found = (("E_FIT", "joints.a", "design", "A fit."),)
    plain = Row(f"p:{kind.name}", "p", kind.name, kind.side, "said", "plan", found, "0", named=True, addressed=True)
    return replace(plain, **given)  # type: ignore[arg-type]


def test_the_page_counts_what_it_lists() -> None:
    rows = [
        row(KIND["pose_off"]),
        row(KIND["limit_sign"], stage="none", escaped=True, named=False, addressed=False, findings=()),
        row(KIND["limit_order"], stage="none", equivalent=True, named=False, addressed=False, findings=()),
        row(KIND["fit_narrow"], stage="none", valid=True, named=False, addressed=False, findings=()),
        row(KIND["two_solids"], addressed=False, healed=False, programs="old"),
        row(KIND["shape_off"], named=False, addressed=False, healed=True, programs="new"),
    ]
    told = report(rows, {"p": ["E_OVERLAP"], "q": []}, planned=7, judged_by="new")
    assert (
        told["all"]["cases"],
        told["all"]["same"],
        told["all"]["valid"],
        told["all"]["escaped"],
        told["all"]["named"],
        told["all"]["addressed"],
    ) == (*(4, 1, 1, 1, 2, 1),)
    text = page(told, KINDS)
    assert "6 of 7 cases were tried, 1 of them by the newest programs" in text
    assert (
        "Escaped: 1 of 4 (25.0 %). Named: 2 of 4 (50.0 %). Addressed: 1 of 4 (25.0 %). Hints heal: at least 1 of 4 (25.0 %); 2 cases were repaired."
        in text
    )
    assert "False alarms: 1, on 2 good products.\n- p: E_OVERLAP" in text
    assert "False alarms: not measured" in page(report(rows, {}, planned=7), KINDS)
    assert "| `p:limit_sign` | said |" in text.split("## Escapes")[1].split("##")[0]
    assert "| `p:fit_narrow` | said |" in text.split("## Other valid answers")[1].split("##")[0]
    assert "| `p:two_solids` | said | `E_FIT` joints.a (design) |" in text.split("Named, but addressed")[1]
    assert "| `p:shape_off` | said | `E_FIT` joints.a (design) |" in text.split("Found, but not named")[1]


def test_the_page_of_the_docs_is_that_of_its_results() -> None:
    folder = Path(__file__).resolve().parents[2] / "docs" / "reference"
    stored = json.loads((folder / "faults.json").read_text())
    assert (folder / "faults.md").read_text() == page(stored, KINDS)
    assert {found["case"] for found in stored["rows"] if found["escaped"]} == set(REASONS)


@pytest.mark.soak
def test_all_cases(tmp_path: Path) -> None:
    told = every().work(tmp_path, tools())
    stored = json.loads((Path(__file__).resolve().parents[2] / "docs" / "reference" / "faults.json").read_text())
    assert told["alarms"]
    assert not any(told["alarms"].values())
    assert {found["case"] for found in told["rows"] if found["escaped"]} <= {found["case"] for found in stored["rows"] if found["escaped"]}


def test_a_case_that_does_not_exist_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bench", "faults", "four_bar", "--case", "origin_1m", "--out", str(tmp_path)]) != 0
    assert "no case or kind of mistake 'origin_1m'" in capsys.readouterr().err
