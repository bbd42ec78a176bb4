"""Ranges: what the analysis says that something moves is compared with how far the joints of a plan and of an assembly go."""

from __future__ import annotations

import copy
import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from articad.agents import ranges
from articad.agents.design import Designer
from articad.agents.edit import edit
from articad.agents.llm import Scripted
from articad.agents.pipeline import generate
from articad.agents.replies import object_text
from articad.agents.requirements import Motion, Requirements
from articad.assembly import Assembly
from articad.connectors import SE3
from articad.findings import Findings
from articad.geometry.part import Part
from articad.kinematics import Coupling, Joint, JointLimits
from articad.plan.resolve import ResolvedPlan, resolve
from articad.plan.schema import AssemblyPlan
from articad.runs.run import Run, RunRequest
from tests.agents import stories
from tests.agents.stories import FLAP_PLAN, FLAP_SCRIPTS, fenced
from tests.kinematics.linkages import joint

RECORDINGS = Path(__file__).resolve().parents[1] / "recordings"


def motion(component: str, span: str, kind: str = "slides", against: str = "base") -> Motion:
    return Motion.model_validate({"component": component, "relative_to": against, "kind": kind, "axis": "level", "range": span})


# ---------------------------------------------------------------- what a text states


@pytest.mark.parametrize(
    ("kind", "text", "spans"),
    [
        ("slides", "0 to 240 mm, 0 is closed", [(0, 240, "mm")]),
        ("slides", "0 (closed) to 380 mm out towards the viewer", [(0, 380, "mm")]),
        ("slides", "0 (up, at rest) to 75 mm down; the lever, fixed on it, goes with it", [(0, 75, "mm")]),
        ("slides", "-45 mm (towards the viewer: 90 mm open) to +45 mm (closed), 0 is the pose at rest, half open 45 mm", [(-45, 45, "mm")]),
        ("slides", "follows the screw: 0 (rest, foremost) to 10 mm to the rear (-X)", [(0, 10, "mm")]),
        ("slides", "0..90.5 mm", [(0, 90.5, "mm")]),
        ("slides", "0 … 90 mm", [(0, 90, "mm")]),
        ("slides", "0\N{EN DASH}90mm", [(0, 90, "mm")]),
        ("slides", "0 up to 90 mm", [(0, 90, "mm")]),
        ("slides", "90 to 0 mm", [(0, 90, "mm")]),
        ("turns", "0 (open, at rest) to about 15 degrees (shut), driven by the lever", [(0, 15, "degrees")]),
        ("turns", "-31.6 degrees (squeezed: C 1 mm past the line B-D) to +21 degrees (wide open)", [(-31.6, 21, "degrees")]),
        ("turns", "\N{MINUS SIGN}30° to 60°, 0 is upright", [(-30, 60, "degrees")]),
        ("turns", "-9 to 9 turns (-3240 to 3240 degrees), 0 is rest; 18 turns for 90 mm", [(-3240, 3240, "degrees")]),
        ("turns", "0 to 172 deg for 60 mm of feed", [(0, 172, "degrees")]),
        ("turns and slides", "slides about -80 to 150 mm, swings -90 to 90 degrees", [(-80, 150, "mm"), (-90, 90, "degrees")]),
        ("screws", "-45 to 45 mm, tied to -9 to 9 turns", [(-45, 45, "mm")]),
        ("turns", "all round without end", []),
        ("turns", "endless; the leg swings about 15 degrees to each side of upright and steps up and down 16 mm", []),
        ("turns", "horse head 12.8 degrees down to 15.2 degrees up, 0 is level", []),
        ("slides", "24.85 mm up to 35.15 mm down", []),
        ("slides", "60 mm stroke: from the pose at rest 24.85 mm up and 35.15 mm down", []),
        ("screws", "0 (rest) to 8 turns out, 1.25 mm per turn, 10 mm to the rear (-X)", []),
        ("slides", "0 to 1,200 mm", []),
        ("slides", "0 mm to 40 degrees", []),
        ("slides", "follows the lever, 0 to 25 degrees", []),
        ("turns", "its tip goes 0 to 40 mm", []),
        ("slides", "0 to 0.4 m", []),
        ("turns", "through x = 172.5, z = 385; copy_1 to 30 degrees", []),
    ],
)
def test_the_spans_of_a_text_are_read_in_the_units_that_its_kind_of_motion_has(kind: str, text: str, spans: list[Any]) -> None:
    assert list(ranges.spans_of(motion("it", text, kind))) == spans


