"""Command lines that the documentation shows, run: page by page, in order, in one empty folder together with the page's Python."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent.parent
PAGES = sorted([ROOT / "README.md", *(ROOT / "docs").rglob("*.md")])
_BLOCK = re.compile(
    r"(?P<note><!-- not run: [^>]+ -->\n)?^```(?P<language>console|python)[^\n]*\n(?P<text>.*?)^```$", re.MULTILINE | re.DOTALL
)
# Pages whose command lines are not run here, and why.
EXEMPT = {
    "README.md": "sets the machine up; its commands run on the other pages",
    "docs/index.md": "sets the machine up",
    "docs/how-to/use-a-model.md": "asks models",
    "docs/reference/cli.md": "a form, not a command",
}


def blocks(page: Path) -> list[tuple[str, str, int]]:
    """Return language, text and line of the blocks that are to be run."""
    text = page.read_text()
    return [(b["language"], b["text"], text[: b.start()].count("\n") + 1) for b in _BLOCK.finditer(text) if not b["note"]]


def name(page: Path) -> str:
    return page.relative_to(ROOT).as_posix()


RUN = [page for page in PAGES if name(page) not in EXEMPT and any(language == "console" for language, _, _ in blocks(page))]


@pytest.mark.parametrize("page", RUN, ids=name)
def test_the_command_lines_of_a_page_run(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tools = tmp_path / "tools"
    tools.mkdir()
    (tools / "articad").write_text(f'#!/bin/sh\nexec {sys.executable} -m articad.cli "$@"\n')
    (tools / "articad").chmod(0o755)
    work = tmp_path / "work"
    work.mkdir()
    (work / "examples").mkdir()
    for folder in (ROOT / "examples").iterdir():
        (work / "examples" / folder.name).symlink_to(folder)
    monkeypatch.chdir(work)
    monkeypatch.setenv("PATH", f"{tools}:{Path(sys.executable).parent}:{os.environ['PATH']}")
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    namespace: dict[str, object] = {"__name__": "__main__"}
    for language, text, line in blocks(page):
        if language == "python":
            exec(compile("\n" * line + text, str(page), "exec"), namespace)  # the newlines make a traceback name the page's own line
            continue
        done = subprocess.run(["bash", "-euo", "pipefail", "-c", text], capture_output=True, text=True, timeout=600, check=False)
        assert done.returncode == 0, f"{name(page)}:{line}\n{text}\n{done.stdout[-2000:]}\n{done.stderr[-3000:]}"


def test_exempt_pages_are_there_and_have_command_lines() -> None:
    for page in EXEMPT:
        assert any(language == "console" for language, _, _ in blocks(ROOT / page)), page
