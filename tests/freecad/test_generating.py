"""`articad generate --kernel freecad`, from a prompt to a document that a person can edit, with scripted answers."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from articad import cli
from articad.agents.llm import Scripted
from articad.runs.run import Run
from tests.agents import stories
from tests.freecad import opened

pytestmark = [pytest.mark.freecad, opened.needs_freecad]

PLATE = """
def build(part):
    part.box((0, 0, 0), ("length", "side", "side"), name="Bar")
    return part.body, {"axis": part.connector("axis", (0, "side / 2", "side"), (0, -1, 0), (1, 0, 0))}
"""
FROZEN = """
import Part

def build(part):
    d = part.dimensions
    solid = part.document.addObject("Part::Feature", "Solid")
    solid.Shape = Part.makeBox(d["length"], d["side"], d["side"])
    part.body.BaseFeature = solid
    part.document.recompute()
    return part.body, {"axis": {"o": (0, d["side"] / 2, d["side"]), "z": (0, -1, 0), "x": (1, 0, 0)}}
"""
FLAP = """
def build(part):
    part.box((0, 0, "lift"), ("length", "side", "thickness"), name="Leaf")
    return part.body, {"axis": part.connector("axis", (0, "side / 2", 0), (0, -1, 0), (1, 0, 0))}
"""


def test_a_prompt_becomes_an_editable_document_and_replays(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ARTICAD_CACHE", str(tmp_path / "cache"))
    monkeypatch.setenv("ARTICAD_MEMORY", str(tmp_path / "memory"))
    model = Scripted(
        {
            "requirements": stories.requirements(),
            "design/1": json.dumps(stories.FLAP_PLAN),
            "part/plate/1": stories.fenced(FROZEN),
            "part/plate/2": stories.fenced(PLATE),
            "part/flap/1": stories.fenced(FLAP),
        }
    )
    monkeypatch.setattr("articad.agents.live.LiteLLM", lambda *_, **__: model)

    def report(*arguments: object) -> tuple[int, dict[str, Any]]:
        code = cli.main([*map(str, arguments), "--json"])
        return code, json.loads(capsys.readouterr().out)

    made = tmp_path / "made"
    words = ["--kernel", "freecad", "--model", "scripted", "--no-look", "--no-inspection", "--export", "urdf,freecad", "--out", made]
    code, told = report("generate", stories.FLAP_PROMPT, *words)
    assert (code, told["ok"]) == (0, True)

    asked = {request.step: json.dumps([message.to_json() for message in request.messages]) for request in model.requests}
    assert "PartDesign body with a feature tree" in asked["part/flap/1"]
    assert "E_NOT_EDITABLE" in asked["part/plate/2"]  # a frozen shape goes back to its author
    assert "no sketch drives it" in asked["part/plate/2"]
    assert "part.rectangle" in asked["part/plate/2"]

    run = Run.view(made)
    assert set(run.exports()) == {"urdf", "freecad"}
    assert {path.parent.name for path in made.glob("parts/*/part.FCStd")} == {"plate", "flap"}
    views = {path.parents[1].name for path in made.glob("parts/*/views/*.png")}
    assert views == {"plate", "flap"}  # a process of its own that needs FreeCAD, too, draws them
    (document,) = made.glob("export/freecad/*.FCStd")
    before, after = opened.steps(document.read_bytes(), {"do": "look"}, {"do": "set", "values": {"lift": 4.0}})
    assert before["articad"] is False
    assert before["invalid"] == after["invalid"] == []
    assert [corner[2] for corner in before["boxes"]["flap"]] == pytest.approx([1.0, 3.0])
    assert [corner[2] for corner in after["boxes"]["flap"]] == pytest.approx([4.0, 6.0])

    code, again = report("replay", made, "--out", tmp_path / "again", "--strict")
    assert (code, again["ok"], again["differences"]) == (0, True, [])
