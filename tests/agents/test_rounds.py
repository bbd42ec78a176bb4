"""What happens after a part is built: looked at, judged, and sent back to the plan or to one script; with the real kernel."""

from __future__ import annotations

import contextlib
import copy
import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from articad.agents import evidence
from articad.agents.design import _DIALECTS, Designer
from articad.agents.llm import Image, Replay, Request, Scripted, closed_port, require_open_port
from articad.agents.part_writer import _EXAMPLES
from articad.agents.pipeline import generate, replay
from articad.agents.requirements import Requirements
from articad.agents.settings import Services
from articad.errors import ContractError, TransportError
from articad.findings import Finding, Findings
from articad.plan.schema import AssemblyPlan
from articad.render.pictures import RECIPE
from articad.runs.record import assembly_of
from articad.runs.run import Run, differences
from tests.agents import stories
from tests.agents.stories import FLAP_PLAN, FLAP_SCRIPTS, LOOKS_RIGHT, fenced, flap, judged, looks, observed, watched

THINNER = FLAP_SCRIPTS["flap"].replace('d["thickness"]', '0.9 * d["thickness"]')


def made(tmp_path: Path, llm: Any, name: str = "run", **options: Any) -> Run:
    return generate(
        "a product", llm=llm, out=tmp_path / name, **stories.settings(kernel=stories.kernel(), cache=stories.shared_cache(), **options)
    )


def said(llm: Scripted, step: str) -> str:
    request = next(request for request in llm.requests if request.step == step)
    return "\n".join(part["text"] for message in request.to_json()["messages"] for part in message["content"] if part["type"] == "text")


def recipes(llm: Scripted, step: str) -> list[dict[str, Any]]:
    request = next(request for request in llm.requests if request.step == step)
    pictures = [part for message in request.messages for part in message.parts if isinstance(part, Image)]
    assert all(picture.content.startswith(b"\x89PNG") for picture in pictures)
    return [dict(picture.recipe or {}) for picture in pictures]


def codes(report: dict[str, Any] | None) -> list[str]:
    assert report is not None
    return [finding["code"] for finding in report["findings"]]


def changed_flap(note: str = " Thin.") -> str:
    plan = copy.deepcopy(FLAP_PLAN)
    plan["parts"][1]["description"] += note
    return json.dumps(plan)


# ---------------------------------------------------------------------- a wheel on a pin


def wheel_plan(bore: str = "bore_axis", **changes: Any) -> dict[str, Any]:
    """A plan with a pin in a bore; `bore` is the kind of the wheel's connector."""
    pin = {"name": "pin", "kind": "shaft_axis", "o": [0, 0, 5], "z": [0, 0, 1], "x": [1, 0, 0], "label": "axis of the pin"}
    plan = {
        "schema": "articad.plan/1",
        "name": "wheel",
        "ground": "post",
        "freedoms": 1,
        "materials": [{"name": "steel", "density_kg_m3": 7850, "color": "#8a9299"}],
        "parts": [
            {
                "name": "post",
                "material": "steel",
                "description": "Box of side in x and y about the origin, z from 0 to 5, with a pin of radius, z from 5 to 12.",
                "dimensions": {"side": 24, "radius": 3},
                "connectors": [pin],
            },
            {
                "name": "wheel",
                "material": "steel",
                "description": "Disc of radius about z, z from 0 to width, with a bore of bore_radius through it.",
                "dimensions": {"radius": 10, "width": 6, "bore_radius": 3.2},
                "rest_pose": {"at": [0, 0, 5]},
                "connectors": [pin | {"name": "bore", "kind": bore, "o": [0, 0, 0], "label": "axis of the bore"}],
            },
        ],
        "joints": [{"name": "turn", "type": "revolute", "parent": "post.pin", "child": "wheel.bore", "angle_deg": "endless"}],
    }
    return plan | changes


