"""What a document offers for editing is live: FreeCAD then shows what `--set` gives. What cannot follow is read-only and says so."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest

import articad as ac
from articad.export.freecad import write_freecad, write_freecad_alone
from articad.export.freecad_job import Job
from tests.freecad import cupboard, opened

pytestmark = [pytest.mark.freecad, opened.needs_freecad]
EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
NAMES = sorted(path.parent.name for path in EXAMPLES.glob("*/plan.json"))


@cache
def assembly(name: str) -> ac.Assembly:
    return ac.build(ac.AssemblyPlan.load(EXAMPLES / name / "plan.json"), EXAMPLES / name / "parts")


@pytest.mark.parametrize("name", NAMES)
def test_every_value_that_can_be_edited_over_frozen_shapes_gives_what_set_gives(name: str, tmp_path: Path) -> None:
    made = assembly(name)
    bundle = write_freecad_alone(made)
    plan = made.resolved.plan if made.resolved is not None else None
    assert plan is not None
    values = {row.name: float(row.value) for row in plan.parameters if not isinstance(row.value, str)}
    live = [row["name"] for row in Job(made, tmp_path, features=False).to_json()["parameters"] if row["live"] and row["name"] in values]
    moves: list[tuple[str, float]] = []
    wanted: list[ac.Assembly] = []
    for parameter in live:
        for value in (values[parameter] * 1.04 + 0.01, values[parameter] * 0.97 - 0.01):
            try:
                wanted.append(made.with_parameters(**{parameter: value}))
            except ac.ArticadError:
                continue  # beyond its bounds: nothing to compare with
            moves.append((parameter, value))
    steps = [{"do": "set", "values": values | {parameter: value}} for parameter, value in moves]
    before, *looks = opened.steps(bundle.files[bundle.main], {"do": "look"}, *steps)
    label = next((label for label in before["editable"] if label.startswith("Parameters")), "")
    assert {label: offered for label, offered in before["editable"].items() if offered} == (
        {label: sorted(f"p_{p}" for p in live)} if live else {}
    )
    for group, why, editable in before["parameters"].values():
        assert editable == (group == "Parameters") == ("Fixed: " not in why)
    for (parameter, value), look, expected in zip(moves, looks, wanted, strict=True):
        assert look["invalid"] == [], parameter
        mm, rad = opened.moved(dict(expected.at()), opened.frames(look["parts"]))
        assert opened.small((mm, rad), 1e-6, 1e-8), f"{parameter} = {value}: {mm} mm, {rad} rad"
        for part in expected.parts.values():
            assert part.solid is not None
            assert look["volumes"][part.name] == pytest.approx(part.solid.volume, rel=1e-6), f"{parameter} = {value}: {part.name}"
            assert part.mass is None or look["masses"][part.name] == pytest.approx(part.mass.mass, rel=1e-6), part.name
            for connector, frame in opened.frames(look["connectors"][part.name]).items():
                assert frame.allclose(part.connectors[connector].frame, mm=1e-6, rad=1e-9), (
                    f"{parameter} = {value}: {part.name}.{connector}"
                )


def test_values_over_feature_trees_move_volumes_and_masses() -> None:
    plan, bundle = cupboard.plan(), write_freecad(cupboard.assembly())
    values = {row.name: float(row.value) for row in plan.parameters if not isinstance(row.value, str)}
    before, after = opened.steps(bundle.files[bundle.main], {"do": "look"}, {"do": "set", "values": {"width": values["width"] * 1.1}})
    assert before["editable"]["Parameters"] == sorted(f"p_{name}" for name in values)
    changed = {name for name, volume in before["volumes"].items() if abs(after["volumes"][name] / volume - 1.0) > 1e-6}
    assert changed
    for name, volume in before["volumes"].items():
        assert after["masses"][name] / before["masses"][name] == pytest.approx(after["volumes"][name] / volume, rel=1e-9), name
    rows = {row[1]: row for row in after["bill"][1:]}
    for name in changed & rows.keys():
        assert float(rows[name][4].split()[0]) == pytest.approx(after["masses"][name], rel=1e-9), name
    assert sum(int(row[2]) for row in rows.values()) == len(before["parts"])
