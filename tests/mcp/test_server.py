"""The tools over stdio, by a client of the official SDK: whole designs, cancelled work, hostile arguments."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import anyio
import mujoco
import pytest
from mcp import Client, StdioServerParameters
from mcp.client.stdio import stdio_client

from articad import examples
from articad.mcp.server import make_server
from articad.mcp.workbench import BRIEF_BYTES, FULL_BYTES, SHOWN_FINDINGS, condensed
from tests.coroutines import finish
from tests.plan.test_short_texts import FLAT, ROD

Json = dict[str, Any]
Work = Callable[["Agent"], Awaitable[None]]


class Agent:
    """A client that knows the tools alone, and counts what goes in and out."""

    def __init__(self, client: Client) -> None:
        self.client = client
        self.bytes: dict[str, list[int]] = {}

    async def call(self, tool: str, **arguments: Any) -> Any:
        answer = await self.client.call_tool(tool, arguments)
        texts = [content.text for content in answer.content if content.type == "text"]
        self.bytes.setdefault(tool, []).append(len(json.dumps(arguments)) + sum(map(len, texts)))
        assert not answer.is_error, texts
        if not texts:
            return answer.content
        try:
            return json.loads(texts[0])
        except ValueError:
            return "\n".join(texts)

    async def refused(self, tool: str, **arguments: Any) -> str:
        answer = await self.client.call_tool(tool, arguments)
        assert answer.is_error
        return "\n".join(content.text for content in answer.content if content.type == "text")

    async def refused_or_failed(self, tool: str, **arguments: Any) -> str:
        """What a tool says that cannot do its work, as an error or as an answer that is not ok."""
        answer = await self.client.call_tool(tool, arguments)
        text = "\n".join(content.text for content in answer.content if content.type == "text")
        assert answer.is_error or not json.loads(text)["ok"]
        return text


def over_stdio(root: Path, work: Work) -> None:
    async def session() -> None:
        environment = {name: os.environ[name] for name in ("PATH", "HOME", "ARTICAD_CACHE", "ARTICAD_SANDBOX") if name in os.environ}
        server = StdioServerParameters(command=sys.executable, args=["-m", "articad.cli", "mcp", "--root", str(root)], env=environment)
        async with Client(stdio_client(server)) as client:
            await work(Agent(client))

    finish(session())


@pytest.mark.slow
@pytest.mark.parametrize("name", ["geared_four_bar", "wardrobe"])
def test_an_agent_designs_builds_certifies_and_exports_through_tools_alone(name: str, tmp_path: Path) -> None:
    folder = examples.folder(name)
    plan = json.loads((folder / "plan.json").read_text())

    async def work(agent: Agent) -> None:
        wrong = json.loads(json.dumps(plan))
        wrong["freedoms"] += 1
        answer = await agent.call("check_plan", design="mine", plan=wrong)
        assert answer["findings"][0]["code"] == "E_DOF_MISMATCH"
        assert "declared" in await agent.call("explain", code="E_DOF_MISMATCH")
        assert (await agent.call("check_plan", design="mine", plan=plan))["ok"]
        for part in plan["parts"]:
            if "derive" not in part:
                script = (folder / "parts" / f"{part['name']}.py").read_text()
                built = await agent.call("build_part", design="mine", part=part["name"], script=script)
                assert built["ok"], built
        assembled = await agent.call("build", design="mine")
        assert assembled["ok"], assembled
        assert assembled["freedoms"] == plan["freedoms"]
        (picture,) = await agent.call("render", design="mine")
        assert picture.mime_type == "image/png"
        moving = assembled["drivers"][0]["name"]
        proof = await agent.call("certify", design="mine", joints=[moving], pairs=False, budget_s=240)
        assert proof["ok"], proof
        written = await agent.call("export", design="mine", formats=["mjcf", "step", "glb"])
        mujoco.MjModel.from_xml_path(str(tmp_path / written["exports"]["mjcf"]["file"]))
        assert sum(map(sum, agent.bytes.values())) < 120_000  # plan and scripts included: what a model reads and writes

    over_stdio(tmp_path, work)


def test_scripts_in_files_are_built_together_and_a_plan_is_edited_by_address(tmp_path: Path) -> None:
    """A file may serve several parts; the answer on a clean plan is short; an edit returns what it brought about and nothing else."""
    plan = json.loads(json.dumps(CHEST))
    plan["parts"][1]["rest_pose"] = "auto"
    (tmp_path / "chest").mkdir()
    (tmp_path / "chest" / "plan.json").write_text(json.dumps(plan))
    (tmp_path / "box.py").write_text(BOX)
    (tmp_path / "lid.py").write_text(LID)
    progress: list[str | None] = []

    async def heard(_done: float, _total: float | None, message: str | None) -> None:
        progress.append(message)

    async def work(agent: Agent) -> None:
        clean = await agent.call("check_plan", design="chest")
        assert clean == {"ok": True, "notes": ["I_REST_AUTO joints.opening"]}
        broken = await agent.call("edit_plan", design="chest", changes={"freedoms": 2, "joints.opening.angle_deg": [-110, 1.5]})
        assert [finding["code"] for finding in broken["findings"]] == ["E_DOF_MISMATCH"]
        mended = await agent.call("edit_plan", design="chest", changes={"freedoms": 1})
        assert mended == {"ok": True, "gone": 1}
        worse = await agent.call("edit_plan", design="chest", changes={"parts.lid.material": "oa", "freedoms": 3})
        again = await agent.call("edit_plan", design="chest", changes={"parts.lid.material": "oak"})
        assert ({finding["code"] for finding in worse["findings"]}, again["remaining"]) == (
            {"E_MATERIAL_UNKNOWN", "E_DOF_MISMATCH"},
            ["E_DOF_MISMATCH freedoms"],
        )
        await agent.call("edit_plan", design="chest", changes={"freedoms": 1})
        answer = await agent.client.call_tool(
            "build_parts", {"design": "chest", "files": {"box": "box.py", "lid": "lid.py"}}, progress_callback=heard
        )
        built = json.loads(answer.content[0].text)
        assert built["ok"], built
        assert built["parts"] == {"box": "300 x 200 x 80 mm, 1.048 kg", "lid": "300 x 200 x 12 mm, 0.504 kg"}
        (tmp_path / "chest" / "parts" / "lid.py").write_text(LID.replace("board", "bord"))
        (tmp_path / "chest" / "parts" / "box.py").write_text(BOX.replace("import", "improt"))
        failed = await agent.call("build_parts", design="chest")
        assert (failed["ok"], failed["parts"]) == (False, {"box": "failed", "lid": "failed"})
        assert {finding["where"].split(".")[1] for finding in failed["findings"]} == {"box", "lid"}
        for file in ("../else.py", "/etc/passwd", "link.py"):
            assert "annot be read" in await agent.refused("build_parts", design="chest", files={"lid": file})
        assert "not a valid name" in await agent.refused("build_parts", design="chest", files={"../lid": "lid.py"})

    (tmp_path / "link.py").symlink_to("/etc/passwd")
    over_stdio(tmp_path, work)
    assert any(message and message.startswith("part: ") for message in progress)


def test_pins_that_joints_make_are_built_without_a_script(tmp_path: Path) -> None:
    async def work(agent: Agent) -> None:
        await agent.call("check_plan", design="swing", plan=ROD, script=FLAT)
        built = await agent.call("build_parts", design="swing")
        pins = {
            "bolt": "14 x 14 x 24.4 mm, 0.01288 kg",
            "bolt_2": "14 x 14 x 24.4 mm, 0.01288 kg",
            "stud": "12 x 12 x 20.2 mm, 0.008069 kg",
        }
        assert {name: line for name, line in built["parts"].items() if name in pins} == pins
        assert (await agent.call("build_part", design="swing", part="bolt"))["ok"]

    over_stdio(tmp_path, work)


def test_a_file_is_adopted_and_its_proof_is_checked_by_another(tmp_path: Path) -> None:
    shutil.copy(examples.folder("wardrobe").parent / "hinge.urdf", tmp_path / "hinge.urdf")

    async def work(agent: Agent) -> None:
        adopted = await agent.call("adopt", source="hinge.urdf", design="hinge")
        assert (adopted["parts"], adopted["joints"]) == (2, 1)
        assert "is not empty" in await agent.refused_or_failed("adopt", source="hinge.urdf", design="hinge")
        assert "outside the root" in await agent.refused("adopt", source="../x.urdf", design="other")
        assert (await agent.call("build", design="hinge"))["files"]
        assert "no certificate" in await agent.refused_or_failed("verify_certificate", design="hinge")
        await agent.call("certify", design="hinge", budget_s=60)
        verified = await agent.call("verify_certificate", design="hinge")
        assert verified["faults"] == []
        assert verified["stated"]

    over_stdio(tmp_path, work)


def test_an_edit_says_what_changed_and_what_is_provably_the_same(tmp_path: Path) -> None:
    async def work(agent: Agent) -> None:
        await design_of(agent, "chest", CHEST)
        answer = await agent.call("edit_parameters", design="chest", values={"lid_board": 15})
        assert (answer["changed"], answer["same"]) == (["lid"], ["box"])
        assert "lid_bord" in await agent.refused("edit_parameters", design="chest", values={"lid_bord": 15})
        before = contents(tmp_path / "chest")
        assert "run/request.json" in before
        failed = await agent.call("edit_parameters", design="chest", values={"width": -5})
        assert not failed["ok"]
        assert contents(tmp_path / "chest") == before

        for patience in (0.3, 3.0):  # of about ten seconds
            with anyio.move_on_after(patience) as scope:
                await agent.call("edit_parameters", design="chest", values={"width": 310})
            assert scope.cancelled_caught
            with anyio.fail_after(60):
                while contents(tmp_path / "chest") != before:  # noqa: ASYNC110 - the end of the call is no event of this loop
                    await anyio.sleep(0.1)

    over_stdio(tmp_path, work)


@pytest.mark.slow
def test_a_long_certificate_can_be_cancelled_and_leaves_no_process(tmp_path: Path) -> None:
    shutil.copytree(examples.folder("jansen_leg"), tmp_path / "leg", ignore=shutil.ignore_patterns("recording"))

    async def work(agent: Agent) -> None:
        assert (await agent.call("build", design="leg"))["ok"]
        (page,) = (await agent.client.read_resource("ui://articad/designs/leg")).contents
        assert page.mime_type == "text/html;profile=mcp-app"
        assert "jansen_leg" in page.text
        papers = await agent.call("manual", design="leg", papers=["bom"])
        assert papers["ok"]
        assert papers["files"] == ["leg/papers/jansen_leg_bom.csv", "leg/papers/jansen_leg_bom.json"]
        assert all((tmp_path / file).is_file() for file in papers["files"])
        assert page.text.startswith("<!doctype html>")
        with anyio.move_on_after(4) as scope:  # of half a minute
            await agent.call("certify", design="leg", budget_s=500)
        assert scope.cancelled_caught
        with anyio.fail_after(60):
            while processes_in(tmp_path):  # noqa: ASYNC110 - the end of a process is no event of this loop
                await anyio.sleep(0.1)
        assert (await agent.call("check_plan", design="leg"))["ok"]  # the server is well

    over_stdio(tmp_path, work)


def test_the_plan_chooses_the_kernel(tmp_path: Path) -> None:
    """A script is stored for the plan's kernel, and that kernel is asked to build it."""
    shutil.copytree(examples.folder("four_bar"), tmp_path / "bar", ignore=shutil.ignore_patterns("recording"))
    plan = json.loads((tmp_path / "bar" / "plan.json").read_text()) | {"kernel": "freecad"}
    (tmp_path / "bar" / "plan.json").write_text(json.dumps(plan))
    script = "import FreeCAD\nbuild = 1"

    async def call() -> str:
        async with Client(make_server(tmp_path)) as client:
            return await Agent(client).refused_or_failed("build_part", design="bar", part="crank", script=script)

    said = finish(call())
    assert (tmp_path / "bar" / "parts" / "crank.freecad.py").read_text() == script
    assert "No module named" not in said, said  # as build123d says