POST = """
from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)

def build(part):
    d = part.dimensions
    shape = Box(d["side"], d["side"], 5, align=LOW) + Cylinder(d["radius"], 12, align=LOW)
    return shape, {"pin": {"o": (0, 0, 5), "z": (0, 0, 1), "x": (1, 0, 0)}}
"""
WHEEL = """
from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)

def build(part):
    d = part.dimensions
    shape = Cylinder(d["radius"], d["width"], align=LOW) - Pos(0, 0, -1) * Cylinder(d["bore_radius"], d["width"] + 2, align=LOW)
    return shape, {"bore": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
"""
TIGHT = WHEEL.replace('Cylinder(d["bore_radius"]', 'Cylinder(d["bore_radius"] - 0.7')
ASIDE = WHEEL.replace("Pos(0, 0, -1)", 'Pos(d["bore_radius"] / 4, 0, -1)')
CONE = ASIDE.replace('Cylinder(d["bore_radius"]', 'Cone(d["bore_radius"], 1.02 * d["bore_radius"]').replace("Align, ", "Align, Cone, ")
SOLID = WHEEL.replace("Pos(0, 0, -1)", "Pos(0, 0, 50)")


def wheel(bore: str = "bore_axis", **answers: Any) -> Scripted:
    script: dict[str, Any] = {"requirements": stories.requirements("wheel"), "design/1": json.dumps(wheel_plan(bore))}
    script |= {"part/post/1": fenced(POST), "part/wheel/1": fenced(WHEEL)} | watched("turn")
    return Scripted(script | {step.replace("__", "/"): answer for step, answer in answers.items()})


# ---------------------------------------------------------------------- looking at a part


def test_every_part_is_looked_at_once_then_the_whole_is_observed_and_judged(tmp_path: Path) -> None:
    llm = flap()
    run = made(tmp_path, llm)

    assert sorted(llm.steps) == sorted(
        ["requirements", "design/1", "part/plate/1", "part/flap/1", "look/plate/1", "look/flap/1", "observe/1", "judge/1/1"]
    )
    assert recipes(llm, "look/flap/1")[0]["of"] == "part"
    assert [recipe["of"] for recipe in recipes(llm, "observe/1")] == ["assembly", "motion"]
    assert recipes(llm, "judge/1/1") == []
    told = said(llm, "judge/1/1")
    assert "Exact checks: passed." in told
    assert "Mobility: 1 freedoms" in told
    assert "- hinge: 0 to 90 degrees, drives" in told
    assert "- flap: from (0, 0, 11) to (30, 10, 13)" in told
    assert "turns upwards" in told
    verdict = run.verdict()
    assert verdict is not None
    assert (verdict["ok"], verdict["by"], verdict["round"]) == (True, "judge", 1)


def test_a_warning_that_no_check_fails_by_does_not_stand_beside_the_checks_that_passed(tmp_path: Path) -> None:
    assembly = assembly_of(made(tmp_path, flap()), cache=stories.shared_cache())
    partly = Finding(code="W_JOINT_PARTLY_MADE", where="joints.hinge", message="The flap slides off its pin.", hint="Add a collar.")

    told = evidence.told(assembly, replace(evidence.examine(assembly), joints=Findings([partly])))
    (checked,) = [block for block in told.split("\n\n") if block.startswith("Exact checks: passed.")]
    assert "W_" not in checked
    assert f"that a part is not secured along its axis is no fault):\n- {partly}" in told


def test_an_observer_compares_with_the_customers_pictures_and_a_judge_reads_what_it_saw(tmp_path: Path) -> None:
    sketch = b"\x89PNG\r\n\x1a\n" + bytes(16)
    llm = flap()
    made(tmp_path, llm, images=[sketch], part_images={"flap": sketch + b"2"})

    assert [recipe.get("of") for recipe in recipes(llm, "observe/1")] == [None, "assembly", "motion"]
    request = next(request for request in llm.requests if request.step == "observe/1")
    first = next(part for message in request.messages for part in message.parts if isinstance(part, Image))
    assert first.content == sketch
    assert "The customer's own pictures of what is wanted, not of what was built:" in said(llm, "observe/1")
    assert recipes(llm, "judge/1/1") == []  # it may be a model that does not see
    for step in ("design/1", "observe/1", "judge/1/1"):
        assert "where numbers differ, what the request states binds, then the plan" in said(llm, step)


def test_a_designer_is_told_in_which_language_the_parts_are_written(tmp_path: Path) -> None:
    llm = flap()
    run = made(tmp_path, llm)
    assert "The parts will be scripted in build123d." in said(llm, "design/1")

    request = replace(run.request, options={**run.request.options, "kernel": "freecad"})
    again = flap()
    Designer(request, Requirements.model_validate_json(stories.requirements()), again).first()
    assert "scripted in FreeCAD" in said(again, "design/1")
    assert "no ready function for a sweep, a helix or thread" in said(again, "design/1")
    assert set(_DIALECTS) == set(_EXAMPLES)


