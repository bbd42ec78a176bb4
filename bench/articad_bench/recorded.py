"""Recorded answers: the benchmark runs again without model, key or network, and makes the same table."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from articad.agents.llm import LLM, Replay
from articad.agents.settings import RunOptions
from articad.errors import ReadError
from articad_bench.scoring import model_of, stage_name
from articad_bench.task import Task


def as_recorded(options: RunOptions, llm: LLM) -> RunOptions:
    """Return options with which a model is asked just what a recording answers; the same options for any other model."""
    if not isinstance(llm, Replay):
        return options
    stated = llm.run.request.options
    return replace(options, look=options.look and stated.get("look", False), together=stated.get("together", 1))


class RecordedAnswers:
    """Answers as recorded: `<folder>/<task>` is a run, or holds `run_…`, `edit_1_…` and so on, as a benchmark's own folder does.

    A prompt that differs from the recorded one is answered; a step that was not recorded is not.
    """

    def __init__(self, folder: str | Path) -> None:
        self._folder = Path(folder)

    def of(self, task: Task) -> LLM:
        """Return who answers a task's requests.

        Raises:
            ReadError: If it was not recorded.
        """
        return self._replay(task.name)

    def of_edit(self, task: Task, number: int) -> LLM:
        """Return who answers those of one of its edits, counted from 1."""
        return self._replay(stage_name(task, number))

    def _replay(self, name: str) -> Replay:
        found = model_of(name, self._folder)
        if not found.is_dir():
            raise ReadError.at(found, f"{found} is not a recorded run.", "Name the folder of a benchmark's runs.")
        return Replay(found)
