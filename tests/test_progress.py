"""Whatever may take seconds shows that it works: its command opens a line of progress around it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path

import pytest

from articad.cli import main
from articad.commands.terminal import Terminal
from articad.errors import ArticadError
from articad.report import Documents

SLOW = {
    "audit a.urdf": "articad.auditing.examine.audit_file",
    "audit run": "articad.auditing.examine.audit_made",
    "sim a.urdf": "articad.simulation.examine.simulate_file",
    "sim run": "articad.simulation.examine.simulate_assembly",
    "convert a.urdf b.xml": "articad.formats.convert",
    "render a.urdf": "articad.render.files.write_views",
    "export run --to urdf": "articad.runs.record.record_export",
    "verify-certificate certificate.json": "articad.certificates.verifier.verify_file",
    "show run": "articad.runs.record.record_page",
}


@pytest.mark.parametrize("line", SLOW)
def test_a_command_says_that_it_works(line: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shown: list[str] = []

    @contextmanager
    def progress(_: Terminal, title: str, *_more: object, **_named: object) -> Iterator[object]:
        shown.append(title)
        yield lambda *_words: None
        shown.pop()

    def slow(*_: object, **__: object) -> None:
        raise ArticadError(f"shown: {shown}", stage="test")

    for name in ("auditing", "pictures", "showing"):
        monkeypatch.setattr(f"articad.commands.{name}.loaded", lambda *_: None)
    for name in ("view", "open"):
        monkeypatch.setattr(f"articad.runs.run.Run.{name}", lambda *_: nullcontext())
    for name, given in (("assembly_of", None), ("documents_of", Documents())):
        monkeypatch.setattr(f"articad.runs.record.{name}", lambda *_, given=given, **__: given)
    monkeypatch.setattr(Terminal, "progress", progress)
    monkeypatch.setattr(SLOW[line], slow)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "run").mkdir()
    for file in ("a.urdf", "certificate.json", "run/request.json"):
        (tmp_path / file).write_text("{}")
    said: list[str] = []
    monkeypatch.setattr(Terminal, "error", lambda _, error: said.append(error.message))
    main(line.split())
    assert len(said) == 1
    assert said[0].startswith("shown: ['")
