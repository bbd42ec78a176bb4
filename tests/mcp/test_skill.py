"""The skill is short and true: its plans validate, its scripts build, its commands, tools, codes and topics exist."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path

import pytest

from articad import cli
from articad.assembly import Assembly
from articad.commands.command import COMMANDS
from articad.errors import ReadError
from articad.findings.codes import CODES
from articad.mcp.server import make_server
from articad.mcp.skill import page, section, skill, topics
from articad.plan.check import check_plan
from articad.plan.json_schema import json_schema
from articad.plan.notation import TYPES
from articad.plan.resolve import resolve
from articad.plan.schema import AssemblyPlan
from tests.coroutines import finish

BLOCKS = [AssemblyPlan.loads(text) for text in re.findall(r"```json\n(.*?)```", skill(), re.DOTALL)]
FOUR_BAR, CART = BLOCKS
(SCRIPT,) = re.findall(r"```python\n(.*?)```", skill(), re.DOTALL)
PLANS = re.findall(r"```json\n(.*?)```", skill(), re.DOTALL)
WHEELS = """from build123d import *


def cart(length):
    return Pos(Z=20) * Box(length + 1, 8, 8)


def wheel(r, wide):
    return Rot(Y=-90) * Cylinder(r, wide, align=(Align.CENTER, Align.CENTER, Align.MIN))
"""


def loaded(plan: str, script: str, folder: Path) -> AssemblyPlan:
    """The plan of a folder with its script, as a designer leaves them."""
    (folder / "plan.json").write_text(plan)
    (folder / "parts.py").write_text(script)
    return AssemblyPlan.load(folder)


def test_it_is_short() -> None:
    assert len(skill()) <= 9000
    assert {topic: len(page(topic)) for topic in (*topics(), *TYPES) if len(page(topic)) > 2500} == {}


def test_its_four_bar_builds_and_turns(tmp_path: Path) -> None:
    """The frame's sides in the plane close at every angle: |P Q| is the coupler by the law of cosines, not by the solver."""
    plan = loaded(PLANS[0], SCRIPT, tmp_path)
    assert set(check_plan(plan).codes) == {"I_REDUNDANT"}
    assembly = Assembly.from_plan(plan, tmp_path / "parts")
    assert assembly.check().ok
    assert not [finding for finding in assembly.findings if finding.severity != "info"]
    for angle in (0.3, 2.0, 4.0, 6.0):
        poses = assembly.at(drive=angle)
        ends = [poses[part].apply([[length, 0.0, 0.0]])[0] for part, length in (("crank", 40.0), ("rocker", 80.0))]
        assert math.dist(ends[0][:2], ends[1][:2]) == pytest.approx(120.0)


@pytest.mark.soak
def test_its_four_bar_is_proven_to_move_freely(tmp_path: Path) -> None:
    assert Assembly.from_plan(loaded(PLANS[0], SCRIPT, tmp_path), tmp_path / "parts").certify().ok


def test_its_examples_are_short() -> None:
    assert len(PLANS[0]) + len(SCRIPT) <= 1600


def test_its_mirrored_wheel_stands_outside_and_turns_the_other_way_about_its_own_axis(tmp_path: Path) -> None:
    plan = loaded(PLANS[1], WHEELS, tmp_path)
    assert not check_plan(plan)
    turn = resolve(plan).mechanism.drivers[1]
    assert (math.degrees(turn.lower), math.degrees(turn.upper)) == pytest.approx((-90, 10))
    assembly = Assembly.from_plan(plan, tmp_path / "parts")
    assert assembly.check().ok
    meshes = {name: mesh for name in ("wheel_l", "wheel_r") if (mesh := assembly.parts[name].mesh) is not None}
    middles = [assembly.at()[name].apply(mesh.vertices)[:, 0].mean() for name, mesh in meshes.items()]
    assert middles == pytest.approx([-52.5, 52.5], abs=0.3)


def test_what_it_says_of_a_door_is_so() -> None:
    """The page on copies: z stays, x turns over, and the range comes out negated."""
    pin = {"o": [0, 0, 0], "z": [0, 0, 1], "label": "pin"}
    right = {"name": "pin_right", "o": [600, 0, 0], "z": [0, 0, 1], "x": [-1, 0, 0], "label": "pin"}
    plane = {"point": [300, 0, 0], "normal": [1, 0, 0]}
    oak = {"material": "oak", "description": ""}
    plan = {
        "schema": "articad.plan/1",
        "name": "case",
        "ground": "case",
        "freedoms": 2,
        "materials": [{"name": "oak", "density_kg_m3": 700, "color": "#b08d57"}],
        "parts": [
            {"name": "case", **oak, "connectors": [{"name": "pin_left", "x": [1, 0, 0], **pin}, right]},
            {"name": "door", **oak, "connectors": [{"name": "pin", "x": [1, 0, 0], **pin}]},
            {"name": "image", "derive": {"from": "door", "op": "mirror", "plane": plane}},
        ],
        "joints": [
            {"name": "turn", "type": "revolute", "parent": "case.pin_left", "child": "door.pin", "angle_deg": [-110, 0]},
            {"name": "turn_right", "derive": {"from": "turn", "op": "mirror"}, "parent": "case.pin_right", "child": "image.pin"},
        ],
    }
    loaded = AssemblyPlan.from_json(plan)
    assert not check_plan(loaded)
    turn = resolve(loaded).mechanism.drivers[1]
    assert (math.degrees(turn.lower), math.degrees(turn.upper)) == pytest.approx((0, 110))


def test_its_codes_exist() -> None:
    assert set(re.findall(r"\b[EWI]_[A-Z_]+\b", skill() + "".join(topics().values()))) <= set(CODES)


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
    assert len(tools) == 19
    assert {name for name, _ in calls} <= set(tools)
    for name, arguments in calls:
        assert set(re.findall(r"(\w+)=", arguments)) <= tools[name]


def test_its_topics_exist() -> None:
    named = set(re.findall(r'`schema\("(\w+)"\)`', skill())) | {"copies", "couplings", "rest", "room", "findings"}
    assert named <= set(topics()) | set(TYPES)
    assert "`kind`" in page("connectors")
    with pytest.raises(ReadError, match="Did you mean 'couplings'"):
        page("coupelings")


def test_its_fields_exist() -> None:
    schema = json.dumps(json_schema())
    known = set(re.findall(r"\w+", schema)) | {
        "design",
        "files",
        "ok",
        "z",
        "x",
        "crank,rocker",
        "lower_snake_case",
        "sin",
        "atan2",
        "code",
        *("along", "like", "hinge", "dowel", "blind", "mirror", "x", "y"),
    }
    for text in (section("The plan"), *(text for name, text in topics().items() if name in {"copies", "couplings", "rest"})):
        prose = re.sub(r"```.*?```", "", text, flags=re.DOTALL)
        assert {field for field in re.findall(r"`([a-z_]+)`", prose) if field not in known} <= {"acos", "hypot", "joint", "e"}


def test_the_notation_of_a_type_names_every_field_of_it() -> None:
    schema = json_schema()
    for topic, definition in (("part", "PartSpec"), ("connector", "ConnectorSpec"), ("revolute", "RevoluteSpec"), ("gear", "GearSpec")):
        fields = set(schema["$defs"][definition]["properties"])
        assert fields <= set(re.findall(r"`(\w+)`", page(topic))), topic
    assert set(schema["properties"]) <= set(re.findall(r"`(\w+)`", page("plan")))
    every = set().union(*(form["properties"] for form in schema["$defs"].values() if "parent" in form.get("properties", {})))
    assert every <= set(re.findall(r"`(\w+)`", page("joint")))
