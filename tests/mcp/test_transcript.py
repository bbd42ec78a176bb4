"""The example transcript: its tool calls, run again over stdio, are answered as recorded.

`python -m tests.mcp.test_transcript` records the answers anew, after a change that is meant; the calls stay as they are.
"""

from __future__ import annotations

import json
import os
import sys
import tempfile
from pathlib import Path
from typing import Any

import pytest
from mcp import Client, StdioServerParameters
from mcp.client.stdio import stdio_client

from tests.coroutines import finish

TRANSCRIPT = Path(__file__).parents[2] / "integrations" / "transcript.jsonl"
GEOMETRY = frozenset({"build_part", "build_parts", "build", "render", "certify", "verify_certificate", "sim", "audit", "export"})
Json = dict[str, Any]


def steps() -> list[Json]:
    """Return what was said, called and answered, in order."""
    return [json.loads(line) for line in TRANSCRIPT.read_text(encoding="utf-8").splitlines()]


def answered(calls: list[Json], root: Path) -> list[str]:
    """Return the answer of each call; a picture counts as its type."""
    found: list[str] = []

    async def session() -> None:
        environment = {name: os.environ[name] for name in ("PATH", "HOME", "ARTICAD_CACHE", "ARTICAD_SANDBOX") if name in os.environ}
        server = StdioServerParameters(command=sys.executable, args=["-m", "articad.cli", "mcp", "--root", str(root)], env=environment)
        async with Client(stdio_client(server)) as client:
            for call in calls:
                answer = await client.call_tool(call["tool"], call["arguments"])
                found.append("\n".join(content.text if content.type == "text" else f"[{content.type}]" for content in answer.content))

    finish(session())
    return found


def test_the_calls_before_geometry_are_answered_as_recorded(tmp_path: Path) -> None:
    calls = [step for step in steps() if "tool" in step and step["tool"] not in GEOMETRY]
    assert [call["tool"] for call in calls] == ["schema", "check_plan", "explain", "edit_plan"]
    assert answered(calls, tmp_path) == [call["answer"] for call in calls]


@pytest.mark.slow
def test_the_whole_transcript_is_answered_as_recorded(tmp_path: Path) -> None:
    calls = [step for step in steps() if "tool" in step]
    assert {call["tool"] for call in calls} >= {"build_parts", "build", "render", "certify", "verify_certificate", "export"}
    assert answered(calls, tmp_path) == [call["answer"] for call in calls]


def test_the_transcript_shows_a_mistake_and_its_correction() -> None:
    said = steps()
    assert any("says" in step for step in said)
    refused = [json.loads(step["answer"]) for step in said if step.get("tool") == "check_plan"]
    assert [finding["code"] for finding in refused[0]["findings"]] == ["E_DOF_MISMATCH"]
    corrected = [json.loads(step["answer"]) for step in said if step.get("tool") == "edit_plan"]
    assert corrected[-1]["ok"]
    assert corrected[-1]["gone"] == 1


def main() -> None:
    """Record the answers of all calls anew."""
    written = steps()
    calls = [step for step in written if "tool" in step]
    with tempfile.TemporaryDirectory() as folder:
        for call, answer in zip(calls, answered(calls, Path(folder)), strict=True):
            call["answer"] = answer
    TRANSCRIPT.write_text("".join(json.dumps(step, ensure_ascii=False) + "\n" for step in written), encoding="utf-8")


if __name__ == "__main__":
    main()