def test_the_recipe_of_pictures_is_that_of_the_renderer() -> None:
    from articad.agents import pictures

    assert pictures._RECIPE == RECIPE


def test_what_an_inspector_sees_goes_back_to_the_parts_author_with_the_picture(tmp_path: Path) -> None:
    llm = flap(part__flap__1=fenced(THINNER), look__flap__1=looks("proportion"), part__flap__2=fenced(FLAP_SCRIPTS["flap"]))
    run = made(tmp_path, llm)
    told = said(llm, "part/flap/2")

    assert "Seen: a cube. Specified: a plate. make it thinner" in told
    assert recipes(llm, "part/flap/2")[0]["of"] == "part"
    assert "look/flap/2" in llm.steps
    assert "part/plate/2" not in llm.steps
    assert codes(run.verdict()) == []


def test_an_author_who_stands_by_the_script_is_not_asked_a_third_time_and_the_opinion_is_kept(tmp_path: Path) -> None:
    llm = flap(look__flap__1=looks("shape"), part__flap__2=fenced(FLAP_SCRIPTS["flap"]))
    run = made(tmp_path, llm)

    assert [step for step in llm.steps if "flap" in step] == ["part/flap/1", "look/flap/1", "part/flap/2"]
    assert codes(run.verdict()) == ["W_LOOK_SHAPE"]
    assert (run.verdict() or {})["ok"]


def test_a_specification_that_an_inspector_finds_at_fault_goes_to_the_designer_once(tmp_path: Path) -> None:
    llm = flap(look__flap__1=looks("orientation", "specification"), design__2=json.dumps(FLAP_PLAN))
    run = made(tmp_path, llm)

    assert [step for step in llm.steps if step.startswith("design")] == ["design/1", "design/2"]
    assert "W_LOOK_ORIENTATION parts.flap" in said(llm, "design/2")
    assert (run.round(1) or {})["kept"] == ["plate", "flap"]


def test_what_no_picture_shows_is_told_in_the_trace_and_is_no_complaint(tmp_path: Path) -> None:
    answer = json.loads(LOOKS_RIGHT)
    answer["findings"][0]["not_visible"] = "the blind end of the bore."
    llm = flap(look__flap__1=json.dumps(answer))
    run = made(tmp_path, llm)

    assert [step for step in llm.steps if "flap" in step] == ["part/flap/1", "look/flap/1"]
    assert codes(run.verdict()) == []
    (told,) = [event for event in run.events() if event.get("code") == "I_LOOK_UNSEEN"]
    assert told["message"] == "No picture shows: the blind end of the bore."


def test_a_look_without_form_is_no_complaint(tmp_path: Path) -> None:
    llm = flap(look__flap__1="Very nice.", look__flap__1__2="Nice.", look__flap__1__3="Quite nice.")
    made(tmp_path, llm)

    assert [step for step in llm.steps if "flap" in step] == ["part/flap/1", "look/flap/1", "look/flap/1/2", "look/flap/1/3"]


def test_the_same_failure_twice_asks_for_another_approach_and_the_third_time_ends_it(tmp_path: Path) -> None:
    nothing = fenced("def build(part):\n    return None")
    llm = flap(**{f"part__flap__{n}": nothing for n in range(1, 6)})
    with pytest.raises(ContractError, match="1 of 2 parts could not be made"):
        made(tmp_path, llm, rounds=1, repairs=4)

    assert [step for step in llm.steps if step.startswith("part/flap")] == ["part/flap/1", "part/flap/2", "part/flap/3"]
    assert "Mend it, and answer" in said(llm, "part/flap/2")
    assert "Model the part from the start in another way" in said(llm, "part/flap/3")


# ---------------------------------------------------------------------- judging the whole


def test_a_judge_sends_a_wrong_motion_to_the_designer(tmp_path: Path) -> None:
    llm = flap(
        judge__1__1=judged("motion", "design", "flap", "plate"), design__2=changed_flap(), part__flap__2=fenced(FLAP_SCRIPTS["flap"])
    )
    run = made(tmp_path, llm)

    assert "E_VERDICT_MOTION parts.flap: it is upside down. Expected: the other way round." in said(llm, "design/2")
    assert [recipe["of"] for recipe in recipes(llm, "design/2")] == ["offence"]
    stored = run.round(1) or {}
    assert (stored["kept"], stored["regenerated"], stored["new"], stored["removed"]) == (["plate"], ["flap"], [], [])
    assert (run.verdict() or {})["round"] == 2


