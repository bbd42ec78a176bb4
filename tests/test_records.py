"""Records of a stranger's run: whatever is wrong with any value in any of them, each reader ends with an error of ours, in bounded memory."""

from __future__ import annotations

import json
import re
import traceback
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any
from unittest.mock import Mock

import pytest

import articad
from articad.agents.edit_base import Base
from articad.agents.recollection import remember
from articad.agents.review import scores, trajectory
from articad.assembly import Assembly
from articad.cli import main
from articad.commands.summaries import print_run
from articad.commands.terminal import Terminal
from articad.errors import ArticadError, PlanError, ReadError, RunError
from articad.findings import Finding
from articad.memory.case import Case
from articad.memory.experience import ExperienceStore
from articad.report.overlaps import drawn_overlaps
from articad.report.sections import all_sections, badges, facts_about, summary
from articad.runs.forms import FORMS, misfit
from articad.runs.record import assembly_report, documents_of, run_report
from articad.runs.run import Run, RunRequest, UserImage
from tests.chains import chain

RECORDINGS = Path(__file__).parent / "recordings"
WRONG: tuple[Any, ...] = (None, [], {}, "\ud800", 10**400)
_FINDING = {
    "code": "E_LIMIT",
    "severity": "error",
    "where": "joints.hinge1",
    "message": "m",
    "hint": "h",
    "parts": ["link0"],
    "value": 1.5,
    "limit": 1.0,
    "unit": "mm",
}
_PAIR = {
    "parts": ["link0", "link1"], "relation": "mating", "over": "rest", "strength": {"kind": "sampled", "poses": 3}, "volume_mm3": 1.0,
    "depth_mm": 0.5, "allowed_mm": 0.1, "gap_mm": None, "verdict": "overlap", "pose": {"hinge1": 0.1},
}  # fmt: skip
_REPORT = {"schema": "s", "ok": True, "findings": [_FINDING]}
_MOVED = _PAIR | {"over": ["hinge1"], "verdict": "clear"}
RECORDS: dict[str, dict[str, Any]] = {
    "checks.json": _REPORT | {"pairs": [_PAIR, _MOVED], "fits": [{"joint": "hinge1", "verdict": "free", "least_mm": 0.1, "play_mm": 0.2}]},
    "certificate.json": _REPORT
    | {
        "covers": "proven", "epsilon_mm": 0.1, "pairs": [_MOVED], "ranges": [{"joint": "hinge1", "free": [0, 1], "declared": [0, 1]}],
        "mechanism": {"joints": [{"freedoms": [{"name": "hinge1", "turn": [0, 0, 1]}]}]},
        "clearances": [{"parts": ["link0", "link1"], "relation": "x", "gap_mm": 1.0, "pose": {"hinge1": 0.1}, "strength": {"kind": "sampled", "poses": 2}}],
        "follows": [{"driver": "hinge1", "units": {"hinge1": "rad", "j1": "mm"}, "values": [0, 1], "followers": {"j1": [0, 1]}}],
    },
    "verdict.json": _REPORT | {"by": "judge", "round": 1, "rulings": {"motion": {"ok": True, "reason": "r"}}},
    "review.json": {"ok": True, "findings": [], "model": {"detail": {"score": 0.5}}, "lessons": ["l"]},
    "edit.json": _REPORT | {"changes": [{"where": "a", "before": 1, "after": 2}], "parts": {"link0": {"fate": "equal", "why": ""}}},
    "export/urdf/losses.json": _REPORT | {"files": {"a.urdf": 3}, "rows": [{"where": "hinge1", "kept": "k", "lost": "l"}]},
    "llm/design.1.json": {
        "key": "k", "step": "design/1", "messages": [{"role": "user", "content": [{"type": "text", "text": "t"}]}, {"role": "user", "content": "t"}],
        "reply": {"text": "t", "model": "m", "usage": {"input_tokens": 1, "output_tokens": 2}, "cost": 0.1, "fingerprint": None},
    },
    "base.json": {
        "prompt": "p", "kernel": "build123d", "plan": "{}", "scripts": {"a": "b"}, "files": {"a": {"b": "c"}}, "digests": {"a": {"b": "c"}},
        "meshes": {"a": "b"}, "requirements": None, "task": "build", "checks": {"findings": [_FINDING], "pairs": [_PAIR]},
    },
    "parts/link0/part.json": {"shape": {"mesh_sha256": "a"}, "digests": {"build": "b"}},
    "attempts/link0-1/outcome.json": {"findings": [_FINDING]},
}  # fmt: skip


