"""Plans and runs under the root that somebody else wrote: each tool answers in words, whatever they hold."""

from __future__ import annotations

import asyncio
import json
import math
import sys
import time
from pathlib import Path
from typing import Any

import pytest

from articad import examples
from articad.mcp.server import Tools
from articad.mcp.workbench import FULL_BYTES
from articad.plan.reading import MOST_LEVELS
from articad.processes import scratch
from articad.runs.run import Run, RunRequest
from tests.coroutines import finish
from tests.mcp.test_links import CALLS, Deaf, told

PLANS = {
    "nested": "[" * 100_000,
    "objects": '{"a":' * 50_000,
    "list": "[1, 2]",
    "number": "5",
    "null": "null",
    "nothing": "",
    "bytes": "\xff",
    "short": '{"schema": "articad.short/1", "parts": [1], "parameters": [1]}',
    "parts": '{"schema": "articad.plan/1", "parts": 5, "parameters": {"a": 1}, "joints": null}',
    "surrogates": '{"schema": "articad.plan/1", "name": "\\ud800", "parameters": [{"name": "\\ud800"}]}',
}
RECORDS = ("[" * 100_000, "[]", "null", "{}", '{"shape": 5}', '{"shape": {"mesh_sha256": {"a": 1}}}', "\xff")
READ_HERE = ("check_plan", "edit_plan", "build_part", "build_parts", "edit_parameters")
"""Tools that read files in the server's own process; the others hand them to commands."""


