"""Second solutions: products that somebody made of the text of a task alone, in another construction than the reference.

A check that refuses one refuses what the text allows. Each is a folder of `tests/bench/second`, named after its task, with `plan.json` and
`parts/`; it was made without a look at the reference or at the rows of `task.json`. Where the task has edits, `edits.json` may say
which parameters of the plan make each: `[{"throw": 28}]`.
"""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Final

import pytest

from articad.assembly import Assembly
from articad_bench.reference import given, reference
from articad_bench.subject import Subject
from articad_bench.task import TASKS, tasks_in
from articad_bench.unsaid import Format
from tests.bench.forms import FORMS, as_file, refused, sayable
from tests.bench.test_invariance import rested

SECOND: Final = Path(__file__).with_name("second")
ALL: Final = {task.name: (folder, task) for folder, task in tasks_in(TASKS)}
IN_CI: Final = frozenset[str]()
NAMES: Final = [
    pytest.param(folder.name, marks=() if folder.name in IN_CI else pytest.mark.soak)
    for folder in sorted(SECOND.iterdir())
    if folder.is_dir()
]
BEGUN_WITH_NOTHING: Final = [name for name in NAMES if ALL[str(name.values[0])][1].given is None]
EDITED: Final = sorted(file.parent.name for file in SECOND.glob("*/edits.json"))


@cache
def second(name: str) -> Assembly:
    """Build a second solution as a reference is built: of a repair it holds what it changes, and the rest is the given product's."""
    folder, task = ALL[name]
    return reference(folder, task.model_copy(update={"reference": str(SECOND / name)}))


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_a_second_solution_passes_every_check(name: str) -> None:
    folder, task = ALL[name]
    wrong = [str(judged) for judged in task.judge(Subject(second(name), before=given(folder, task))) if not judged.ok]

    assert wrong == []


@pytest.mark.slow
@pytest.mark.parametrize("name", BEGUN_WITH_NOTHING)
def test_it_is_another_construction(name: str) -> None:
    """Most of its solids are not those of the reference. A repair keeps what it may, so it is not asked for another construction."""
    theirs = {part.mesh.digest for part in reference(*ALL[name]).parts.values() if part.mesh is not None}
    ours = [part.mesh.digest for part in second(name).parts.values() if part.mesh is not None]

    assert sum(digest in theirs for digest in ours) < len(ours) / 2


@pytest.mark.slow
@pytest.mark.parametrize("name", [pytest.param(name, marks=pytest.mark.soak) for name in EDITED])
def test_it_makes_the_edits(name: str) -> None:
    edits, (_, task) = json.loads((SECOND / name / "edits.json").read_text(encoding="utf-8")), ALL[name]
    before = second(name)
    assert len(edits) == len(task.edits)
    for stage, values in enumerate(edits, start=1):
        after = before.with_parameters(**values)
        assert [str(judged) for judged in task.judge(Subject(after, before=before), stage) if not judged.ok] == []
        before = after


@pytest.mark.slow
@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("name", NAMES)
def test_it_passes_as_a_file_of_another_tool(name: str, form: Format, tmp_path: Path) -> None:
    """What a task begins with is a file of that tool, too: it writes the meshes of both."""
    folder, task = ALL[name]
    assembly, begun = rested(second(name)), given(folder, task)
    before = None if begun is None else as_file(rested(begun), form, tmp_path / "given")

    assert refused(sayable(task, assembly, form), Subject(as_file(assembly, form, tmp_path / "mended"), before=before)) == []