@pytest.mark.parametrize(
    ("change", "code"),
    [({"o": [0, 5, 2]}, "E_MATE_OFFSET"), ({"z": [0, 1, 0]}, "E_MATE_FLIP"), ({"x": [-1, 0, 0]}, "E_MATE_ROLL")],
    ids=["beside", "turned over", "rolled"],
)
def test_a_wrong_mate_goes_back_to_the_designer_before_anything_is_built(tmp_path: Path, change: dict[str, Any], code: str) -> None:
    plan = copy.deepcopy(FLAP_PLAN)
    plan["parts"][1]["connectors"][0] |= change
    llm = flap(design__1=json.dumps(plan), design__2=json.dumps(FLAP_PLAN))

    run = made(tmp_path, llm)

    assert code in said(llm, "design/2")
    assert llm.steps.index("design/2") < min(index for index, step in enumerate(llm.steps) if step.startswith("part/"))
    assert (run.checks() or {})["ok"]


def test_a_mate_that_turns_the_wrong_way_is_found_by_the_motion_and_goes_to_the_designer(tmp_path: Path) -> None:
    plan = copy.deepcopy(FLAP_PLAN)
    plan["joints"][0]["angle_deg"] = [-90, 0]  # down, into the plate
    llm = flap(design__1=json.dumps(plan), design__2=json.dumps(FLAP_PLAN))

    run = made(tmp_path, llm)

    assert "E_MOTION_COLLISION" in said(llm, "design/2")
    assert [step for step in llm.steps if step.startswith("part/")].count("part/plate/1") == 1
    assert (run.checks() or {})["ok"]


def test_a_judge_sends_a_part_that_is_not_as_specified_to_its_author(tmp_path: Path) -> None:
    llm = flap(judge__1__1=judged("placement", "code", "flap"), part__flap__2=fenced(FLAP_SCRIPTS["flap"]), part__flap__1=fenced(THINNER))
    run = made(tmp_path, llm)
    told = said(llm, "part/flap/2")

    assert "design/2" not in llm.steps
    assert "part/plate/2" not in llm.steps
    assert "E_VERDICT_PLACEMENT parts.flap" in told
    assert "0.9 * d" in told  # its own previous answer
    assert [recipe["of"] for recipe in recipes(llm, "part/flap/2")] == ["offence"]
    assert (run.round(1) or {})["regenerated"] == ["flap"]


def test_interference_that_exact_checks_exclude_is_overruled(tmp_path: Path) -> None:
    llm = flap(judge__1__1=judged("interference", "design", "flap", "plate"))
    run = made(tmp_path, llm)

    assert "design/2" not in llm.steps
    assert codes(run.verdict()) == ["I_OVERRULED"]
    assert (run.verdict() or {})["ok"]


@pytest.mark.parametrize(
    ("answer", "complaint"),
    [
        (judged("motion", "design", "handle"), "there is no part handle; there are plate, flap"),
        (judged("motion", "code"), 'whose fault is "code" names the part'),
        (json.dumps(json.loads(judged("motion", "design", "flap")) | {"problems": []}), '"motion" is not ok, but no problem says why'),
    ],
)
def test_a_judgement_that_contradicts_itself_is_asked_for_again(tmp_path: Path, answer: str, complaint: str) -> None:
    llm = flap(judge__1__1=answer, judge__1__1__2=json.dumps(stories.ACCEPTED))
    made(tmp_path, llm)

    assert complaint in said(llm, "judge/1/1/2")


def test_an_observer_who_leaves_out_a_motion_is_asked_for_it(tmp_path: Path) -> None:
    llm = flap(observe__1=observed(), observe__1__2=observed("hinge"))
    made(tmp_path, llm)

    assert "nothing is said of hinge" in said(llm, "observe/1/2")


def test_without_rollback_nobody_looks_and_nothing_that_was_assembled_goes_back(tmp_path: Path) -> None:
    llm = wheel(part__wheel__1=fenced(TIGHT))
    run = made(tmp_path, llm, variant="no-rollback")

    assert sorted(llm.steps) == ["design/1", "part/post/1", "part/wheel/1", "requirements"]
    assert codes(run.checks()) == ["E_STATIC_OVERLAP"]
    assert run.verdict() is None