@pytest.mark.parametrize(
    ("tool", "arguments", "words"),
    [
        ("check_plan", {"design": "../else", "plan": {}}, "not a valid name of a design"),
        ("build_part", {"design": "chest", "part": "../../x", "script": ""}, "not a valid name of a part"),
        ("build_part", {"design": "chest", "part": "lid", "script": "#" * 300_000}, "at most 200000"),
        ("build_part", {"design": "chest", "part": "--sandbox=weak"}, "not a valid name of a part"),
        ("build_parts", {"design": "chest", "files": {"lid,--sandbox=weak": "chest/plan.json"}}, "not a valid name of a part"),
        ("certify", {"design": "chest", "budget_s": 1e308}, "less than or equal to 3600"),
        ("audit", {"design": "/etc/passwd"}, "outside the root"),
        ("render", {"design": "link"}, "outside the root"),
        ("convert", {"source": "chest/plan.json", "target": "../x.urdf"}, "outside the root"),
        ("export", {"design": "no_such"}, "There is no no_such"),
        ("manual", {"design": "../else"}, "not a valid name of a design"),
        ("manual", {"design": "chest", "papers": ["../x"]}, "manual"),
        ("explain", {"code": "E_OVERLAPS"}, "Did you mean 'E_OVERLAP'"),
        ("schema", {"topic": "no such thing"}, "There is no type or page"),
        ("build_part", {"design": "chest", "part": "lid", "kernel": "blender"}, "kernel"),
    ],
)
def test_hostile_arguments_are_refused_in_words(tmp_path: Path, tool: str, arguments: Json, words: str) -> None:
    tools = make_server(tmp_path)
    (tmp_path / "chest").mkdir()
    (tmp_path / "chest" / "plan.json").write_text("{}")
    (tmp_path / "link").symlink_to("/etc")

    async def call() -> str:
        async with Client(tools) as client:
            return await Agent(client).refused(tool, **arguments)

    assert words in finish(call())


