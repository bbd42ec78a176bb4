"""The paper's ablations and its baseline: each leaves out what it says, keeps the rest, and is replayed byte for byte."""

from __future__ import annotations

import argparse
import copy
import json
from pathlib import Path
from typing import Any, get_args

import pytest

from articad.agents.late import ENDING
from articad.agents.llm import Scripted
from articad.agents.pipeline import generate, replay
from articad.agents.prompts import prompt_file
from articad.agents.recollection import StoredMemory, remember
from articad.agents.replies import parse_script
from articad.agents.settings import Services, Variant
from articad.agents.single import _plan, _whole
from articad.commands.command import COMMANDS
from articad.errors import ContractError
from articad.memory.case import Case
from articad.memory.experience import ExperienceStore
from articad.runs.run import Run
from tests.agents import stories
from tests.agents.stories import FLAP_PLAN, FLAP_SCRIPTS, fenced, judged, watched

CONNECTIONS: dict[str, Any] = {
    "connectors": {part["name"]: part["connectors"] for part in FLAP_PLAN["parts"]},
    "joints": FLAP_PLAN["joints"],
    "freedoms": 1,
}
BARE_SCRIPTS = {
    name: "\n".join("    return shape, {}" if line.startswith("    return") else line for line in script.splitlines())
    for name, script in FLAP_SCRIPTS.items()
}


def bare_plan() -> dict[str, Any]:
    plan = copy.deepcopy(FLAP_PLAN)
    for part in plan["parts"]:
        del part["connectors"]
    return plan | {"joints": [], "freedoms": 0}


def late(**answers: Any) -> Scripted:
    script: dict[str, Any] = {
        "requirements": stories.requirements(),
        "design/1": json.dumps(bare_plan()),
        "connect/1": json.dumps(CONNECTIONS),
    }
    script |= {f"part/{name}/1": fenced(text) for name, text in BARE_SCRIPTS.items()} | watched("hinge")
    return Scripted(script | {step.replace("__", "/"): answer for step, answer in answers.items()})


def made(folder: Path, llm: Scripted, **options: Any) -> Run:
    return generate(
        stories.FLAP_PROMPT, llm=llm, out=folder, **stories.settings(kernel=stories.kernel(), cache=stories.shared_cache(), **options)
    )


def said(llm: Scripted, step: str) -> str:
    request = next(request for request in llm.requests if request.step == step)
    return "\n".join(part["text"] for message in request.to_json()["messages"] for part in message["content"] if part["type"] == "text")


def assert_replayed(run: Run, folder: Path) -> None:
    again = replay(run.path, out=folder, strict=True, services=Services(kernel=stories.kernel(), cache=stories.shared_cache()))
    assert again.differences == ()


def test_there_is_one_spelling_of_the_variants_everywhere() -> None:
    parser = argparse.ArgumentParser()
    COMMANDS["generate"].arguments(parser)
    (choices,) = [action.choices for action in parser._actions if action.dest == "variant"]
    assert tuple(choices or ()) == get_args(Variant) == ("full", "late", "no-rollback", "no-memory", "single-loop")


@pytest.mark.parametrize("variant", ["no-rollback", "no-memory"])
def test_what_a_variant_does_not_leave_out_is_asked_in_the_same_words(tmp_path: Path, variant: Variant) -> None:
    keys = {}
    for name in ("full", variant):
        llm = stories.flap()
        made(tmp_path / name, llm, variant=name)
        keys[name] = {request.step: request.key for request in llm.requests}
    assert keys[variant].items() <= keys["full"].items()
    assert {"requirements", "design/1", "part/flap/1", "part/plate/1"} <= keys[variant].keys()
    assert (keys[variant] == keys["full"]) == (variant == "no-memory")


# ---------------------------------------------------------------------- late


