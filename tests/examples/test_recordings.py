"""Recorded runs are made again without model, key or network, and come out the same."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from articad.agents.pipeline import replay
from articad.runs.run import Run
from tests.freecad.opened import needs_freecad

RECORDINGS = sorted(path.parent for path in (Path(__file__).resolve().parents[2] / "examples").glob("*/recording/request.json"))
OF_FREECAD = [path for path in RECORDINGS if '"kernel": "freecad"' in (path / "request.json").read_text()]
MADE = [pytest.param(path, marks=[pytest.mark.freecad, needs_freecad] if path in OF_FREECAD else []) for path in RECORDINGS]

pytestmark = pytest.mark.slow


def test_there_are_recordings() -> None:
    assert RECORDINGS
    assert OF_FREECAD
    assert len(OF_FREECAD) < len(RECORDINGS)


@pytest.mark.parametrize("recording", MADE, ids=lambda path: path.parent.name)
def test_a_recorded_run_is_made_again_byte_for_byte(recording: Path, tmp_path: Path) -> None:
    again = replay(recording, out=tmp_path / "run")

    # Prompts may have changed since the run was recorded: each such step is reported, and only its reply is used.
    told = {finding.where for finding in again.findings}
    assert {finding.code for finding in again.findings} <= {"I_PROMPT_DRIFT"}
    assert {name for name in again.differences if not name.startswith("llm/")} == set()
    assert {"llm." + reply["step"] for reply in _replies(recording, again.differences)} == told


def _replies(recording: Path, names: tuple[str, ...]) -> list[dict[str, str]]:
    return [json.loads((recording / name).read_text()) for name in names]


@pytest.mark.parametrize("recording", RECORDINGS, ids=lambda path: path.parent.name)
def test_a_recorded_run_ends_with_every_check_passed(recording: Path) -> None:
    with Run.view(recording) as run:
        checks = run.checks()

    assert checks is not None
    assert checks["ok"] is True
    assert checks["findings"] == []