def test_render_is_bound_to_a_view_that_is_a_resource(tmp_path: Path) -> None:
    """As MCP Apps has it: the tool names a ui:// page of the app's type; without support for it, the tool answers pictures as before."""

    async def work(agent: Agent) -> None:
        tools = {tool.name: tool for tool in (await agent.client.list_tools()).tools}
        assert {name for name, tool in tools.items() if tool.meta} == {"render"}
        uri = tools["render"].meta["ui"]["resourceUri"]
        (shell,) = (await agent.client.read_resource(uri)).contents
        assert shell.mime_type == "text/html;profile=mcp-app"
        assert "ui://articad/designs/" in shell.text
        (template,) = (await agent.client.list_resource_templates()).resource_templates
        assert template.uri_template == "ui://articad/designs/{design}"
        for wrong in ("no_such", "..%2F..%2Fetc"):
            with pytest.raises(Exception, match=r"(?i)no design|not a valid name|not found|unknown"):
                await agent.client.read_resource(f"ui://articad/designs/{wrong}")

    over_stdio(tmp_path, work)


def test_a_million_findings_are_cut_with_a_note() -> None:
    finding = {"code": "E_OVERLAP", "severity": "error", "where": "a, b", "message": "x" * 200, "hint": "y" * 200}
    report = {"ok": False, "findings": [finding | {"where": str(number)} for number in range(10**6)]}
    brief = condensed(report, detail=False)
    assert len(json.dumps(brief)) <= BRIEF_BYTES + 200
    assert len(brief["findings"]) == SHOWN_FINDINGS
    assert "more" in brief["more_findings"]
    full = condensed(report, detail=True)
    assert len(json.dumps(full)) <= FULL_BYTES + 200
    assert "cut" in full["truncated"]


