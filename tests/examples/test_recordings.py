"""Recorded runs are made again without model, key or network, and come out the same."""

from __future__ import annotations

from pathlib import Path

import pytest

from articad.agents.pipeline import replay
from articad.run import Run

RECORDINGS = sorted(path.parent for path in (Path(__file__).resolve().parents[2] / "examples").glob("*/recording/request.json"))

pytestmark = pytest.mark.slow


def test_there_are_recordings() -> None:
    assert RECORDINGS


@pytest.mark.parametrize("recording", RECORDINGS, ids=lambda path: path.parent.name)
def test_a_recorded_run_is_made_again_byte_for_byte(recording: Path, tmp_path: Path) -> None:
    again = replay(recording, out=tmp_path / "run", strict=True)

    assert again.differences == ()
    assert str(again.findings) == "no findings"


@pytest.mark.parametrize("recording", RECORDINGS, ids=lambda path: path.parent.name)
def test_a_recorded_run_ends_with_every_check_passed(recording: Path) -> None:
    with Run.view(recording) as run:
        checks = run.checks()

    assert checks is not None
    assert checks["ok"] is True
    assert checks["findings"] == []