def test_late_connects_parts_that_were_made_without_connections(tmp_path: Path) -> None:
    llm = late()
    run = made(tmp_path / "run", llm, variant="late")

    assert (run.checks() or {})["ok"]
    assert [step for step in llm.steps if not step.startswith(("part", "look"))] == [
        "requirements",
        "design/1",
        "connect/1",
        "observe/1",
        "judge/1/1",
    ]
    for name in ("plate", "flap"):
        assert said(llm, f"part/{name}/1").endswith("connectors:")
        assert (run.script(name) or b"").endswith(ENDING)
        assert BARE_SCRIPTS[name].strip().splitlines()[-2] in said(llm, "connect/1")
    assert "hinge" not in said(llm, "part/plate/1").split("The specification:")[1]
    assert "Measured, in its own frame: from (0, 0, 0) to (40, 10, 10) mm" in said(llm, "connect/1")
    assert [joint["name"] for joint in json.loads(run.plan_text() or "")["joints"]] == ["hinge"]
    case = remember(run, ExperienceStore(tmp_path / "memory"))
    assert case is not None
    assert case.parts == ()  # scripts that know no connectors are no examples to others
    assert_replayed(run, tmp_path / "again")


def test_late_leaves_out_connections_that_the_designer_states_all_the_same(tmp_path: Path) -> None:
    llm = late(design__1=json.dumps(FLAP_PLAN))
    made(tmp_path / "run", llm, variant="late", look=False, inspection=False)
    assert llm.steps.count("design/1") == 1
    assert "design/2" not in llm.steps
    assert '"axis"' not in said(llm, "connect/1").split("The plan of its parts")[1].split("The parts as they were made")[0]


def test_late_connections_that_do_not_hold_go_back_to_who_wrote_them(tmp_path: Path) -> None:
    wrong = copy.deepcopy(CONNECTIONS)
    wrong["connectors"]["flap"][0]["o"] = [0, 5, 3]
    strange = CONNECTIONS | {"connectors": {"flop": []}}
    llm = late(connect__1=json.dumps(wrong), connect__2=json.dumps(strange), connect__3="none", connect__4=json.dumps(CONNECTIONS))
    run = made(tmp_path / "run", llm, variant="late", look=False, inspection=False)

    assert "E_MATE_OFFSET" in said(llm, "connect/2")
    assert "flop is not a part" in said(llm, "connect/3")
    assert "could not be read" in said(llm, "connect/4")
    assert sorted(step for step in llm.steps if step.startswith("part")) == ["part/flap/1", "part/plate/1"]
    assert (run.checks() or {})["ok"]


def test_late_findings_go_back_to_the_list_of_parts_and_only_changed_ones_are_made_again(tmp_path: Path) -> None:
    changed = bare_plan()
    changed["parts"][1]["description"] += " Thin."
    llm = late(
        judge__1__1=judged("placement", "design", "flap"),
        design__2=json.dumps(changed),
        connect__2=json.dumps(CONNECTIONS),
        part__flap__2=fenced(BARE_SCRIPTS["flap"] + "\n# thinner"),
    )
    run = made(tmp_path / "run", llm, variant="late")
    stored = run.round(1) or {}

    assert "part/plate/2" not in llm.steps
    assert "upside down" in said(llm, "design/2")
    assert "upside down" in said(llm, "connect/2")
    assert (stored["kept"], stored["regenerated"]) == (["plate"], ["flap"])
    assert_replayed(run, tmp_path / "again")


def test_late_scripts_that_are_mended_after_the_assembly_are_kept(tmp_path: Path) -> None:
    llm = late(judge__1__1=judged("placement", "code", "flap"), part__flap__2=fenced(BARE_SCRIPTS["flap"] + "\n# mended"))
    run = made(tmp_path / "run", llm, variant="late", look=False)

    assert b"# mended" in (run.script("flap") or b"")
    assert ENDING.decode().strip() not in said(llm, "part/flap/2")
    assert "design/2" not in llm.steps
    assert (run.round(1) or {})["regenerated"] == ["flap"]


# ---------------------------------------------------------------------- single loop


