"""What the documentation shows, runs: every Python block of a page, in order, in one namespace; every link leads somewhere.

Pages with command lines are run as a whole by `test_console`.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.docs import test_console

ROOT = Path(__file__).resolve().parent.parent.parent
PAGES = sorted([ROOT / "README.md", *(ROOT / "docs").rglob("*.md")])
_BLOCK = re.compile(r"^```(?P<language>[\w-]+)[^\n]*\n(?P<text>.*?)^```$", re.MULTILINE | re.DOTALL)
_LINK = re.compile(r"\]\((?!https?://|#)(?P<path>[^)#\s]+)")


def python_blocks(page: Path) -> list[tuple[int, str]]:
    """Return each Python block of a page with the line that it begins at."""
    text = page.read_text()
    return [(text[: found.start()].count("\n") + 1, found["text"]) for found in _BLOCK.finditer(text) if found["language"] == "python"]


@pytest.mark.parametrize(
    "page", [page for page in PAGES if python_blocks(page) and page not in test_console.RUN], ids=lambda page: str(page.relative_to(ROOT))
)
def test_the_python_blocks_of_a_page_run(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    namespace: dict[str, object] = {"__name__": "__main__"}
    for line, block in python_blocks(page):
        code = compile("\n" * line + block, str(page), "exec")  # the newlines make a traceback name the page's own line
        exec(code, namespace)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_between_pages_lead_somewhere(page: Path) -> None:
    for found in _LINK.finditer(page.read_text()):
        live = re.fullmatch(r"live/(\w+)\.html", found["path"])  # made with the site by scripts/live_pages.py
        target = page.parent / found["path"] if live is None else ROOT / "examples" / live[1] / "plan.json"
        assert target.exists(), found["path"]
