"""The benchmark over recorded runs needs no model, and gives exactly the stored table."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from articad.agents.edit import edit
from articad.agents.llm import Scripted
from articad.agents.pipeline import generate
from articad.cli import main
from articad.runs.record import assembly_of
from tests.agents import stories

HERE = Path(__file__).parent
TASKS, RECORDINGS = HERE / "recorded", HERE.parent / "recordings"

pytestmark = pytest.mark.slow


def test_eight_recorded_tasks_give_the_stored_table_byte_for_byte(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = str(tmp_path / "out")
    assert main(["bench", "run", "--tasks", str(TASKS), "--recorded", str(RECORDINGS), "--out", out, "--at-once", "2", "-q"]) == 0
    capsys.readouterr()

    assert main(["bench", "table", out]) == 0
    assert capsys.readouterr().out == (TASKS / "table.txt").read_text(encoding="utf-8")
    assert main(["bench", "table", out, "--json"]) == 0
    assert capsys.readouterr().out == (TASKS / "table.json").read_text(encoding="utf-8")


def test_a_benchmark_s_own_folder_is_a_recording_edits_included(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    thicker = {"summary": "Thicker.", "touches": ["flap"], "changes": {"parts.flap.dimensions.thickness": 3}}
    quiet = {"look": False, "inspection": False, "kernel": stories.kernel(), "cache": stories.shared_cache()}
    run = generate("a flap", llm=stories.flap(), out=tmp_path / "before" / "flap" / "run_1", **stories.settings(**quiet))
    edited = edit(
        run,
        "thicker",
        llm=Scripted({"edit/1": json.dumps(thicker)}),
        out=tmp_path / "before" / "flap" / "edit_1_1",
        **stories.settings(**quiet),
    )
    assert assembly_of(edited).parts
    task = {
        "name": "flap",
        "kind": "articulated",
        "product": "flap",
        "prompt": "a flap",
        "checks": [{"kind": "parts", "number": [2, 2]}],
        "edits": [{"prompt": "thicker", "checks": [{"kind": "unchanged", "number": [1, 1]}]}],
        "reference": None,
    }
    (tmp_path / "tasks" / "flap").mkdir(parents=True)
    (tmp_path / "tasks" / "flap" / "task.json").write_text(json.dumps(task))

    asked = ["--tasks", str(tmp_path / "tasks"), "--recorded", str(tmp_path / "before"), "--no-look"]
    assert main(["bench", "run", *asked, "--out", str(tmp_path / "after"), "--json"]) == 0
    (row,) = json.loads(capsys.readouterr().out)["rows"]

    assert (row["passed"], row["edited"], row["calls"]) == (True, True, 5)
