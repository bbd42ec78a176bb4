"""Every example is certified over all its joints within the default budget, and the checker accepts what it says."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from articad.assembly import Assembly
from articad.certificates.verifier import verify_file
from articad.plan.schema import AssemblyPlan

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
QUICK = ("four_bar",)
OTHERS = sorted(folder.name for folder in EXAMPLES.iterdir() if (folder / "plan.json").exists() and folder.name not in QUICK)

pytestmark = [pytest.mark.slow]


@pytest.mark.parametrize("name", [*QUICK, *(pytest.param(name, marks=pytest.mark.soak) for name in OTHERS)])
def test_an_example_is_certified_and_the_checker_accepts_it(name: str, tmp_path: Path) -> None:
    plan = AssemblyPlan.load(EXAMPLES / name)
    certificate = Assembly.from_plan(plan, EXAMPLES / name / "parts").certify()

    assert certificate.ok, str(certificate.findings)
    for file, content in certificate.mesh_files().items():
        (tmp_path / file).write_bytes(content)
    (tmp_path / "certificate.json").write_text(json.dumps(certificate.to_json()))
    assert verify_file(tmp_path / "certificate.json", tmp_path) == []