# ---------------------------------------------------------------- what limits of a plan say


def sliders(base: str = "carcase", /, **travels: float) -> dict[str, Any]:
    """A plan of parts that slide on another, each from 0 as far as is given [mm]."""
    axis = {"o": [0, 0, 0], "z": [0, -1, 0], "x": [1, 0, 0], "label": "direction of the slide"}
    part = {"material": "steel", "description": "A box of side.", "dimensions": {"side": 20}}
    return FLAP_PLAN | {
        "name": "sliders",
        "ground": base,
        "freedoms": len(travels),
        "parameters": [],
        "parts": [
            part | {"name": base, "connectors": [axis | {"name": name, "o": [50 * at, 0, 0]} for at, name in enumerate(travels)]},
            *(part | {"name": name, "rest_pose": "auto", "connectors": [axis | {"name": "axis"}]} for name in travels),
        ],
        "joints": [
            {"name": name, "type": "slider", "parent": f"{base}.{name}", "child": f"{name}.axis", "travel_mm": [0, travel]}
            for name, travel in travels.items()
        ],
    }


def analysis(*motions: Motion) -> Requirements:
    return Requirements.model_validate(json.loads(stories.requirements()) | {"motions": [one.model_dump() for one in motions]})


def designer(requirements: Requirements, *answers: Any, instructions: str | None = None) -> tuple[Designer, Scripted]:
    llm = Scripted({f"design/{at}": json.dumps(answer) for at, answer in enumerate(answers, 1)})
    return Designer(RunRequest(prompt="it"), requirements, llm, instructions=instructions), llm


def asked(llm: Scripted, at: int) -> str:
    return "".join(part.get("text", "") for part in llm.requests[at].to_json()["messages"][-1]["content"])


CUPBOARD = analysis(
    motion("drawer, left", "0 (closed) to 380 mm out towards the viewer", against="carcase"),
    motion("drawer, right", "0 (closed) to 380 mm out towards the viewer", against="carcase"),
)
TOASTER = analysis(
    motion("lifter", "0 (up, at rest) to 75 mm down; the lever, fixed on it, goes with it"),
    motion("browning_knob", "0 to 270 degrees", "turns"),
    motion("crumb_tray", "0 (in, at rest) to 150 mm out"),
)


def test_drawers_that_open_a_tenth_as_far_as_the_analysis_says_are_asked_about_and_corrected() -> None:
    """W_MOTION_RANGE, whose hint is followed: the limits are corrected, and nothing is asked again."""
    mended = {f"joints.drawer_{side}.travel_mm": [0, 380] for side in ("left", "right")}
    planner, llm = designer(CUPBOARD, sliders(drawer_left=38, drawer_right=38), {"changes": mended})

    plan = planner.first()
    assert plan == AssemblyPlan.from_json(sliders(drawer_left=380, drawer_right=380))
    assert not ranges.planned(resolve(plan), CUPBOARD.motions)
    assert len(llm.requests) == 2
    told = asked(llm, 1)
    assert "W_MOTION_RANGE joints.drawer_left: The analysis says: drawer, left slides, 0 (closed) to 380 mm out towards the viewer." in told
    assert "No joint has such a travel: drawer_left goes 38 mm, drawer_right goes 38 mm." in told
    assert "W_MOTION_RANGE joints.drawer_right" in told


def test_a_designer_who_keeps_a_travel_is_asked_once() -> None:
    kept = sliders("base", lifter=7.5, crumb_tray=150)
    planner, llm = designer(TOASTER, kept, {"changes": {}}, {"changes": {}})

    assert planner.first() == AssemblyPlan.from_json(kept)
    assert "W_MOTION_RANGE joints.lifter: " in asked(llm, 1)
    assert "lifter goes 7.5 mm, crumb_tray goes 150 mm." in asked(llm, 1)
    assert "joints.crumb_tray: " not in asked(llm, 1)
    planner.again(AssemblyPlan.from_json(kept), Findings())
    assert len(llm.requests) == 3


def test_a_designer_who_was_told_of_a_travel_after_the_build_is_not_asked_again() -> None:
    kept = AssemblyPlan.from_json(sliders("base", lifter=75, crumb_tray=150))
    planner, llm = designer(TOASTER, kept.to_json(), {"changes": {"joints.lifter.travel_mm": [0, 7.5]}})
    planner.first()
    (found,) = ranges.planned(resolve(AssemblyPlan.from_json(sliders("base", lifter=7.5, crumb_tray=150))), TOASTER.motions)

    planner.again(kept, [found])
    assert len(llm.requests) == 2


