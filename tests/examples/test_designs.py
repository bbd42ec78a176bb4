"""Nine designs whose requests were answered by a reader who knew the prompts alone, made again from the answers.

Of each run only the request, the answers, what was recalled, and the plan and checks it ended with are kept; everything else is made again here.
The answers are kept as they were given, so prompts that have changed since are reported as drift.
"""

from __future__ import annotations

import json
from pathlib import Path

import mujoco
import pytest

from articad.agents.pipeline import replay

DESIGNS = sorted(path.parent for path in (Path(__file__).resolve().parents[1] / "recordings").glob("*/request.json"))
IN_CI = ("stool", "pliers")

pytestmark = pytest.mark.slow


@pytest.mark.parametrize(
    "design", [pytest.param(path, marks=() if path.name in IN_CI else pytest.mark.soak, id=path.name) for path in DESIGNS]
)
def test_a_design_is_made_again_from_its_answers(design: Path, tmp_path: Path) -> None:
    again = replay(design, out=tmp_path / "run")

    kept_files = {str(path.relative_to(design)) for path in design.rglob("*.json")}
    assert not {name for name in again.results_that_differ if name in kept_files}
    assert (again.run.path / "plan.json").read_bytes() == (design / "plan.json").read_bytes()
    checks, kept = again.run.checks(), json.loads((design / "checks.json").read_text())
    assert checks is not None
    assert (checks["ok"], checks["findings"]) == (True, kept["findings"])
    (scene,) = (again.run.path / "export" / "mjcf").glob("*.xml")
    model = mujoco.MjModel.from_xml_path(str(scene))
    assert model.nbody > len(json.loads((design / "plan.json").read_text())["parts"]) / 2


def test_there_are_nine() -> None:
    assert len(DESIGNS) == 9
