"""Our own examples are audited like any other file, as a plan, as URDF and as MJCF: there is no finding, not even a note."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from articad.assembly import Assembly
from articad.auditing.examine import AuditOptions, audit_assembly, audit_file
from articad.export.mjcf import write_mjcf
from articad.export.urdf import write_urdf
from articad.importers.urdf import read_urdf
from articad.kinematics import declare
from articad.plan.schema import AssemblyPlan
from tests.assemblies import block, frame

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = sorted(path.parent for path in (ROOT / "examples").glob("*/plan.json"))

LONG = {"stewart_platform", "table_football"}  # for the long run, `-m soak`: they take as long as the other nine

pytestmark = pytest.mark.engines


def test_there_are_examples() -> None:
    assert len(EXAMPLES) >= 11


@pytest.mark.slow
@pytest.mark.parametrize(
    "folder", [pytest.param(path, id=path.name, marks=[pytest.mark.soak] if path.name in LONG else []) for path in EXAMPLES]
)
def test_an_example_has_no_finding(folder: Path, tmp_path: Path) -> None:
    assembly = Assembly.from_plan(AssemblyPlan.load(folder), folder / "parts")

    found = audit_assembly(assembly, folder.name, "plan")
    assert str(found.findings) == "no findings"

    for bundle in (write_urdf(assembly), write_mjcf(assembly)):
        bundle.write(tmp_path)
        exported = audit_file(tmp_path / bundle.main)
        assert str(exported.findings) == "no findings"
        assert exported.motion == "sampled"
        assert all(loading.loads in {True, None} for loading in exported.engines)


# ---------------------------------------------------------------------- frames that are stated, and frames that are not

NOTES = {"I_AUDIT_BASE", "I_AUDIT_ZERO_OUTSIDE"}
STILL = AuditOptions(engines=False, motion=False)


def lid(folder: Path) -> Path:
    """A box whose origin is in its middle, with a lid that is never quite closed, exported."""
    base, flap = block("base", pin=frame(at=(0, 0, 20.5))), block("flap", (20, 30, 2), pin=frame(at=(0, 0, -1.5)))
    hinge = declare.revolute("hinge", base["pin"], flap["pin"], limits=(0.5, 1.0), rest=0.7)
    bundle = write_urdf(Assembly.from_parts("lid", parts=[base, flap], joints=[hinge], ground="base"))
    bundle.write(folder)
    return folder / bundle.main


def notes(path: Path) -> set[str]:
    return set(audit_file(path, STILL).findings.codes) & NOTES


def test_an_export_states_its_frames(tmp_path: Path) -> None:
    assert notes(lid(tmp_path)) == set()


def test_the_same_file_without_records_or_with_stale_ones_does_not(tmp_path: Path) -> None:
    path = lid(tmp_path)
    text = path.read_text()

    path.write_text(re.sub(r"<articad.*?</articad>", "", text))
    assert notes(path) == NOTES
    path.write_text(text.replace('lower="0.5"', 'lower="0.6"'))
    assert notes(path) == NOTES


def test_nor_does_a_foreign_file_that_was_converted(tmp_path: Path) -> None:
    path = lid(tmp_path)
    path.write_text(re.sub(r"<articad.*?</articad>", "", path.read_text()))
    bundle = write_urdf(read_urdf(path))
    bundle.write(tmp_path / "converted")
    converted = tmp_path / "converted" / bundle.main

    assert notes(converted) == NOTES
    assert read_urdf(converted).foreign
    assert not read_urdf(lid(tmp_path / "own")).foreign