def test_the_pages_of_the_schema_are_short() -> None:
    async def pages() -> dict[str, int]:
        async with Client(make_server("/tmp/articad-schema")) as client:
            agent = Agent(client)
            return {topic: len(await agent.call("schema", topic=topic)) for topic in ("plan", "part_script", "room", "findings", "Joint")}

    assert max(finish(pages()).values()) <= 2500


LID = """from build123d import Align, Box
def build(part):
    d = part.dimensions
    shape = Box(d["width"], d["depth"], d["board"], align=(Align.CENTER, Align.MAX, Align.MIN))
    return shape, {"hinge": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, -1, 0)}}
"""
BOX = """from build123d import Align, Box, Pos
def build(part):
    d = part.dimensions
    low = (Align.MIN, Align.MIN, Align.MIN)
    inner = Box(d["width"] - 2 * d["board"], d["depth"] - 2 * d["board"], d["height"], align=low)
    shape = Box(d["width"], d["depth"], d["height"], align=low) - Pos(d["board"], d["board"], d["board"]) * inner
    return shape, {"hinge": {"o": (d["width"] / 2, d["depth"], d["height"]), "z": (1, 0, 0), "x": (0, -1, 0)}}
"""
CHEST: Json = {
    "schema": "articad.plan/1",
    "name": "chest",
    "ground": "box",
    "freedoms": 1,
    "parameters": [
        {"name": "width", "value": 300},
        {"name": "depth", "value": 200},
        {"name": "height", "value": 80},
        {"name": "lid_board", "value": 12},
    ],
    "materials": [{"name": "oak", "density_kg_m3": 700, "color": "#b08d57"}],
    "parts": [
        {
            "name": "box",
            "material": "oak",
            "description": "Open box.",
            "dimensions": {"width": "width", "depth": "depth", "height": "height", "board": 12},
            "connectors": [{"name": "hinge", "label": "back edge", "o": ["width / 2", "depth", "height"], "z": [1, 0, 0], "x": [0, -1, 0]}],
        },
        {
            "name": "lid",
            "material": "oak",
            "description": "Panel.",
            "dimensions": {"width": "width", "depth": "depth", "board": "lid_board"},
            "rest_pose": {"at": ["width / 2", "depth", "height"]},
            "connectors": [{"name": "hinge", "label": "back edge", "o": [0, 0, 0], "z": [1, 0, 0], "x": [0, -1, 0]}],
        },
    ],
    "joints": [{"name": "opening", "type": "revolute", "parent": "box.hinge", "child": "lid.hinge", "angle_deg": [-110, 0]}],
}