@pytest.fixture(scope="module")
def assembly() -> Assembly:
    return chain(2)


@pytest.fixture
def folder(assembly: Assembly, tmp_path: Path) -> Path:
    """A run with every record that a reader uses."""
    with Run.create(
        RunRequest(prompt="p", options={"task": "build", "parameters": {"x": 1.0}, "kernel": "build123d"}), out=tmp_path / "run"
    ) as run:
        run.save_plan((Path(articad.__file__).parent / "starter" / "plan.json").read_text(), 0)
        run.save_assembly(assembly_report(assembly))
        run.trace("finding", where="x", code="W_BUILD_UNCHECKED", message="m", hint="h", severity="warning")
        run._append(b'{"event": "finding", "code": ["W_BUILD_UNCHECKED"], "where": {}}\n')
    for name, record in RECORDS.items():
        (tmp_path / "run" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "run" / name).write_text(json.dumps(record))
    (tmp_path / "run/parts/link0/script.py").write_text("def build(part): ...\n")
    return tmp_path / "run"


def places(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Yield the way to every value within a value."""
    yield path
    for key, each in value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ():
        yield from places(each, (*path, key))


def changed(record: Any, path: tuple[Any, ...], wrong: Any) -> Any:
    """Return a record with another value at a place."""
    if not path:
        return wrong
    copy = dict(record) if isinstance(record, dict) else list(record)
    copy[path[0]] = changed(copy[path[0]], path[1:], wrong)
    return copy


class _Forgetful(ExperienceStore):
    """A memory that keeps nothing: word vectors would take seconds."""

    def __init__(self) -> None: ...

    def add(self, *cases: Case) -> int:
        return len(cases)


def shown(assembly: Assembly, run: Run) -> None:
    """Read what the page of a run reads of its records; the rest of the page is made of the assembly."""
    documents = documents_of(run)
    all_sections(assembly, documents)
    badges(documents)
    summary(assembly, documents)
    for part in assembly.parts:
        facts_about(part, documents)
    drawn_overlaps(assembly, documents.checks, documents.certificate)


def readers(assembly: Assembly) -> dict[str, Callable[[Run], object]]:
    """Everything that reads records of a run that somebody else may have made."""
    return {
        "page": lambda run: shown(assembly, run),
        "report": lambda run: print_run(run_report(run), Terminal()),
        "base": Base.of,
        "memory": lambda run: remember(run, _Forgetful()),
        "scores": lambda run: (scores(run), trajectory(run), run.alternatives(), run.requirements()),
    }


READ_BY = {
    "assembly.json": ("report",),
    "certificate.json": ("page", "report"),
    "review.json": ("report", "memory"),
    "edit.json": ("report",),
    "export/urdf/losses.json": ("page", "report"),
    "llm/design.1.json": ("page", "scores"),
    "base.json": ("memory",),
    "parts/link0/part.json": ("base",),
    "attempts/link0-1/outcome.json": ("memory", "scores"),
}
"""Readers of the records that only some read, to save time."""


def faults(folder: Path, reading: Iterable[Callable[[Run], object]]) -> list[str]:
    """Return the errors that are not ours, with the place in articad."""
    found = []
    for read in reading:
        try:
            read(Run.view(folder))
        except ArticadError:
            pass
        except Exception as error:  # noqa: BLE001 - this is what is looked for
            frame = traceback.extract_tb(error.__traceback__)[-1]
            found.append(f"{Path(frame.filename).name}:{frame.lineno} {error!r}"[:150])
    return found


def test_every_record_of_this_test_and_of_real_runs_has_its_form() -> None:
    named = {"llm": "reply", "losses": "losses", "outcome": "attempt"}
    found = [*RECORDS.items()] + [
        (file.relative_to(RECORDINGS).as_posix(), json.loads(file.read_text())) for file in sorted(RECORDINGS.rglob("*.json"))
    ]
    judged = 0
    for name, record in found:
        kind = named.get(Path(name).parent.name) or named.get(Path(name).stem) or Path(name).stem
        if kind in FORMS:
            judged += 1
            assert misfit(record, FORMS[kind]) == "", name
    assert judged > 100


@pytest.mark.parametrize("name", ["request.json", "assembly.json", *RECORDS])
def test_a_wrong_value_anywhere_in_a_record_is_an_error_of_ours(
    name: str, folder: Path, assembly: Assembly, capsys: pytest.CaptureFixture[str]
) -> None:
    whole = json.loads((folder / name).read_text())
    known = readers(assembly)
    assert faults(folder, known.values()) == []
    reading = [known[reader] for reader in READ_BY.get(name, known)]
    wrong: list[Any] = [changed(whole, path, value) for path in places(whole) for value in WRONG]
    wrong += [without(whole, path) for path in places(whole) if path]
    found = set()
    for record in wrong:
        (folder / name).write_text(json.dumps(record))
        found |= set(faults(folder, reading))
    assert sorted(found) == []
    capsys.readouterr()


def without(record: Any, path: tuple[Any, ...]) -> Any:
    """Return a record without the value at a place."""
    copy = dict(record) if isinstance(record, dict) else list(record)
    if len(path) == 1:
        del copy[path[0]]
    else:
        copy[path[0]] = without(copy[path[0]], path[1:])
    return copy


@pytest.mark.parametrize("name", ["request.json", "plan.json", "assembly.json", *RECORDS])
@pytest.mark.parametrize("content", [b"\xff", b"{", b"[]", b"{}"], ids=["bytes", "no JSON", "a list", "empty"])
def test_each_error_of_a_record_says_what_to_do(name: str, content: bytes, folder: Path, assembly: Assembly) -> None:
    (folder / name).write_bytes(content)
    found = [finding for read in readers(assembly).values() for finding in findings(read, folder)]
    hints = {finding.hint for finding in found if finding.code in {"E_READ", "E_RUN"}}
    assert all(re.search(r"articad (certify|export|build) |undamaged copy|Save it as", hint) for hint in hints), hints
    assert hints or name in {"plan.json", "parts/link0/part.json"} or content == b"{}"


def findings(read: Callable[[Run], object], folder: Path) -> list[Finding]:
    """Return what the error of a reader says; nothing if it reads."""
    try:
        read(Run.view(folder))
    except ArticadError as error:
        return [*error.findings]
    return []


def test_a_page_tries_a_bounded_number_of_overlaps_that_somebody_states(assembly: Assembly, monkeypatch: pytest.MonkeyPatch) -> None:
    tried = Mock(return_value=[])
    monkeypatch.setattr("articad.report.overlaps.overlap_meshes", tried)
    drawn_overlaps(assembly, {"pairs": [_PAIR | {"pose": {"hinge1": k / 1e5}} for k in range(1000)]})
    assert 16 <= tried.call_count <= 32
    assert drawn_overlaps(assembly, {"pairs": [_PAIR | {"pose": {"hinge1": 1e9}}]}) == []


def test_a_picture_that_is_named_many_times_is_read_not_even_once(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    request = json.loads((folder / "request.json").read_text()) | {"images": [{"file": "images/1.png"}] * 400}
    (folder / "request.json").write_text(json.dumps(request))
    monkeypatch.setattr(UserImage, "read", None)
    with pytest.raises(RunError, match="400 times"):
        Run.view(folder)


def test_pictures_are_bounded_together_before_and_after_they_are_recorded(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (folder / "images").mkdir()
    for number in range(9):
        (folder / f"images/{number}.png").write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(1000))
    request = json.loads((folder / "request.json").read_text()) | {"images": [{"file": f"images/{number}.png"} for number in range(9)]}
    (folder / "request.json").write_text(json.dumps(request))
    assert len(Run.view(folder).request.images) == 9
    monkeypatch.setattr("articad.runs.run._IMAGES_LIMIT", 5000)
    with pytest.raises(ReadError, match="together"):
        Run.view(folder)
    with pytest.raises(ReadError, match="together"):
        RunRequest(prompt="x", images=(UserImage.read(folder / "images/1.png"),) * 9)


@pytest.mark.parametrize("text", ['{"a": [' + "[]," * 2_500_000 + "1]}", " " * ((64 << 20) + 1)], ids=["values", "size"])
def test_a_record_of_more_values_or_bytes_than_any_run_has_is_not_parsed(text: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (folder / "checks.json").write_text(text)
    run = Run.view(folder)
    monkeypatch.setattr("articad.runs.run.json.loads", None)
    with pytest.raises(ReadError, match=r"values|larger"):
        run.checks()


def test_replies_are_bounded_together(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for number in range(2, 6):
        (folder / f"llm/design.{number}.json").write_bytes((folder / "llm/design.1.json").read_bytes())
    assert len(Run.view(folder).talks()) == 5
    monkeypatch.setattr("articad.runs.run._JSON_VALUES", 100)
    run = Run.view(folder)
    for _ in range(20):  # the same record again weighs nothing more
        run.reply("design/1")
    with pytest.raises(ReadError, match="values"):
        run.talks()


def test_a_trace_of_endless_lines_is_read_up_to_a_bound(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("articad.runs.run._LINES", 3)
    (folder / "trace.jsonl").write_bytes(b'{"a": "\xe2\x80\xa8"}\n' + b'{"a": "' + b"x" * (1 << 20) + b'"}\n' + b"3\n" + b'{"a": 1}\n')
    assert list(Run.view(folder).events()) == [{"a": "\u2028"}]


@pytest.mark.parametrize("content", [b"\xff\xfe{", b" " * ((16 << 20) + 1)], ids=["no text", "size"])
def test_a_plan_of_a_run_that_is_no_text_or_too_large_is_an_error_of_ours(content: bytes, folder: Path) -> None:
    (folder / "plan.json").write_bytes(content)
    with pytest.raises(ReadError):
        Run.view(folder).plan_text()


LISTS = b'{"items": [' + b"[]," * 3_200_000 + b"1]}"


@pytest.mark.parametrize(
    ("line", "worker"),
    [
        ("verify-certificate FILE", "articad.certificates.verifier.json.loads"),
        ("memory import FILE --memory store", "articad.memory.experience.ExperienceStore.import_lines"),
        ("check FILE", "articad.plan.beyond.json.loads"),
    ],
)
def test_no_command_works_on_a_text_that_has_more_values_than_any_real_one(
    line: str, worker: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Two characters are a value of up to 80 bytes: files of 15 to 90 MB took 1 to 2 GB and a minute."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "plan.json").write_bytes(LISTS)
    if line.startswith("check"):  # its form is checked all the same
        refusal = PlanError("no plan", findings=[Finding(code="E_SCHEMA", where="a", message="m", hint="h")])
        monkeypatch.setattr("articad.plan.schema.AssemblyPlan.load", Mock(side_effect=refusal))
    monkeypatch.setattr(worker, Mock(side_effect=AssertionError("it works on it")))
    assert main(line.replace("FILE", "plan.json").split()) in {1, 3}
    said = capsys.readouterr()
    assert "works on it" not in said.err + said.out