# ---------------------------------------------------------------------- plan or script


def test_a_hole_that_is_too_small_goes_to_the_script_with_the_bore(tmp_path: Path) -> None:
    llm = wheel(part__wheel__1=fenced(TIGHT), part__wheel__2=fenced(WHEEL))
    run = made(tmp_path, llm)

    assert "E_STATIC_OVERLAP" in said(llm, "part/wheel/2")
    assert recipes(llm, "part/wheel/2")[0]["of"] == "offence"
    assert [step for step in llm.steps if step.startswith(("design", "rollback", "part/post"))] == ["design/1", "part/post/1"]
    assert llm.steps.count("judge/1/1") == 0  # no opinion was asked for what is measured
    assert llm.steps.count("judge/2/1") == 1
    stored = run.round(1) or {}
    assert list(stored["code"]) == ["wheel"]
    assert (stored["kept"], stored["regenerated"]) == (["post"], ["wheel"])
    assert (run.checks() or {})["ok"]


def test_a_hole_that_was_not_bored_goes_to_the_script_with_the_number(tmp_path: Path) -> None:
    llm = wheel("frame", part__wheel__1=fenced(SOLID), part__wheel__2=fenced(WHEEL))
    run = made(tmp_path, llm)

    told = said(llm, "part/wheel/2")
    assert "post is 6 mm deep in solid material of wheel, which has no hole there." in told
    assert "wheel does not follow its dimension 'bore_radius'. Bore wheel along the axis with a diameter of 6.4 mm" in told
    assert (run.round(1) or {})["code"]["wheel"][0]["cause"] == "unbored_hole"
    assert not [step for step in llm.steps if step.startswith("rollback")]


def test_a_bore_beside_its_axis_goes_to_the_script_with_the_distance(tmp_path: Path) -> None:
    llm = wheel("frame", part__wheel__1=fenced(ASIDE), part__wheel__2=fenced(WHEEL))
    made(tmp_path, llm)

    assert "wheel has its bore of 6.4 mm 0.8 mm beside the axis of joint 'turn'." in said(llm, "part/wheel/2")
    assert not [step for step in llm.steps if step.startswith("rollback")]


def test_where_geometry_does_not_tell_a_model_decides_with_both_entries_and_scripts_before_it(tmp_path: Path) -> None:
    decision = {"fault": 1, "route": "code", "part": "wheel", "reason": "the bore is not in the middle"}
    llm = wheel("frame", part__wheel__1=fenced(CONE), part__wheel__2=fenced(WHEEL), rollback__1=json.dumps({"decisions": [decision]}))
    run = made(tmp_path, llm)
    told = said(llm, "rollback/1")

    assert "1. E_STATIC_OVERLAP" in told
    assert 'd["bore_radius"] / 4' in told
    assert "- bore_radius = 3.2" in told
    assert 'Cylinder(d["radius"], 12' in told
    assert list((run.round(1) or {})["code"]) == ["wheel"]


def test_a_decision_about_no_fault_or_no_part_is_asked_for_again(tmp_path: Path) -> None:
    nobody = {"decisions": [{"fault": 1, "route": "code", "part": "axle", "reason": "?"}]}
    design = {"decisions": [{"fault": 1, "route": "design", "part": "", "reason": "the order is wrong"}]}
    llm = wheel(
        "frame",
        part__wheel__1=fenced(CONE),
        rollback__1=json.dumps({"decisions": []}),
        rollback__1__2=json.dumps(nobody),
        rollback__1__3=json.dumps(design),
        design__2=json.dumps(wheel_plan("frame", description="bored wider")),
    )
    made(tmp_path, llm, rounds=2)

    assert "exactly one decision is needed for each of the faults 1 to 1" in said(llm, "rollback/1/2")
    assert "'axle' has no script" in said(llm, "rollback/1/3")
    assert "E_STATIC_OVERLAP" in said(llm, "design/2")


def test_a_dimension_far_longer_than_its_part_is_asked_about_once(tmp_path: Path) -> None:
    deep = wheel_plan()
    deep["parts"][1]["dimensions"]["through"] = 900
    through = WHEEL.replace("Pos(0, 0, -1)", 'Pos(0, 0, -d["through"] / 2)').replace('d["width"] + 2', 'd["through"]')
    llm = wheel(design__1=json.dumps(deep), part__wheel__1=fenced(through), design__2=json.dumps({"changes": {}}))
    run = made(tmp_path, llm)

    assert "W_SCALE parts.wheel.dimensions.through: Dimension 'through' of wheel is 900 mm" in said(llm, "design/2")
    assert [step for step in llm.steps if step.startswith(("design", "part/wheel"))] == ["design/1", "part/wheel/1", "design/2"]
    assert codes(run.verdict()) == ["W_SCALE"]
    assert (run.verdict() or {})["ok"]


