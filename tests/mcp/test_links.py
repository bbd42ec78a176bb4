"""Links inside the root of the tools: nothing outside is read or written, and no first words of it come back."""

from __future__ import annotations

import inspect
import json
from pathlib import Path
from typing import Any

import pytest
from mcp.server.mcpserver.exceptions import ToolError

from articad import examples
from articad.errors import ReadError
from articad.mcp.server import Tools, _told, make_server
from articad.mcp.workbench import Workbench
from tests.coroutines import finish

SECRET = "the-first-word-of-a-secret 1 2 3"


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """Return a root with one sound design, and a secret beside it."""
    (tmp_path / "secret").write_text(SECRET)
    folder = tmp_path / "root" / "box"
    (folder / "parts").mkdir(parents=True)
    (folder / "plan.json").write_bytes((examples.folder("wardrobe") / "plan.json").read_bytes())
    return tmp_path / "root"


class Deaf:
    """A client that asked for no progress."""

    async def report_progress(self, *_progress: Any) -> None:
        """Hear nothing."""


async def asked(root: Path, tool: str, arguments: dict[str, Any]) -> Any:
    method = getattr(Tools(root), tool)
    context = {"context": Deaf()} if "context" in inspect.signature(method).parameters else {}
    return await _told(method)(**context, **arguments)


def told(root: Path, tool: str, **arguments: Any) -> str:
    """Return all that a tool says, an error or not."""
    try:
        return str(finish(asked(root, tool, arguments)))
    except ToolError as error:
        return str(error)


CALLS: dict[str, dict[str, Any]] = {
    "schema": {"topic": "NAMED"},
    "check_plan": {"design": "NAMED"},
    "edit_plan": {"design": "NAMED", "changes": {"name": "x"}},
    "build_part": {"design": "NAMED", "part": "lid", "script": "x = 1"},
    "build_parts": {"design": "NAMED", "files": {"lid": "bad/plan.json"}},
    "build": {"design": "NAMED"},
    "check": {"design": "NAMED"},
    "certify": {"design": "NAMED", "budget_s": 1.0},
    "verify_certificate": {"design": "NAMED"},
    "audit": {"design": "NAMED"},
    "sim": {"design": "NAMED"},
    "render": {"design": "NAMED"},
    "export": {"design": "NAMED", "formats": ["urdf"]},
    "manual": {"design": "NAMED"},
    "convert": {"source": "NAMED", "target": "other.xml"},
    "adopt": {"source": "NAMED", "design": "adopted"},
    "edit_parameters": {"design": "NAMED", "values": {"width": 900.0}},
    "explain": {"code": "NAMED"},
    "docs": {"dialect": "build123d", "intent": "NAMED"},
}
"""A call of each tool that is asked about a design or a file which is, or holds, a link out of the root."""


def test_each_tool_has_a_call() -> None:
    async def names() -> set[str]:
        return {tool.name for tool in await make_server(".").list_tools()}

    assert finish(names()) == set(CALLS)


@pytest.mark.parametrize("tool", CALLS)
def test_a_linked_design_or_file_is_refused_and_tells_nothing(tool: str, root: Path) -> None:
    """The plan, the folder, the run, the scripts' folder or the file itself is a link; no link is written through either."""
    secret, away = root.parent / "secret", root.parent / "away"
    (away / "parts").mkdir(parents=True)
    (away / "plan.json").write_text(SECRET)
    for name in ("plan", "within"):
        (root / name).mkdir()
        (root / name / "plan.json").write_bytes((root / "box" / "plan.json").read_bytes())
    (root / "plan" / "plan.json").unlink()
    (root / "plan" / "plan.json").symlink_to(secret)
    (root / "within" / "run").symlink_to(away)
    (root / "within" / "parts").symlink_to(away / "parts")
    (root / "within" / "papers").symlink_to(away)
    (root / "bad").symlink_to(away)
    (root / "bad.urdf").symlink_to(secret)
    (root / "other.xml").symlink_to(secret)
    before = {path: path.read_bytes() for path in root.parent.rglob("*") if path.is_file() and not path.is_relative_to(root)}
    for named in ("plan", "within", "bad", "bad.urdf", "../secret", "bad/plan.json", "box\0", "box/\0/../../secret", "x" * 5000):
        arguments = {key: named if value == "NAMED" else value for key, value in CALLS[tool].items()}
        answer = told(root, tool, **arguments)
        assert "the-first-word" not in answer, named
        assert "Traceback" not in answer, named
        assert named == "within" or '"ok":true' not in answer.replace(" ", ""), named  # its plan is sound
    after = {path: path.read_bytes() for path in root.parent.rglob("*") if path.is_file() and not path.is_relative_to(root)}
    assert before == after


def test_the_page_of_a_linked_design_is_refused(root: Path) -> None:
    """A resource of the server, by a name that the host gives."""
    (root / "plan").mkdir()
    (root / "plan" / "plan.json").symlink_to(root.parent / "secret")
    (root / "bad").symlink_to(root.parent)
    for named in ("plan", "bad", "../secret", "box/../../secret", "bad/plan.json", "--sandbox=weak", "", "box\0"):
        with pytest.raises(ReadError):
            finish(Workbench(root).page(named))


def test_a_linked_script_is_not_read(root: Path) -> None:
    plan = json.loads((root / "box" / "plan.json").read_text())
    part = next(name for name, entry in ((part["name"], part) for part in plan["parts"]) if "derived" not in entry)
    (root / "box" / "parts" / f"{part}.py").symlink_to(root.parent / "secret")

    async def build() -> Any:
        tools = Tools(root)
        return await tools.bench.run("part", on=[str(root / "box"), part], seconds=60.0)

    assert "the-first-word" not in json.dumps(finish(build()))


@pytest.mark.parametrize("name", ["check", "audit", "convert", "render", "certify", "export", "sim"])
def test_every_command_of_the_tools_keeps_to_the_root(name: str, root: Path) -> None:
    """As if a link was put in place between the server's look and the command's read."""
    secret = root.parent / "secret"
    (root / "late.urdf").symlink_to(secret)
    (root / "late").mkdir()
    (root / "late" / "plan.json").symlink_to(secret)
    (root / "late" / "request.json").symlink_to(secret)
    words = {"convert": [str(root / "x.xml")], "export": ["--to", "urdf"]}.get(name, [])
    for target in (root / "late.urdf", root / "late", secret)[:: 2 if name in {"certify", "export"} else 1]:
        try:
            answer = json.dumps(finish(Workbench(root).run(name, str(target), *words, seconds=60.0)))
        except ReadError as error:
            answer = str(error)
        assert "the-first-word" not in answer
        assert "Traceback" not in answer
        assert '"ok": true' not in answer


def test_a_script_is_not_written_through_a_link(root: Path) -> None:
    bench, secret = Workbench(root), root.parent / "secret"
    (root / "box" / "parts" / "lid.py").symlink_to(secret)
    with pytest.raises(ReadError):
        bench.write_script("box", "lid", "x = 1", "build123d")
    assert secret.read_text() == SECRET
