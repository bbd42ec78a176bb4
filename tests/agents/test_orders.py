"""Faults of a plan whose scripts follow it: the designer gets them, with the number that mends them."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

from articad.agents.llm import Reply, Request, Scripted
from articad.agents.pipeline import generate
from articad.runs.run import Run
from tests.agents import stories
from tests.agents.stories import fenced, watched


class Obedient:
    """A designer who does what a message says, and only that; the other answers are fixed."""

    def __init__(self, answers: dict[str, Any], rules: dict[str, Any]) -> None:
        self.scripted, self.rules, self.steps = Scripted(answers), rules, list[str]()

    def complete(self, request: Request) -> Reply:
        self.steps.append(request.step)
        if not request.step.startswith("design/") or request.step == "design/1":
            return self.scripted.complete(request)
        asked = "\n".join(part["text"] for part in request.to_json()["messages"][-1]["content"] if part["type"] == "text")
        for pattern, changes in self.rules.items():
            if found := re.search(pattern, asked):
                return Reply(json.dumps({"changes": changes(*map(float, found.groups()))}), "obedient")
        raise AssertionError(f"No rule for:\n{asked}")


def made(tmp_path: Path, llm: Any) -> Run:
    settings = stories.settings(kernel=stories.kernel(), cache=stories.shared_cache())
    return generate("a product", llm=llm, out=tmp_path / "run", **settings)


def plan(name: str, parts: list[dict[str, Any]], joint: dict[str, Any], **parameters: float) -> dict[str, Any]:
    return {
        "schema": "articad.plan/1",
        "name": name,
        "ground": parts[0]["name"],
        "freedoms": 1,
        "parameters": [{"name": key, "value": value} for key, value in parameters.items()],
        "materials": [{"name": "oak", "density_kg_m3": 700, "color": "#b58b5a"}],
        "parts": [{"material": "oak", **part} for part in parts],
        "joints": [joint],
    }


def axis(name: str, o: list[Any]) -> dict[str, Any]:
    return {"name": name, "o": o, "z": [0, -1, 0], "x": [1, 0, 0], "label": "axis"}


# A block with a slot, in which an arm turns about y. The slot is ordered too shallow for the arm's end.
FORK = """
from build123d import Align, Box, Pos

def build(part):
    d = part.dimensions
    body = Box(60, 40, 50, align=(Align.CENTER, Align.CENTER, Align.MAX))
    slot = Pos(0, 0, 0) * Box(60, d["slot_width"], d["slot_depth"], align=(Align.CENTER, Align.CENTER, Align.MAX))
    return body - slot, dict(part.connectors)
"""
ARM = """
from build123d import Box

def build(part):
    d = part.dimensions
    return Box(d["length"], d["thickness"], 8), dict(part.connectors)
"""


def test_a_slot_ordered_too_shallow_is_the_designers_and_is_made_deep_enough(tmp_path: Path) -> None:
    fork = {
        "name": "fork",
        "description": "Block 60 x 40 x 50 below z = 0 with a slot along x, slot_width wide and slot_depth deep from its top.",
        "dimensions": {"slot_width": 11, "slot_depth": "slot_depth"},
        "connectors": [axis("axis", [0, 0, -8])],
    }
    arm = {
        "name": "arm",
        "description": "Bar of length along x and thickness along y, 8 high, about the origin.",
        "dimensions": {"length": 40, "thickness": 10},
        "rest_pose": "auto",
        "connectors": [axis("axis", [0, 0, 0])],
    }
    turn = {"name": "turn", "type": "revolute", "parent": "fork.axis", "child": "arm.axis", "angle_deg": [0, 90]}
    first = plan("swing", [fork, arm], turn, slot_depth=14)
    answers = {"requirements": stories.requirements("swing"), "design/1": json.dumps(first)} | watched("turn")
    answers |= {"part/fork/1": fenced(FORK), "part/arm/1": fenced(ARM)}
    llm = Obedient(
        answers, {r"remove at least x \S+ to \S+, y \S+ to \S+, z (-?[\d.]+) to": lambda low: {"parameters.slot_depth.value": 1 - low}}
    )
    run = made(tmp_path, llm)

    assert (run.checks() or {})["ok"]
    assert [step for step in llm.steps if step.startswith("part/fork")] == ["part/fork/1"]  # its author was right
    assert [step for step in llm.steps if step.startswith("design")] == ["design/1", "design/2"]
    assert len(llm.steps) - llm.steps.index("design/2") <= 6


# A lid on a box, whose axis is ordered inside the box's back wall instead of behind it.
BOX = """
from build123d import Align, Box, Pos

LOW = (Align.CENTER, Align.MIN, Align.MIN)

def build(part):
    d = part.dimensions
    inner = Pos(0, d["wall"], d["wall"]) * Box(d["width"] - 2 * d["wall"], d["depth"] - 2 * d["wall"], d["height"], align=LOW)
    return Box(d["width"], d["depth"], d["height"], align=LOW) - inner, dict(part.connectors)
"""
LID = """
from build123d import Align, Box, Pos

def build(part):
    d = part.dimensions
    return Box(d["width"], d["depth"], d["thickness"], align=(Align.CENTER, Align.MIN, Align.MIN)), dict(part.connectors)
"""


def test_an_axis_ordered_too_low_and_too_near_is_the_designers(tmp_path: Path) -> None:
    sizes = {"width": 120, "depth": 80}
    box = {
        "name": "box",
        "description": "Box width x depth x height, y and z from 0, open above, with walls of wall.",
        "dimensions": {**sizes, "height": 50, "wall": 6},
        "connectors": [{"name": "axis", "o": [0, "axis_y", "axis_z"], "z": [1, 0, 0], "x": [0, 1, 0], "label": "axis"}],
    }
    lid = {
        "name": "lid",
        "description": "Plate width x depth x thickness, y and z from 0.",
        "dimensions": {**sizes, "thickness": 8},
        "rest_pose": {"at": [0, 0, 50.2]},
        "connectors": [{"name": "axis", "o": [0, "axis_y", "axis_z - 50.2"], "z": [1, 0, 0], "x": [0, 1, 0], "label": "axis"}],
    }
    hinge = {"name": "hinge", "type": "revolute", "parent": "box.axis", "child": "lid.axis", "angle_deg": [0, 100]}
    first = plan("chest", [box, lid], hinge, axis_y=3, axis_z=40)
    answers = {"requirements": stories.requirements("chest"), "design/1": json.dumps(first)} | watched("hinge")
    answers |= {"part/box/1": fenced(BOX), "part/lid/1": fenced(LID)}
    moved = r"Move the axis by \((\S+), (\S+), (\S+)\) mm in the frame of box"
    llm = Obedient(answers, {moved: lambda _x, y, z: {"parameters.axis_y.value": 3 + y, "parameters.axis_z.value": 40 + z}})
    run = made(tmp_path, llm)

    assert (run.checks() or {})["ok"]
    assert [step for step in llm.steps if step.startswith("design")] == ["design/1", "design/2"]
    assert len(llm.steps) - llm.steps.index("design/2") <= 6
