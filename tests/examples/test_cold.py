"""Sixteen products as readers designed them who knew the prompts alone: built again from their plans and scripts, and examined as a run does.

`docs/explanation/cold-designs.md` says how they were requested, and which mistakes were planted in eight of them. Here are their last plans and scripts.
"""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

from articad.agents.evidence import examine
from articad.assembly import Assembly
from articad.kernels.choice import kernel_named
from articad.plan.schema import AssemblyPlan

ROOT = Path(__file__).resolve().parents[2]
DESIGNS = sorted(path.parent for path in (ROOT / "tests" / "recordings" / "cold").glob("*/plan.json"))
PAGE = (ROOT / "docs" / "explanation" / "cold-designs.md").read_text(encoding="utf-8")
IN_CI = ("pliers",)


def kernel_of(design: Path) -> str:
    return "freecad" if list((design / "parts").glob("*.freecad.py")) else "build123d"


def marks(design: Path) -> list[Any]:
    if kernel_of(design) == "freecad":
        return [pytest.mark.freecad, pytest.mark.soak]
    return [] if design.name in IN_CI else [pytest.mark.soak]


@pytest.mark.parametrize("design", [pytest.param(path, marks=marks(path), id=path.name) for path in DESIGNS])
def test_a_design_has_no_error_and_nothing_that_somebody_must_answer(design: Path) -> None:
    assembly = Assembly.from_plan(AssemblyPlan.load(design), design / "parts", kernel=kernel_named(kernel_of(design)))
    evidence = examine(assembly)

    assert evidence.ok, evidence.findings
    assert not evidence.faults_of_joints
    assert not [finding for finding in assembly.findings if finding.code in {"W_RADIUS_MISTAKEN", "W_CONNECTOR_FEATURE", "W_PART_SCALE"}]


def test_the_page_states_what_these_designs_are() -> None:
    rows = dict(re.findall(r"^\| `(\w+)` \|(.*)\|$", PAGE, re.MULTILINE))
    assert rows.keys() == {design.name for design in DESIGNS}
    assert len(rows) == 16
    for design in DESIGNS:
        plan = json.loads((design / "plan.json").read_text())
        kernel, parts, joints, loops, *_ = (cell.strip() for cell in rows[design.name].split("|"))
        scripts = len(list((design / "parts").glob("*.py")))
        assert kernel == {"freecad": "FreeCAD", "build123d": "build123d"}[kernel_of(design)]
        assert parts == f"{len(plan['parts'])} ({scripts})"
        assert int(joints) == len(plan["joints"])
        assert int(loops or 0) == len(plan["joints"]) - len(plan["parts"]) + 1
