"""The skill is short and true: its plans validate, its script builds, its commands, tools and codes exist."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path

import pytest

from articad import cli
from articad.assembly import Assembly
from articad.commands.command import COMMANDS
from articad.findings.codes import CODES
from articad.mcp.server import make_server
from articad.mcp.skill import section, skill
from articad.plan.check import check_plan
from articad.plan.json_schema import json_schema
from articad.plan.resolve import resolve
from articad.plan.schema import AssemblyPlan
from tests.coroutines import finish

BLOCKS = re.findall(r"```json\n(.*?)```", skill(), re.DOTALL)
PLANS = [AssemblyPlan.loads(text) for text in BLOCKS if '"schema"' in text]
LID = """from build123d import Align, Box
def build(part):
    d = part.dimensions
    shape = Box(d["width"], d["depth"], d["board"], align=(Align.CENTER, Align.MAX, Align.MIN))
    return shape, {"hinge": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, -1, 0)}}
"""


def test_it_is_short() -> None:
    assert len(skill().split()) <= 2500


@pytest.mark.parametrize("plan", PLANS, ids=lambda plan: plan.name)
def test_its_plans_have_no_finding(plan: AssemblyPlan) -> None:
    assert not check_plan(plan), str(check_plan(plan))


def test_its_mirror_image_stands_where_it_says_and_opens_the_other_way() -> None:
    (image,) = (json.loads(text) for text in BLOCKS if '"schema"' not in text)
    pin = {"o": [0, 0, 0], "z": [0, 0, 1], "x": [1, 0, 0], "label": "pin"}
    plan = {
        "schema": "articad.plan/1",
        "name": "case",
        "ground": "case",
        "freedoms": 2,
        "materials": [{"name": "oak", "density_kg_m3": 700, "color": "#b08d57"}],
        "parts": [
            {"name": "case", "material": "oak", "description": "", "connectors": [{"name": "pin_left", **pin}, image["connector of case"]]},
            {"name": "door_left", "material": "oak", "description": "", "connectors": [{"name": "pin", **pin}]},
            image["part"],
        ],
        "joints": [
            {"name": "turn_left", "type": "revolute", "parent": "case.pin_left", "child": "door_left.pin", "angle_deg": [-110, 0]},
            image["joint"],
        ],
    }
    loaded = AssemblyPlan.loads(json.dumps(plan))
    assert {finding.code for finding in check_plan(loaded)} <= {"I_MIRROR_SIDE"}
    turn = resolve(loaded).mechanism.drivers[1]
    assert (math.degrees(turn.lower), math.degrees(turn.upper)) == pytest.approx((0, 110))


def test_its_script_builds_its_first_plan() -> None:
    (script,) = re.findall(r"```python\n(.*?)```", skill(), re.DOTALL)
    assembly = Assembly.from_plan(PLANS[0], {"box": script.encode(), "lid": LID.encode()})
    assert assembly.check().ok
    assert not assembly.findings


def test_its_codes_exist() -> None:
    assert set(re.findall(r"\b[EWI]_[A-Z_]+\b", skill())) <= set(CODES)


def test_its_commands_exist_with_their_flags(capsys: pytest.CaptureFixture[str]) -> None:
    for line in re.findall(r"`articad ([^`]+)`", skill().replace("\n", " ")):
        name, *words = line.split()
        assert name in COMMANDS
        with pytest.raises(SystemExit) as ended:
            cli.main([name, "--help"])
        told = capsys.readouterr().out
        assert ended.value.code == 0
        assert all(word in told for word in words if word.startswith("--"))


def test_its_tools_exist_with_their_arguments(tmp_path: Path) -> None:
    tools = {tool.name: set(tool.input_schema["properties"]) for tool in finish(make_server(tmp_path).list_tools())}
    calls = re.findall(r"`(\w+)\(([^`]*)\)`", skill().split("## The plan")[0])
    assert {name for name, _ in calls} <= set(tools)
    assert len(tools) == 14
    for name, arguments in calls:
        assert set(re.findall(r"(\w+)=", arguments)) <= tools[name]


def test_its_page_of_the_plan_names_only_fields_that_exist() -> None:
    known = set(json.dumps(json_schema()).replace('"', " ").split()) | {"kernel"}
    fields = set(re.findall(r"`([a-z_]+)`", section("The plan in one page")))
    functions = {
        "abs",
        "acos",
        "asin",
        "atan",
        "atan2",
        "ceil",
        "cos",
        "floor",
        "hypot",
        "max",
        "min",
        "sin",
        "sqrt",
        "tan",
        "pi",
        "lower_snake_case",
    }
    assert {field for field in fields - functions if not any(field in word for word in known)} == set()
