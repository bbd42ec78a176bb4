"""The paper's central claims: parts are made independently of each other, and what is broken is made again alone."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from articad.agents.llm import Request, Scripted
from articad.agents.part_writer import ROLE, messages_after, opening
from articad.agents.pipeline import generate
from articad.agents.rollback import Router
from articad.findings import Finding
from articad.plan.resolve import resolve
from articad.plan.schema import AssemblyPlan
from articad.runs.run import Run
from tests.agents import stories
from tests.agents.stories import fenced, judged, watched

EXAMPLES = sorted((Path(__file__).resolve().parents[2] / "examples").glob("*/plan.json"))
Plan = dict[str, Any]


def keys(plan: Plan) -> dict[str, str]:
    """The key of the first request for each part that has a script, in both dialects."""
    resolved = resolve(AssemblyPlan.from_json(plan))
    sources = [name for name, part in resolved.parts.items() if part.derivation is None]
    asked = {name: [messages_after(opening(resolved, name, kernel), None) for kernel in ("build123d", "freecad")] for name in sources}
    return {name: " ".join(Request(ROLE, f"part/{name}/1", messages).key for messages in both) for name, both in asked.items()}


def written(plan: Plan) -> list[Plan]:
    return [part for part in plan["parts"] if "derive" not in part]


def changed(plan: Plan, part: Plan) -> None:
    part |= {"description": "A barrel.", "role": "to roll", "orientation": "lying", "color": "#112233", "envelope_mm": [7, 7, 7]}
    part["dimensions"] = {"radius": 70}
    for connector in part["connectors"]:
        connector["label"] = "somewhere else"


def broken(plan: Plan, part: Plan) -> None:
    part["dimensions"] = {"nonsense": -1, "more_count": 0}
    part["description"] = ""


def added(plan: Plan, part: Plan) -> None:
    part["connectors"].append({"name": "seat_of_cat", "o": [0, 0, 0], "z": [0, 0, 1], "label": "seat"})
    cat = {"name": "cat", "material": plan["materials"][0]["name"], "description": "a cat", "rest_pose": "auto"}
    plan["parts"].append(cat | {"connectors": [{"name": "paw", "o": [0, 0, 0], "z": [0, 0, 1], "label": "paw"}]})
    plan["joints"].append({"name": "sits", "type": "fixed", "parent": f"{part['name']}.seat_of_cat", "child": "cat.paw"})


@pytest.mark.parametrize("change", [changed, broken, added])
@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.parent.name)
def test_nothing_that_happens_to_one_part_changes_the_request_of_another(example: Path, change: Callable[[Plan, Plan], None]) -> None:
    plan = json.loads(example.read_text())
    before = keys(plan)
    for victim in [part["name"] for part in written(plan)]:
        other = copy.deepcopy(plan)
        change(other, next(part for part in other["parts"] if part["name"] == victim))
        after = keys(other)

        assert {name: key for name, key in after.items() if name not in (victim, "cat")} == {
            name: key for name, key in before.items() if name != victim
        }
        assert after[victim] != before[victim]


def test_there_are_examples() -> None:
    assert len(EXAMPLES) >= 10


# ---------------------------------------------------------------------- derived parts


@pytest.mark.slow
def test_a_wardrobe_with_a_mirrored_door_makes_one_call_for_both_doors(tmp_path: Path) -> None:
    folder = next(path.parent for path in EXAMPLES if path.parent.name == "wardrobe")
    plan = json.loads((folder / "plan.json").read_text())
    joints = [joint["name"] for joint in plan["joints"]]
    script: dict[str, Any] = {"requirements": stories.requirements("wardrobe"), "design/1": json.dumps(plan)} | watched(*joints)
    script |= {f"part/{part['name']}/1": fenced((folder / f"parts/{part['name']}.py").read_text()) for part in written(plan)}
    llm = Scripted(script)
    run = generate("a wardrobe", llm=llm, out=tmp_path / "run", **stories.settings(kernel=stories.kernel(), cache=stories.shared_cache()))

    assert [step for step in llm.steps if "door" in step and step.startswith("part")] == ["part/door_left/1"]
    assert [step for step in llm.steps if "door" in step and step.startswith("look")] == ["look/door_left/1"]
    assert {"door_left", "door_right"} <= set(run.part_names())
    assert (run.verdict() or {})["ok"]


# ---------------------------------------------------------------------- many parts, one broken

PEG = """
from build123d import Align, Box