@pytest.mark.parametrize("plan", PLANS)
@pytest.mark.parametrize("tool", READ_HERE)
def test_a_plan_that_is_none_is_refused_in_words(tool: str, plan: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    _no_commands(monkeypatch)
    (tmp_path / "bad").mkdir()
    (tmp_path / "bad" / "plan.json").write_text(PLANS[plan], encoding="latin-1")
    answer = told(tmp_path, tool, **{key: "bad" if value == "NAMED" else value for key, value in CALLS[tool].items()})
    assert "Traceback" not in answer


@pytest.mark.parametrize("record", RECORDS, ids=range(len(RECORDS)))
def test_a_run_with_strange_records_is_built_again(record: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """`edit_parameters` compares shapes with those of the run before."""
    _no_commands(monkeypatch)
    (tmp_path / "box" / "run" / "parts" / "lid").mkdir(parents=True)
    (tmp_path / "box" / "plan.json").write_bytes((examples.folder("wardrobe") / "plan.json").read_bytes())
    (tmp_path / "box" / "run" / "request.json").write_text("{}")
    (tmp_path / "box" / "run" / "parts" / "lid" / "part.json").write_text(record, encoding="latin-1")
    answer = told(tmp_path, "edit_parameters", design="box", values={"width": 950.0})
    assert "Traceback" not in answer


def test_a_folder_that_is_no_run_is_not_removed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A build replaces the run of a design, but no other folder of that name."""
    _no_commands(monkeypatch)
    (tmp_path / "box" / "run").mkdir(parents=True)
    (tmp_path / "box" / "plan.json").write_bytes((examples.folder("wardrobe") / "plan.json").read_bytes())
    (tmp_path / "box" / "run" / "notes.txt").write_text("mine")
    answer = told(tmp_path, "build", design="box")
    assert (tmp_path / "box" / "run" / "notes.txt").read_text() == "mine"
    assert "run" in answer
    assert "is not a run" in answer


@pytest.mark.parametrize("second", ["edit_parameters", "build", "edit_plan"])
def test_calls_that_change_one_design_wait_for_each_other(second: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """An edit puts plan and run back where it fails: two at once put back each other's unfinished run in place of the good one."""
    working: list[str] = []

    async def run(_: Any, command: str, *words: str, **__: Any) -> dict[str, Any]:
        if command != "build":
            return {"ok": True, "findings": []}
        assert not working
        working.append(command)
        out = Path(next(word for word in words if word.startswith("--out=")).removeprefix("--out="))
        scratch.write(out / "request.json", b"unfinished")
        await asyncio.sleep(0.2)
        scratch.write(out / "request.json", b"unfinished")
        working.pop()
        return {"ok": False, "error": "no", "findings": []}

    monkeypatch.setattr("articad.mcp.workbench.Workbench.run", run)
    (tmp_path / "box" / "run").mkdir(parents=True)
    (tmp_path / "box" / "run" / "request.json").write_text("good")
    (tmp_path / "box" / "plan.json").write_bytes((examples.folder("wardrobe") / "plan.json").read_bytes())
    tools, heard = Tools(tmp_path), dict[str, Any](context=Deaf())
    arguments: dict[str, dict[str, Any]] = {
        "edit_parameters": heard | {"values": {"width": 940.0}},
        "build": heard,
        "edit_plan": {"changes": {"name": "other"}},
    }

    async def both() -> None:
        first = asyncio.ensure_future(tools.edit_parameters(Deaf(), "box", {"width": 950.0}))
        await asyncio.sleep(0.05)
        await getattr(tools, second)(design="box", **arguments[second])
        await first

    finish(both())
    assert (tmp_path / "box" / "run" / "request.json").read_text() == ("unfinished" if second == "build" else "good")
    assert json.loads((tmp_path / "box" / "plan.json").read_text())["name"] == ("other" if second == "edit_plan" else "wardrobe")


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such locks")
@pytest.mark.parametrize("tool", ["build", "edit_parameters"])
def test_a_run_in_which_another_process_works_is_not_removed(tool: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    _no_commands(monkeypatch)
    plan = (examples.folder("wardrobe") / "plan.json").read_bytes()
    (tmp_path / "box").mkdir()
    (tmp_path / "box" / "plan.json").write_bytes(plan)
    with Run.create(RunRequest(prompt="x"), out=tmp_path / "box" / "run"):
        answer = told(tmp_path, tool, **{key: "box" if value == "NAMED" else value for key, value in CALLS[tool].items()})
        assert (tmp_path / "box" / "run" / "request.json").is_file()
    assert "Another process uses" in answer
    assert (tmp_path / "box" / "plan.json").read_bytes() == plan


def _no_commands(monkeypatch: pytest.MonkeyPatch) -> None:
    async def run(_: Any, command: str, *__: str, **___: Any) -> dict[str, Any]:
        return {"ok": False, "schema": command, "findings": []}

    monkeypatch.setattr("articad.mcp.workbench.Workbench.run", run)
    assert json.dumps("")


@pytest.mark.parametrize("number", [math.nan, math.inf, -math.inf, 10**5000], ids=["nan", "inf", "-inf", "digits"])
def test_a_number_that_json_does_not_have_is_not_written_into_a_plan(number: float, tmp_path: Path) -> None:
    (tmp_path / "box").mkdir()
    before = (examples.folder("wardrobe") / "plan.json").read_bytes()
    (tmp_path / "box" / "plan.json").write_bytes(before)
    assert "not finite" in told(tmp_path, "edit_plan", design="box", changes={"parameters.width": number})
    assert (tmp_path / "box" / "plan.json").read_bytes() == before


@pytest.mark.parametrize("address", ["parts." + "9" * 5000, "parts.\u00b2", "parts[99999999999]", "parts.-1", "", ".", "parts."])
def test_an_address_of_nothing_is_refused_in_words(address: str, tmp_path: Path) -> None:
    (tmp_path / "box").mkdir()
    (tmp_path / "box" / "plan.json").write_bytes((examples.folder("wardrobe") / "plan.json").read_bytes())
    for value in (1, {"name": "x"}, None):
        answer = told(tmp_path, "edit_plan", design="box", changes={address: value})
        assert "Traceback" not in answer


@pytest.mark.parametrize("levels", [MOST_LEVELS, MOST_LEVELS + 1, 190])
def test_a_plan_that_no_tool_could_read_again_is_not_written(levels: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    _no_commands(monkeypatch)
    (tmp_path / "box").mkdir()
    before = (examples.folder("wardrobe") / "plan.json").read_bytes()
    (tmp_path / "box" / "plan.json").write_bytes(before)
    deep: Any = 1
    for _ in range(levels):
        deep = {"a": deep}
    for tool, arguments in (("edit_plan", {"changes": {"description": deep}}), ("check_plan", {"plan": {"description": deep}})):
        assert f"deeper than {MOST_LEVELS} levels" in told(tmp_path, tool, design="box", **arguments)
        assert (tmp_path / "box" / "plan.json").read_bytes() == before


@pytest.mark.parametrize("sign", ["x", "x.", "é", "\u202e", "\U0001f4a5", "[1]"])
def test_a_finding_of_any_length_is_told(sign: str, tmp_path: Path) -> None:
    """A finding quotes the address: an answer is cut to its size within the texts of a finding, and stays one."""
    (tmp_path / "box").mkdir()
    (tmp_path / "box" / "plan.json").write_bytes((examples.folder("wardrobe") / "plan.json").read_bytes())
    answer = told(tmp_path, "edit_plan", design="box", changes={sign * (20_000 // len(sign)): 1})
    assert "Traceback" not in answer
    assert len(answer.encode()) <= FULL_BYTES


@pytest.mark.parametrize("tool", CALLS)
def test_an_argument_that_is_no_name_for_its_length_is_refused_at_once(tool: str, tmp_path: Path) -> None:
    """Each text of each tool, but plans and scripts, which have bounds of their own."""
    (tmp_path / "box").mkdir()
    (tmp_path / "box" / "plan.json").write_bytes((examples.folder("wardrobe") / "plan.json").read_bytes())
    long = "x " * 1_000_000
    sound = {key: "box" if value == "NAMED" else value for key, value in CALLS[tool].items()}
    for name, value in sound.items():
        if name not in {"script", "plan", "dialect", "budget_s"}:
            bad = {long: 1.0} if isinstance(value, dict) else [long] if isinstance(value, list) else long
            began = time.process_time()
            answer = told(tmp_path, tool, **sound | {name: bad})
            assert "characters" in answer
            assert len(answer) < 2_000
            assert time.process_time() - began < 2.0
