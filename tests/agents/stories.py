"""Replies for two small products, as a model would give them."""

from __future__ import annotations

import atexit
import functools
import json
import re
import tempfile
from dataclasses import fields
from importlib.resources import files
from pathlib import Path
from typing import Any

from articad.agents.llm import Request, Scripted, Text
from articad.agents.settings import RunOptions, Services
from articad.kernels.build123d import Build123dKernel
from articad.kernels.kernel import BuildCache

FIXTURES = Path(__file__).parent.parent / "fixtures"
PROMPTS = files("articad.agents.prompts")

SEWING_BOX_PROMPT = "a sewing box, 240 mm wide, whose two lids open to the left and right, with a drawer below"

FLAP_PROMPT = "a plate with a flap on it"
FLAP_PLAN: dict[str, Any] = {
    "schema": "articad.plan/1",
    "name": "flap",
    "ground": "plate",
    "freedoms": 1,
    "parameters": [{"name": "lift", "value": 1}],
    "materials": [{"name": "steel", "density_kg_m3": 7850, "color": "#8a9299"}],
    "parts": [
        {
            "name": "plate",
            "material": "steel",
            "description": "Box x from 0 to length, y and z from 0 to side.",
            "dimensions": {"length": 40, "side": 10},
            "connectors": [{"name": "axis", "o": [0, 5, 10], "z": [0, -1, 0], "x": [1, 0, 0], "label": "hinge axis"}],
        },
        {
            "name": "flap",
            "material": "steel",
            "description": "Box x from 0 to length, y from 0 to side, z from lift to lift + thickness.",
            "dimensions": {"length": 30, "side": 10, "thickness": 2, "lift": "lift"},
            "rest_pose": {"at": [0, 0, 10]},
            "connectors": [{"name": "axis", "o": [0, 5, 0], "z": [0, -1, 0], "x": [1, 0, 0], "label": "hinge axis"}],
        },
    ],
    "joints": [{"name": "hinge", "type": "revolute", "parent": "plate.axis", "child": "flap.axis", "angle_deg": [0, 90]}],
}
FLAP_SCRIPTS = {
    "plate": """
from build123d import Align, Box

def build(part):
    d = part.dimensions
    shape = Box(d["length"], d["side"], d["side"], align=(Align.MIN,) * 3)
    return shape, {"axis": {"o": (0, d["side"] / 2, d["side"]), "z": (0, -1, 0), "x": (1, 0, 0)}}
""",
    "flap": """
from build123d import Align, Box, Pos

def build(part):
    d = part.dimensions
    shape = Pos(0, 0, d["lift"]) * Box(d["length"], d["side"], d["thickness"], align=(Align.MIN,) * 3)
    return shape, {"axis": {"o": (0, d["side"] / 2, 0), "z": (0, -1, 0), "x": (1, 0, 0)}}
""",
}


def requirements(name: str = "flap") -> str:
    """The shortest analysis that has the form."""
    empty: dict[str, Any] = {field: [] for field in ("relations", "motions", "constraints", "dimensions", "assumptions")}
    return json.dumps({"name": name, "summary": name, "components": [{"name": "plate", "count": 1, "description": "a plate"}]} | empty)


def fenced(script: str) -> str:
    return f"Here it is:\n\n```python\n{script.strip()}\n```\n"


LOOKS_RIGHT = json.dumps(
    {
        "findings": [
            {"aspect": aspect, "agrees": True, "seen": "a box", "specified": "a box", "fault": "none", "remedy": ""}
            for aspect in ("shape", "proportion", "orientation")
        ]
    }
)
FINE = {"ok": True, "reason": "as asked"}
ACCEPTED: dict[str, Any] = {"placement": FINE, "interference": FINE, "motion": FINE, "problems": []}


def looks(aspect: str, fault: str = "script", remedy: str = "make it thinner") -> str:
    """A look that finds one aspect not as specified."""
    findings = json.loads(LOOKS_RIGHT)["findings"]
    for entry in findings:
        if entry["aspect"] == aspect:
            entry |= {"agrees": False, "seen": "a cube", "specified": "a plate", "fault": fault, "remedy": remedy}
    return json.dumps({"findings": findings})


def observed(*joints: str) -> str:
    """What an observer says who finds nothing odd."""
    motions = [{"joint": joint, "seen": "turns upwards", "expected": True} for joint in joints]
    return json.dumps({"overall": "a plate with a flap", "parts": [], "motions": motions})


def judged(aspect: str, fault: str, *parts: str, what: str = "it is upside down", expected: str = "the other way round") -> str:
    """What a judge says who finds one problem."""
    problem = {"aspect": aspect, "parts": parts, "what": what, "expected": expected, "fault": fault, "remedy": "turn it"}
    return json.dumps(ACCEPTED | {aspect: {"ok": False, "reason": what}, "problems": [problem]})


def surveyed(request: Request) -> str:
    """What an inspector of several parts says who finds all as ordered."""
    words = "\n".join(part.text for message in request.messages for part in message.parts if isinstance(part, Text))
    agreed = {"seen": "as ordered", "agrees": True, "fault": "none", "wrong": "", "remedy": ""}
    return json.dumps({"parts": [{"part": name} | agreed for name in re.findall(r"^## (\w+)$", words, re.MULTILINE)]})


def watched(*joints: str) -> dict[str, Any]:
    """Replies of all who look, satisfied."""
    return {"look/*": LOOKS_RIGHT, "survey/*": surveyed, "observe/*": observed(*joints), "judge/*": json.dumps(ACCEPTED)}


def flap(**answers: Any) -> Scripted:
    """A model that designs the flap right at once; answers to single steps (`design__1`) may be replaced."""
    script: dict[str, Any] = {"requirements": requirements(), "design/1": json.dumps(FLAP_PLAN)}
    script |= {f"part/{name}/1": fenced(text) for name, text in FLAP_SCRIPTS.items()} | watched("hinge")
    return Scripted(script | {step.replace("__", "/"): answer for step, answer in answers.items()})


def sewing_box() -> Scripted:
    """A model that designs the example of the prompt."""
    folder = FIXTURES / "sewing_box" / "parts"
    script = {f"part/{path.stem}/1": fenced(path.read_text()) for path in folder.glob("*.py")}
    script["part/lid_left/1"] = fenced((PROMPTS / "lid_left.txt").read_text())
    script |= {"requirements": requirements("sewing_box"), "design/1": (PROMPTS / "sewing_box.json").read_text()}
    return Scripted(script)


@functools.cache
def kernel() -> Build123dKernel:
    """One kernel for all tests of a process: its start takes two seconds."""
    return Build123dKernel()


def cache(folder: Path) -> BuildCache:
    """An empty cache of a test's own."""
    return BuildCache(folder / "cache")


@functools.cache
def shared_cache() -> BuildCache:
    """One cache for all tests of a process that do not ask what is in it."""
    folder = tempfile.TemporaryDirectory(prefix="articad-tests-")
    atexit.register(folder.cleanup)
    return BuildCache(Path(folder.name))


def settings(**given: Any) -> dict[str, Any]:
    """Return the arguments `options` and `services` of a run made of the keywords of either; others stay.

    Unless stated otherwise, each part is asked for alone and looked at.
    """
    given = {"together": 1, "look": True} | given
    found: dict[str, Any] = {}
    for argument, kind in (("options", RunOptions), ("services", Services)):
        names = {field.name for field in fields(kind)} & given.keys()
        found[argument] = kind(**{name: given.pop(name) for name in names})
    return found | given