def test_a_script_without_the_ordered_bore_is_sent_back_and_in_the_end_the_plan(tmp_path: Path) -> None:
    outside = 'Box(2 * d["radius"], 2 * d["radius"], d["width"], align=LOW)'
    square = ASIDE.replace('Cylinder(d["radius"], d["width"], align=LOW)', outside).replace("Align, Cyl", "Align, Box, Cyl")
    aside = {f"part__wheel__{n}": fenced(square) for n in range(1, 5)}
    llm = wheel(**aside, design__2=json.dumps(wheel_plan("frame", description="again")), part__wheel__5=fenced(WHEEL))
    made(tmp_path, llm)

    assert "Connector 'bore' of wheel is a bore_axis, but the part has nothing about its axis" in said(llm, "part/wheel/2")
    assert "E_CONNECTOR_FEATURE" in said(llm, "design/2")


def test_a_fault_that_comes_back_goes_another_way_then_with_a_demand_and_then_ends_it(tmp_path: Path) -> None:
    tight = {f"part__wheel__{n}": fenced(TIGHT) for n in range(1, 4)}
    plans = {f"design__{n}": json.dumps(wheel_plan(description=f"version {n}")) for n in range(2, 5)}
    llm = wheel(**tight, **plans)
    run = made(tmp_path, llm, rounds=9)

    assert [step for step in llm.steps if step.startswith(("design", "part/wheel"))] == [
        "design/1",
        "part/wheel/1",
        "part/wheel/2",
        "design/2",
    ]
    assert "W_STALLED" in codes(run.verdict())
    assert not (run.verdict() or {})["ok"]
    assert (run.path / "export/urdf/wheel.urdf").is_file()


def test_a_part_that_no_script_fits_goes_to_the_designer(tmp_path: Path) -> None:
    wrong = {f"part__flap__{n}": fenced("def build(part):\n    return None") for n in range(1, 5)}
    llm = flap(**wrong, design__2=changed_flap(), part__flap__5=fenced(FLAP_SCRIPTS["flap"]))
    run = made(tmp_path, llm)

    assert "Every script for flap broke its contract" in said(llm, "design/2")
    assert [step for step in llm.steps if step.startswith("part/flap")] == ["part/flap/1", "part/flap/2", "part/flap/3", "part/flap/5"]
    assert (run.round(1) or {})["kept"] == ["plate"]
    assert (run.checks() or {})["ok"]


def test_parts_that_a_new_plan_drops_are_put_aside_and_listed(tmp_path: Path) -> None:
    plan = copy.deepcopy(FLAP_PLAN)
    plan["parts"][0]["connectors"].append(
        {"name": "side", "kind": "mount_face", "o": [40, 5, 5], "z": [1, 0, 0], "x": [0, 1, 0], "label": "side"}
    )
    knob: dict[str, Any] = {
        "name": "knob",
        "material": "steel",
        "description": "Cube of side.",
        "dimensions": {"side": 5},
        "rest_pose": {"at": [40, 0, 0]},
    }
    knob["connectors"] = [{"name": "side", "kind": "mount_face", "o": [0, 5, 5], "z": [1, 0, 0], "x": [0, 1, 0], "label": "side"}]
    plan["parts"].append(knob)
    plan["joints"].append({"name": "knob", "type": "fixed", "parent": "plate.side", "child": "knob.side"})
    script = (
        "from build123d import Align, Box\n\ndef build(part):\n    side = part.dimensions['side']\n"
        "    return Box(side, 2 * side, 2 * side, align=(Align.MIN,) * 3), {'side': {'o': (0, 5, 5), 'z': (1, 0, 0), 'x': (0, 1, 0)}}"
    )
    two = FLAP_SCRIPTS["plate"].replace(
        "return shape, {", 'return shape, {"side": {"o": (d["length"], 5, 5), "z": (1, 0, 0), "x": (0, 1, 0)}, '
    )
    llm = flap(
        design__1=json.dumps(plan),
        part__plate__1=fenced(two),
        part__knob__1=fenced(script),
        judge__1__1=judged("placement", "design", "knob"),
        design__2=json.dumps(FLAP_PLAN),
        part__plate__2=fenced(FLAP_SCRIPTS["plate"]),
    )
    run = made(tmp_path, llm)
    stored = run.round(1) or {}

    assert (stored["kept"], stored["regenerated"], stored["removed"]) == (["flap"], ["plate"], ["knob"])
    assert run.part_names() == ("flap", "plate")
    assert (run.path / "removed/knob/script.py").is_file()