def test_a_plan_that_is_made_by_other_rules_is_not_compared() -> None:
    planner, llm = designer(TOASTER, sliders("base", lifter=7.5, crumb_tray=150), instructions="Change the plan.")

    planner.first()
    assert len(llm.requests) == 1


def codes(plan: dict[str, Any] | ResolvedPlan, *motions: Motion) -> list[str]:
    resolved = plan if isinstance(plan, ResolvedPlan) else resolve(AssemblyPlan.from_json(plan))
    return [finding.where for finding in ranges.planned(resolved, motions)]


@pytest.mark.parametrize(
    ("travel", "text", "met"),
    [
        (100, "0 to 124 mm", True),
        (100, "0 to 126 mm", False),
        (100, "0 to 81 mm", True),
        (100, "0 to 79 mm", False),
        (100, "-50 to 50 mm", True),
        (150, "slides 150 mm: -75 to +75 mm (at rest 195 mm), that is 12 to 13 mm", True),
        (28, "about 25 to 30 mm from open to shut", True),
        (250, "about 25 to 30 mm from open to shut", False),
        (100, "any distance", True),
        (100, "0 to 40 degrees", True),
    ],
)
def test_a_motion_is_met_by_a_travel_within_a_quarter_of_one_of_its_spans(travel: float, text: str, met: bool) -> None:
    assert codes(sliders(tray=travel), motion("tray", text)) == ([] if met else ["joints.tray"])


def test_what_several_motions_say_of_one_joint_is_one_finding() -> None:
    plan = resolve(AssemblyPlan.from_json(sliders(tray=10)))
    found = ranges.planned(plan, [motion("upper tray", "0 to 100 mm"), motion("lower tray", "0 to\n 200 mm \x1b[2J")])

    assert [one.message for one in found] == [
        "The analysis says: upper tray slides, 0 to 100 mm; lower tray slides, 0 to 200 mm \\u001b[2J. No joint has such a travel: tray goes 10 mm."
    ]
    assert found[0].parts == ("tray",)
    assert found[0].route == "design"


def test_the_joint_that_shares_most_words_with_what_moves_is_named_and_of_many_joints_a_few_are_told() -> None:
    plan = sliders(**dict.fromkeys(("a", "b", "c", "d", "e", "f", "left_tray", "right_tray"), 10))
    (found,) = ranges.planned(resolve(AssemblyPlan.from_json(plan)), [motion("tray, right", "0 to 100 mm")])

    assert found.where == "joints.right_tray"
    assert "right_tray goes 10 mm, left_tray goes 10 mm, a goes 10 mm" in found.message
    assert "and 2 more." in found.message


@pytest.mark.parametrize(
    ("text", "met"), [("0 to 360 degrees, without stop", True), ("-3240 to 3240 degrees", True), ("0 to 105 degrees", False)]
)
def test_what_turns_without_end_meets_whole_turns_only(text: str, met: bool) -> None:
    plan = FLAP_PLAN | {"joints": [FLAP_PLAN["joints"][0] | {"angle_deg": "endless"}]}
    assert codes(plan, motion("flap", text, "turns")) == ([] if met else ["joints.hinge"])


@pytest.mark.parametrize(
    ("kind", "limits", "moved", "met", "unmet"),
    [
        ("ball", JointLimits(cone=1.0), "swivels", ["0 to 57 degrees", "-57 to 57 degrees", "0 to 360 degrees"], ["0 to 9 degrees"]),
        ("ball", JointLimits(cone=1.0, twist=(-0.5, 0.5)), "swivels", ["0 to 57 degrees"], ["0 to 360 degrees"]),
        ("screw", JointLimits((0.0,), (4 * math.pi,)), "screws", ["0 to 720 degrees", "0 to 10 mm"], ["0 to 2 degrees", "0 to 100 mm"]),
        ("universal", JointLimits((0.0, -1.0), (0.5, 1.0)), "tilts", ["0 to 29 degrees", "-57 to 57 degrees"], ["0 to 10 degrees"]),
        (
            "cylindrical",
            JointLimits((0.0, -math.inf), (9.0, math.inf)),
            "turns and slides",
            ["0 to 9 mm", "0 to 360 degrees"],
            ["0 to 90 mm"],
        ),
        ("cylindrical", JointLimits((-math.inf, 0.0), (math.inf, 1.0)), "turns and slides", ["0 to 9 mm"], ["0 to 90 degrees"]),
        ("planar", JointLimits((0.0, 0.0, 0.0), (9.0, 20.0, 1.0)), "slides in a plane", ["0 to 20 mm", "0 to 57 degrees"], ["0 to 90 mm"]),
        ("free", JointLimits(), "slides in a plane", ["0 to 20 mm", "0 to 57 degrees"], []),
        ("fixed", JointLimits(), "turns", ["0 to 57 degrees"], []),
    ],
)
def test_every_coordinate_of_a_joint_is_compared(kind: str, limits: JointLimits, moved: str, met: list[str], unmet: list[str]) -> None:
    at = SE3.identity()
    one = replace(joint("it", kind, ("base", at), ("it", at), lead=5.0 if kind == "screw" else 0.0), limits=limits)
    whole = Assembly.from_parts("single", parts=[Part.without_geometry(name) for name in ("base", "it")], joints=[one], ground="base")
    for text in met + unmet:
        assert bool(ranges.built(whole, [motion("it", text, moved)])) == (text in unmet), text


