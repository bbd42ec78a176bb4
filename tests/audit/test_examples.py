"""Our own examples stand before the auditor like anyone's: the assembly without any finding, its URDF and MJCF without error or warning."""

from __future__ import annotations

from pathlib import Path

import pytest

from articad.assembly import Assembly
from articad.audit.examine import Choices, audit, audit_assembly
from articad.export.mjcf import write_mjcf
from articad.export.urdf import write_urdf
from articad.plan.schema import AssemblyPlan

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = sorted(path.parent for path in (ROOT / "examples").glob("*/plan.json"))
NOTES = {
    "I_AUDIT_BASE",
    "I_AUDIT_ZERO_OUTSIDE",
    "I_AUDIT_CARRIERS",
}  # of frames and ranges that a plan chooses, and of what URDF cannot say

pytestmark = [pytest.mark.engines, pytest.mark.slow]


def test_there_are_examples() -> None:
    assert len(EXAMPLES) >= 11


@pytest.mark.parametrize("folder", EXAMPLES, ids=lambda folder: folder.name)
def test_an_example_has_no_finding(folder: Path, tmp_path: Path) -> None:
    assembly = Assembly.from_plan(AssemblyPlan.load(folder), folder / "parts")

    found = audit_assembly(assembly, folder.name, "plan")
    assert str(found.findings) == "no findings"

    for bundle in (write_urdf(assembly), write_mjcf(assembly)):
        bundle.write(tmp_path)
        exported = audit(tmp_path / bundle.main, Choices(motion=False))  # the motion of the same solids has just been looked at
        assert exported.ok, str(exported.findings)
        assert set(exported.findings.codes) <= NOTES
        assert all(loading.loads in {True, None} for loading in exported.engines)