def build(part):
    d = part.dimensions
    shape = Box(d["side"], d["side"], d["height"], align=(Align.CENTER, Align.CENTER, Align.MIN))
    return shape, {"foot": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
"""
BENT = PEG.replace("Box(", "Rot(Z=45) * Box(").replace("import Align, Box", "import Align, Box, Rot")
BASE = """
from build123d import Align, Box

def build(part):
    d = part.dimensions
    frames = {name: {"o": frame.o, "z": frame.z, "x": frame.x} for name, frame in part.connectors.items()}
    return Box(d["length"], 20, d["height"], align=(Align.MIN, Align.CENTER, Align.MAX)), frames
"""


def row(pegs: int) -> Plan:
    """A base with so many pegs on it, each a part of its own."""
    foot = {"name": "foot", "kind": "frame", "o": [0, 0, 0], "z": [0, 0, 1], "x": [1, 0, 0], "label": "middle of the foot"}
    names = [f"peg_{n}" for n in range(1, pegs + 1)]
    base: Plan = {"name": "base", "material": "oak", "description": "Bar.", "dimensions": {"length": 20 * pegs, "height": 5}}
    base["connectors"] = [foot | {"name": name, "o": [20 * n + 10, 0, 0]} for n, name in enumerate(names)]
    parts: list[Plan] = [
        {
            "name": name,
            "material": "oak",
            "description": f"Peg number {n}.",
            "dimensions": {"side": 6, "height": 10 + n},
            "connectors": [foot],
        }
        | {"rest_pose": {"at": [20 * n + 10, 0, 0]}}
        for n, name in enumerate(names)
    ]
    joints = [{"name": name, "type": "fixed", "parent": f"base.{name}", "child": f"{name}.foot"} for name in names]
    return {
        "schema": "articad.plan/1",
        "name": "row",
        "ground": "base",
        "freedoms": 0,
        "materials": [{"name": "oak", "density_kg_m3": 700, "color": "#c8a46e"}],
        "parts": [base, *parts],
        "joints": joints,
    }


def row_of(pegs: int, tmp_path: Path, wrong: str | None = None) -> tuple[Scripted, Run]:
    plan = row(pegs)
    script: dict[str, Any] = {"requirements": stories.requirements("row"), "design/1": json.dumps(plan), "part/base/1": fenced(BASE)}
    script |= {f"part/peg_{n}/*": fenced(PEG) for n in range(1, pegs + 1)} | watched()
    if wrong:
        script |= {f"part/{wrong}/1": fenced(BENT), "judge/1/1": judged("placement", "code", wrong, what="it is turned by 45 degrees")}
    llm = Scripted(script)
    return llm, generate(
        "pegs", llm=llm, out=tmp_path / f"{pegs}{wrong}", **stories.settings(kernel=stories.kernel(), cache=stories.shared_cache())
    )


def test_of_many_parts_with_one_broken_exactly_one_is_made_again(tmp_path: Path) -> None:
    llm, run = row_of(5, tmp_path, "peg_3")
    again = [step for step in llm.steps if step.startswith(("part/", "look/")) and not step.endswith("/1")]

    assert sorted(again) == ["look/peg_3/2", "part/peg_3/2"]
    stored = run.round(1) or {}
    assert (stored["regenerated"], sorted(stored["kept"])) == (["peg_3"], ["base", "peg_1", "peg_2", "peg_4", "peg_5"])
    assert (run.verdict() or {})["ok"]


def test_calls_grow_linearly_with_parts(tmp_path: Path) -> None:
    calls = {pegs: len(row_of(pegs, tmp_path)[0].steps) for pegs in (1, 2, 4, 8)}

    assert calls == {pegs: 4 + 2 * (pegs + 1) for pegs in calls}  # analysis, plan, observer, judge; a script and a look for each part


# ---------------------------------------------------------------------- whose fault


@pytest.mark.parametrize(
    ("finding", "design", "code"),
    [
        (Finding(code="E_OVERLAP", where="parts", message="", hint="", parts=("peg_1", "peg_2")), 1, []),
        (Finding(code="E_FLOATING", where="parts.peg_1", message="", hint="", parts=("peg_1",)), 1, []),
        (Finding(code="E_NOT_ONE_SOLID", where="parts.peg_1", message="", hint="", parts=("peg_1",)), 0, ["peg_1"]),
        (Finding(code="E_MESH_OPEN", where="parts.base", message="", hint="", parts=("base",)), 0, ["base"]),
        (
            Finding(
                code="E_STATIC_OVERLAP",
                where="joints.peg_2",
                message="",
                hint="",
                parts=("base", "peg_2"),
                cause="envelope",
                route="design",
            ),
            1,
            [],
        ),
    ],
    ids=lambda value: value.code if isinstance(value, Finding) else None,
)
def test_geometry_decides_without_a_model(finding: Finding, design: int, code: list[str]) -> None:
    resolved = resolve(AssemblyPlan.from_json(row(2)))
    repair = Router(Scripted({})).decide(1, [finding], resolved, {"base": b"", "peg_1": b"", "peg_2": b""})

    assert (len(repair.design), list(repair.code)) == (design, code)