# ---------------------------------------------------------------- what follows


def bare(plan: ResolvedPlan) -> Assembly:
    """The assembly of a plan, without the shapes of its parts."""
    parts = [Part.without_geometry(name) for name in plan.parts]
    return Assembly.from_parts(plan.plan.name, parts=parts, joints=plan.joints, ground=plan.ground, couplings=plan.couplings)


def recorded(name: str) -> ResolvedPlan:
    return resolve(AssemblyPlan.loads((RECORDINGS / name / "plan.json").read_text(encoding="utf-8")))


def test_how_far_a_follower_in_a_loop_goes_is_known_when_it_was_moved() -> None:
    press = recorded("asked/hand_press")
    stroke = motion("ram", "0 to 6 mm downward", against="head")

    assert not ranges.planned(press, [stroke])
    (found,) = ranges.built(bare(press), [stroke])
    ram = next(joint for joint in press.joints if joint.name == found.where.removeprefix("joints."))
    assert ram.child == "ram"
    assert "goes 60 mm" in found.message
    assert not ranges.built(bare(press), [motion("ram", "0 to 60 mm downward", against="head")])


def test_a_follower_goes_no_farther_than_its_limits() -> None:
    (found,) = ranges.planned(recorded("asked/hand_press"), [motion("ram", "0 to 6000 mm downward", against="head")])
    assert "mm at most" in found.message


def test_what_an_endless_driver_turns_slowly_turns_without_end() -> None:
    def turning(name: str, **given: Any) -> Joint:
        return joint(name, "revolute", ("frame", SE3.trans(0, 0, 0)), (name, SE3.trans(0, 0, 0)), **given)

    clock = Assembly.from_parts(
        "clock",
        parts=[Part.without_geometry(name) for name in ("frame", "minute", "hour")],
        joints=[turning("minute", driver=True), turning("hour")],
        ground="frame",
        couplings=(Coupling("train", "linear", "minute", "hour", 1 / 12, 0.0),),
    )
    assert not ranges.built(clock, [motion("hour", "0 to 360 degrees, all round", "turns")])
    assert ranges.built(clock, [motion("hour", "0 to 30 degrees", "turns")])


# ---------------------------------------------------------------- whole runs

QUIET: dict[str, Any] = {"look": False, "inspection": False}
PLATE = """
from build123d import Align, Box

def build(part):
    d = part.dimensions
    shape = Box(d["length"], d["side"], d["side"], align=(Align.MIN,) * 3)
    return shape, {name: {"o": (x, d["side"] / 2, d["side"]), "z": (0, -1, 0), "x": (1, 0, 0)} for name, x in (("axis", 0), ("other", 50))}
"""


def made(folder: Path, plan: dict[str, Any], *motions: Motion, scripts: dict[str, str] = FLAP_SCRIPTS, **answers: Any) -> Scripted:
    script = {"requirements": json.dumps(analysis(*motions).to_json()), "design/1": json.dumps(plan)}
    script |= {f"part/{name}/1": fenced(text) for name, text in scripts.items()}
    llm = Scripted(script | {step.replace("__", "/"): json.dumps(answer) for step, answer in answers.items()})
    generate("flaps", llm=llm, out=folder, **stories.settings(kernel=stories.kernel(), cache=stories.shared_cache(), **QUIET))
    return llm


def designs(llm: Scripted) -> list[str]:
    return [step for step in llm.steps if step.startswith("design")]