SINGLE = """
from build123d import Align, Box, Pos

ASSEMBLY = {
    "name": "flap",
    "ground": "plate",
    "parts": [{"name": "plate"}, {"name": "flap", "material": "steel"}],
    "joints": [{"name": "hinge", "type": "revolute", "parent": "plate", "child": "flap", "at": [0, 5, 10], "axis": [0, -1, 0], "angle_deg": [0, 90]}],
    "materials": [{"name": "steel", "density_kg_m3": 7850, "color": "#8a9299"}],
}

def build(part):
    low = (Align.MIN,) * 3
    if part.name == "plate":
        return Box(40, 10, 10, align=low), {}
    return Pos(0, 0, 11) * Box(30, 10, 2, align=low), {}
"""


def test_the_single_loop_asks_for_one_script_and_nothing_else(tmp_path: Path) -> None:
    llm = Scripted({"script/1": fenced(SINGLE)})
    run = made(tmp_path / "run", llm, variant="single-loop")

    assert llm.steps == ["script/1"]
    assert run.part_names() == ("flap", "plate")
    assert len({run.script(name) for name in run.part_names()}) == 1
    assert (run.checks() or {})["ok"]
    assert (run.assembly() or {})["freedoms"] == 1
    assert (run.assembly() or {})["parts"]["flap"]["mass_kg"] == pytest.approx(7850e-9 * 30 * 10 * 2)
    assert set(run.exports()) == {"urdf", "mjcf"}
    assert_replayed(run, tmp_path / "again")


@pytest.mark.parametrize(
    ("broken", "told"),
    [
        (SINGLE.replace("ASSEMBLY =", "OTHER ="), "does not define ASSEMBLY"),
        (SINGLE.replace("[0, 90]", "[0, 45 * 2]"), "not a plain literal"),
        (SINGLE.replace('"ground": "plate",', ""), "ground: Field required"),
        (SINGLE.replace('"child": "flap"', '"child": "flop"'), "flop"),
        (SINGLE.replace("Box(40, 10, 10", "Box(40, 10, 0"), "E_"),
        (SINGLE.replace("def build(part):", "def build(part):\n  if 1"), "not Python"),
    ],
)
def test_what_fails_to_run_goes_back(tmp_path: Path, broken: str, told: str) -> None:
    llm = Scripted({"script/1": fenced(broken), "script/2": fenced(SINGLE)})
    made(tmp_path / "run", llm, variant="single-loop")
    assert llm.steps == ["script/1", "script/2"]
    assert told in said(llm, "script/2")


def test_after_five_retries_the_single_loop_ends(tmp_path: Path) -> None:
    llm = Scripted({"script/*": fenced(SINGLE.replace("Box(40, 10, 10", "Box(40, 10, oops"))})
    with pytest.raises(ContractError, match="oops"):
        made(tmp_path / "run", llm, variant="single-loop")
    assert len(llm.steps) == 6


def test_what_runs_but_collides_is_reported_and_not_sent_back(tmp_path: Path) -> None:
    llm = Scripted({"script/1": fenced(SINGLE.replace("Pos(0, 0, 11)", "Pos(0, 0, 8)"))})
    run = made(tmp_path / "run", llm, variant="single-loop")
    assert [finding["code"] for finding in (run.checks() or {})["findings"]] == ["E_STATIC_OVERLAP"]


def test_the_baseline_recalls_nothing(tmp_path: Path) -> None:
    store = ExperienceStore(tmp_path / "memory")
    store.add(Case(kind="good", prompt=stories.FLAP_PROMPT, design="a flap"))
    keys = []
    for name, memory in (("off", None), ("on", StoredMemory(store))):
        llm = Scripted({"script/1": fenced(SINGLE)})
        made(tmp_path / name, llm, variant="single-loop", memory=memory)
        keys.append([request.key for request in llm.requests])
    assert keys[0] == keys[1]


def test_the_script_that_the_prompt_shows_is_of_the_form_that_is_read() -> None:
    shown = prompt_file("single.md").split("```python\n")[1].split("```")[0]
    plan = _plan(_whole(parse_script(fenced(shown + "\ndef build(part):\n    pass"), step="x"), "", "x"), "build123d")
    assert plan.freedoms == 1