async def design_of(agent: Agent, name: str, plan: Json) -> None:
    assert (await agent.call("check_plan", design=name, plan=plan))["ok"]
    await agent.call("build_part", design=name, part="lid", script=LID)
    await agent.call("build_part", design=name, part="box", script=BOX)
    assert (await agent.call("build", design=name))["files"]


def contents(folder: Path) -> dict[str, bytes]:
    """Return all files below a folder."""
    return {str(file.relative_to(folder)): file.read_bytes() for file in folder.rglob("*") if file.is_file()}


def processes_in(root: Path) -> list[int]:
    """Commands that work under a root; the server itself is not one."""
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            words = (folder / "cmdline").read_bytes().split(b"\0")
        except OSError:
            continue
        if b"certify" in words and any(word.startswith(str(root).encode()) for word in words):
            found.append(int(folder.name))
    return found


def test_a_client_that_goes_away_while_a_tool_works_is_no_defect(tmp_path: Path) -> None:
    shutil.copytree(examples.folder("four_bar"), tmp_path / "bar")
    words = [sys.executable, "-m", "articad.cli", "mcp", "--root", str(tmp_path)]
    with subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as server:
        assert server.stdin is not None
        assert server.stdout is not None
        assert server.stderr is not None
        hello = {"protocolVersion": "2025-06-18", "capabilities": {}, "clientInfo": {"name": "test", "version": "1"}}
        messages: list[Json] = [
            {"id": 1, "method": "initialize", "params": hello},
            {"method": "notifications/initialized"},
            {"id": 2, "method": "tools/call", "params": {"name": "build", "arguments": {"design": "bar"}, "_meta": {"progressToken": 1}}},
        ]
        for message in messages:
            server.stdin.write(json.dumps({"jsonrpc": "2.0", **message}).encode() + b"\n")
            server.stdin.flush()
        answers = (json.loads(line) for line in server.stdout)
        assert any(answer.get("method") == "notifications/progress" for answer in answers), "the tool works"
        server.stdout.close()
        server.stdin.close()
        assert server.wait(60) == 0
        assert server.stderr.read() == b""


NO_MESSAGES: list[tuple[bytes, int | None]] = [
    (rb'{"jsonrpc":"2.0","id":2,"method":"tools/call","params":{"name":"explain","arguments":{"code":"\ud800"}}}', 2),
    (b'{"jsonrpc":"2.0","id":3,"method":"tools/call","params":{"name":"explain","arguments":{"a":' + b"9" * 10_000 + b"}}}", 3),
    (b'{"jsonrpc":"2.0","id":4,"method":"tools/call","params":' + b'{"a":' * 5000 + b"1" + b"}" * 5000 + b"}", None),
    (b"hello", None),
    (b"\0", None),
    (b"[]", None),
    (b"3", None),
    (b'{"jsonrpc":"2.0","id":5,"met', None),
]


def test_a_line_that_is_no_message_is_answered_and_the_next_one_too(tmp_path: Path) -> None:
    """Also lines that other parsers of JSON accept: whoever sent them would wait for ever."""
    words = [sys.executable, "-m", "articad.cli", "mcp", "--root", str(tmp_path)]
    hello = {"protocolVersion": "2025-06-18", "capabilities": {}, "clientInfo": {"name": "test", "version": "1"}}
    begin = json.dumps({"jsonrpc": "2.0", "id": 1, "method": "initialize", "params": hello}).encode()
    ping = b'{"jsonrpc":"2.0","id":9,"method":"ping"}'
    lines = [begin, b'{"jsonrpc":"2.0","method":"notifications/initialized"}', *(line for line, _ in NO_MESSAGES), b"", ping]
    with subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as server:
        assert server.stdin is not None
        assert server.stdout is not None
        assert server.stderr is not None
        server.stdin.write(b"\n".join(lines) + b"\n")
        server.stdin.flush()
        answers = [json.loads(server.stdout.readline()) for _ in range(len(NO_MESSAGES) + 2)]
        server.stdin.close()
        assert server.wait(60) == 0
        assert server.stderr.read() == b""
    refused = [answer for answer in answers if "error" in answer]
    assert sorted(str(answer["id"]) for answer in refused) == sorted(str(number) for _, number in NO_MESSAGES)
    assert all(answer["error"]["message"].startswith("The line is not") for answer in refused)
    assert {answer["id"] for answer in answers if "result" in answer} == {1, 9}