def tied() -> dict[str, Any]:
    """Two flaps on a plate, of which the second turns a tenth as far as the first, although its limits leave it 45 degrees."""
    plan = copy.deepcopy(FLAP_PLAN)
    plate, flap = plan["parts"]
    plate["dimensions"]["length"] = 90
    plate["connectors"].append(plate["connectors"][0] | {"name": "other", "o": [50, 5, 10]})
    second = {"name": "second", "type": "revolute", "parent": "plate.other", "child": "follower.axis", "angle_deg": [0, 45]}
    return plan | {
        "parts": [plate, flap, flap | {"name": "follower", "rest_pose": {"at": [50, 0, 10]}}],
        "joints": [plan["joints"][0] | {"driver": True}, second],
        "couplings": [{"name": "tie", "type": "linear", "joints": ["hinge", "second"], "ratio": 0.1}],
    }


TIED_SCRIPTS = {"plate": PLATE, "flap": FLAP_SCRIPTS["flap"], "follower": FLAP_SCRIPTS["flap"]}


@pytest.mark.parametrize("changes", [{}, {"couplings.tie.ratio": 0.5}], ids=["kept", "mended"])
def test_a_follower_that_goes_otherwise_is_asked_about_once_when_it_was_built(changes: dict[str, Any], tmp_path: Path) -> None:
    llm = made(
        tmp_path / "run",
        tied(),
        motion("flap", "0 to 90 degrees", "turns", "plate"),
        motion("follower", "0 to 45 degrees", "turns", "plate"),
        scripts=TIED_SCRIPTS,
        design__2={"changes": changes},
    )

    assert designs(llm) == ["design/1", "design/2"]
    assert "W_MOTION_RANGE joints.second: " in asked(llm, -1)
    assert "second goes 9 degrees, hinge goes 90 degrees." in asked(llm, -1)


def test_a_travel_that_was_asked_about_before_the_build_is_not_asked_about_after_it(tmp_path: Path) -> None:
    llm = made(tmp_path / "run", FLAP_PLAN, motion("flap", "0 to 9 degrees", "turns", "plate"), design__2={"changes": {}})

    assert designs(llm) == ["design/1", "design/2"]
    assert llm.steps.index("design/2") < llm.steps.index("part/flap/1")


def test_an_edit_may_depart_from_the_analysis_of_the_original_run(tmp_path: Path) -> None:
    plan = copy.deepcopy(FLAP_PLAN)
    plan["parameters"].append({"name": "opening", "value": 90, "unit": "deg"})
    plan["joints"][0]["angle_deg"] = [0, "opening"]
    made(tmp_path / "run", plan, motion("flap", "0 to 90 degrees", "turns", "plate"))

    change = {"summary": "It opens 40 degrees.", "touches": ["flap", "plate"], "changes": {"parameters.opening.value": 40}}
    llm = Scripted({"edit/1": json.dumps(change)})
    options = stories.settings(kernel=stories.kernel(), cache=stories.shared_cache(), **QUIET)
    edited = edit(Run.view(tmp_path / "run"), "let it open 40 degrees", llm=llm, out=tmp_path / "edited", **options)
    assert (edited.edit() or {})["ok"]
    assert llm.steps == ["edit/1"]


# ---------------------------------------------------------------- recorded runs


def test_no_motion_of_a_recorded_run_is_complained_about() -> None:
    compared = 0
    for folder in sorted(path.parent for path in RECORDINGS.rglob("request.json")):
        answers = [folder / "llm" / f"{step}.json" for step in ("concept", "requirements")]
        for answer in [path for path in answers if path.is_file()][:1]:
            text = json.loads(answer.read_text(encoding="utf-8"))["reply"]["text"]
            motions = Requirements.model_validate_json(object_text(text, step="requirements")).motions
            plan = recorded(str(folder.relative_to(RECORDINGS)))
            compared += sum(bool(ranges.spans_of(one)) for one in motions)
            assert not [*ranges.planned(plan, motions), *ranges.built(bare(plan), motions)], folder.name
    assert compared > 40


def test_a_hinge_with_the_name_of_a_balls_tilt_is_measured_once() -> None:
    none = SE3.identity()
    hinge = joint("tilt", "revolute", ("base", none), ("arm", none), limits=[(0.0, 0.5)])
    ball = joint("head", "ball", ("base", none), ("arm", none))
    (one,), (both,) = ranges._extents(hinge, "tilt", "rad", 0.5, 0.5), ranges._extents(ball, "tilt", "rad", 0.5, 0.5)

    assert one.most == pytest.approx(math.degrees(0.5))
    assert both.most == pytest.approx(2 * math.degrees(0.5))