# ---------------------------------------------------------------------- connectors


def test_a_connector_that_a_script_places_better_is_taken_into_a_new_version_of_the_plan(tmp_path: Path) -> None:
    higher = FLAP_SCRIPTS["plate"].replace('d["side"] / 2, d["side"])', 'd["side"] / 2, d["side"] + 0.3)')
    llm = flap(part__plate__1=fenced(higher))
    run = made(tmp_path, llm)
    first, second = (AssemblyPlan.load(run.path / f"plans/{n}.json") for n in (0, 1))

    assert "part/plate/2" not in llm.steps
    assert (first.parts[0].connectors[0].o[2], second.parts[0].connectors[0].o[2]) == (10, 10.3)  # type: ignore[union-attr]
    assert json.loads(second.dumps())["parts"][1]["rest_pose"]["at"] == [0, 0, 10.3]
    assert run.plan_text() == second.dumps()
    assert "I_ABSORBED" in [event.get("code") for event in run.events()]
    assert codes(run.assembly()) == []


def test_a_connector_that_is_far_off_is_built_again(tmp_path: Path) -> None:
    far = FLAP_SCRIPTS["plate"].replace('d["side"] / 2, d["side"])', 'd["side"] / 2, d["side"] + 9)')
    llm = flap(part__plate__1=fenced(far), part__plate__2=fenced(FLAP_SCRIPTS["plate"]))
    run = made(tmp_path, llm)

    assert "E_CONNECTOR_DRIFT" in said(llm, "part/plate/2")
    assert sorted(path.name for path in (run.path / "plans").iterdir()) == ["0.json"]


# ---------------------------------------------------------------------- resumed, replayed, closed


def test_a_run_with_every_kind_of_detour_is_replayed_byte_for_byte_and_draws_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    decision = {"fault": 1, "route": "code", "part": "wheel", "reason": "the bore is not in the middle"}
    llm = wheel(
        "frame",
        part__wheel__1=fenced(CONE),
        part__wheel__2=fenced(WHEEL),
        look__post__1=looks("shape", "specification"),
        rollback__1=json.dumps({"decisions": [decision]}),
        design__2=json.dumps(wheel_plan("frame", description="again")),
        judge__2__1=judged("motion", "design", "wheel"),
        design__3=json.dumps(wheel_plan("frame", description="and again")),
    )
    run = made(tmp_path, llm)
    monkeypatch.setattr("articad.agents.pictures._drawing", None)  # who draws fails
    again = replay(run.path, out=tmp_path / "again", strict=True, services=Services(kernel=stories.kernel(), cache=stories.shared_cache()))

    assert {"rollback/1", "judge/2/1", "design/3", "judge/3/1"} <= set(llm.steps)
    assert again.differences == ()
    assert len(again.findings) == 0


def test_a_budget_that_ends_anywhere_is_gone_on_with_and_no_call_is_repeated(tmp_path: Path) -> None:
    answers = {"part__wheel__1": fenced(TIGHT), "part__wheel__2": fenced(WHEEL)}
    whole = made(tmp_path, wheel(**answers), "whole")
    steps: list[str] = []
    for _ in range(len(whole.replies())):
        one = wheel(**answers)

        class Once:
            """Answers one question, then is out of reach."""

            def __init__(self, llm: Scripted) -> None:
                self.llm = llm

            def complete(self, request: Request) -> Any:
                if self.llm.requests:
                    raise TransportError("gone")
                return self.llm.complete(request)

        with contextlib.suppress(TransportError):
            run = made(tmp_path, Once(one), jobs=1)
        steps += one.steps
    assert sorted(steps) == sorted(set(steps)) == sorted(whole.replies())
    assert list(differences(whole, run)) == []
    assert list(differences(whole, made(tmp_path, Replay(whole.path, strict=True), "replayed"))) == []


def test_between_the_last_part_and_the_first_inspection_the_port_is_closed(tmp_path: Path) -> None:
    model, asked = flap(), []

    class Live:
        """A model like any live one: it asks whether it may be called."""

        def complete(self, request: Request) -> Any:
            require_open_port()
            return model.complete(request)

    live = Live()

    def tell(what: str, _: str) -> None:
        if what == "assembly":
            with closed_port("the test says so"), pytest.raises(TransportError, match="No model may be called"):
                live.complete(Request("part", "part/flap/1", ()))
        if what in {"assembly", "check", "inspection"}:
            asked.append((what, len(model.requests)))

    made(tmp_path, live, progress=tell)

    whats = [what for what, _ in asked]
    assert list(dict.fromkeys(whats)) == ["assembly", "check", "inspection"]
    assert len({calls for _, calls in asked[: whats.index("inspection") + 1]}) == 1


def test_a_model_that_raises_when_it_is_called_does_not_disturb_assembly_and_checks(tmp_path: Path) -> None:
    model = flap()
    state = {"open": True}

    class Guarded:
        """Raises between assembly and inspection."""

        def complete(self, request: Request) -> Any:
            assert state["open"]
            return model.complete(request)

    def tell(what: str, event: str) -> None:
        if (what, event) == ("assembly", "started"):
            state["open"] = False
        if what == "inspection":
            state["open"] = True

    assert (made(tmp_path, Guarded(), progress=tell).checks() or {})["ok"]


def not_seen(*joints: str, parts: Sequence[str] = ()) -> str:
    """What an observer says whose pictures show nothing of these."""
    motions = [{"joint": joint, "seen": "six pictures alike", "expected": "not seen"} for joint in joints]
    return json.dumps(
        {"overall": "a box", "parts": [{"part": part, "seen": "hidden", "expected": "not seen"} for part in parts], "motions": motions}
    )


def test_of_what_an_observer_does_not_see_it_gets_other_pictures(tmp_path: Path) -> None:
    seen = json.loads(observed("hinge")) | {"parts": [{"part": "flap", "seen": "a plate", "expected": True}]}
    llm = flap(observe__1=not_seen("hinge", parts=["flap"]), observe__1__unseen=json.dumps(seen))
    run = made(tmp_path, llm)

    recipe_of_part, recipe_of_motion = recipes(llm, "observe/1/unseen")
    assert (recipe_of_part["of"], recipe_of_part["through"]) == ("assembly", ["flap"])
    assert (recipe_of_motion["of"], recipe_of_motion["joint"], recipe_of_motion["near"]) == ("motion", "hinge", True)
    assert "You saw nothing of flap, hinge." in said(llm, "observe/1/unseen")
    told = said(llm, "judge/1/1")
    assert "turns upwards" in told
    assert "six pictures alike" not in told
    verdict = run.verdict()
    assert verdict is not None
    assert verdict["findings"] == []
    request = next(request for request in llm.requests if request.step == "observe/1/unseen")
    pictures = [part for message in request.messages for part in message.parts if isinstance(part, Image)]
    assert len({picture.content for picture in pictures}) == len(pictures)


def test_what_is_not_seen_at_second_sight_never_counts_as_agreed(tmp_path: Path) -> None:
    llm = flap(observe__1=not_seen("hinge"), observe__1__unseen=not_seen("hinge"))
    run = made(tmp_path, llm)

    told = said(llm, "judge/1/1")
    assert "- motion of joint hinge (not seen): " in told
    assert "as expected)" not in told
    verdict = run.verdict()
    assert verdict is not None
    assert [(finding["code"], finding["where"]) for finding in verdict["findings"]] == [("W_OBSERVER_UNSEEN", "joints.hinge")]
    assert [motion["expected"] for motion in verdict["observations"]["motions"]] == ["not seen"]
    assert sum(step.startswith("observe/") for step in llm.steps) == 2, "other pictures are taken once"


def test_an_observer_who_says_nothing_of_other_pictures_is_asked_again(tmp_path: Path) -> None:
    silent = json.dumps({"overall": "a box", "parts": [], "motions": []})
    answers = {"observe__1": not_seen("hinge"), "observe__1__unseen": silent, "observe__1__unseen__2": observed("hinge")}
    llm = flap(**answers)
    made(tmp_path, llm)

    assert "nothing is said of hinge" in said(llm, "observe/1/unseen/2")
