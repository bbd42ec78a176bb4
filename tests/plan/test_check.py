"""Checking: every code of the plan's own checks, with its place, its number and its hint."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from articad import examples
from articad.errors import KinematicsError, LoopError, PlanError
from articad.findings import Finding, Findings
from articad.findings.codes import CODES
from articad.kinematics import Mechanism
from articad.plan.check import check_plan
from articad.plan.schema import AssemblyPlan
from tests.plan.samples import Json, check, chest, connector, document, gears, joint, only, pair, part

Change = Callable[[Json], Any]
Z = [0, 0, 1]


class Case(NamedTuple):
    """A plan with one fault."""

    code: str
    plan: Json
    where: str
    words: str
    value: float | None = None
    limit: float | None = None


def chest_with(change: Change) -> Json:
    plan = chest()
    change(plan)
    return plan


def wardrobe_with(change: Change) -> Json:
    plan = document("wardrobe")
    change(plan)
    return plan


def gears_with(change: Change, **coupling: Any) -> Json:
    plan = gears(**coupling)
    change(plan)
    return plan


def both(plan: Json, *changes: Json) -> None:
    plan["parameters"] = list(changes)


def boards(plan: Json) -> Json:
    """Add a shelf that nothing holds."""
    shelf = {"name": "shelf", "material": "wood", "description": "", "connectors": [{"name": "s", "o": [0, 0, 0], "z": Z, "label": ""}]}
    plan["parts"].append(shelf)
    return plan


def second_hinge(plan: Json, **changes: Any) -> Json:
    plan["joints"].append({**joint(plan, "hinge"), "name": "second", **changes})
    return plan


REVOLUTE: Json = {"type": "revolute", "angle_deg": [0, 90]}
BALL: Json = {"type": "ball", "cone_deg": 30}
TURNING = {"joints": ["turn_small", "turn_large"]}

CASES = [
    # numbers
    Case(
        "E_NAME",
        chest_with(lambda p: both(p, {"name": "sin", "value": 1})),
        "parameters.sin.name",
        "Rename it, for example to sin_value, here and in each expression that uses it.",
    ),
    Case(
        "E_DUP_NAME",
        chest_with(lambda p: both(p, {"name": "width", "value": 1}, {"name": "width", "value": 2})),
        "parameters.width",
        "2 parameters are called 'width'.",
        2,
    ),
    Case(
        "E_EXPRESSION",
        chest_with(lambda p: connector(p, "box", "hinge").update(o=["widht / 2", 100, 80])),
        "parts.box.connectors.hinge.o[0]",
        "Did you mean 'width'?",
    ),
    Case(
        "E_EXPRESSION",
        chest_with(
            lambda p: (
                connector(p, "box", "hinge").update(o=["-2 * half", 100, 80])
                or part(p, "box").setdefault("dimensions", {}).update(half="width / 8")
            )
        ),
        "parts.box.connectors.hinge.o[0]",
        "half is a dimension of box, and expressions see parameters only. Write it in parameters: '-2 * (width / 8)'.",
    ),
    Case(
        "E_NAME",
        chest_with(
            lambda p: (
                p["parameters"].append({"name": "floor", "value": 50})
                or part(p, "box").setdefault("dimensions", {}).update(a="floor / 2", b="2 + floor", c="floor")
            )
        ),
        "parameters.floor.name",
        "Rename it, for example to floor_value, here and in each expression that uses it.",
    ),
    Case(
        "E_EXPRESSION_CYCLE",
        chest_with(lambda p: both(p, {"name": "a", "value": "b"}, {"name": "b", "value": "a"}, {"name": "width", "value": "a"})),
        "parameters.a.value",
        "a -> b -> a. Give one of a, b a number.",
    ),
    Case(
        "E_NONFINITE",
        chest_with(lambda p: joint(p, "hinge").update(rest_deg="1 / (width - 300)")),
        "joints.hinge.rest_deg",
        "divided by zero",
    ),
    Case(
        "E_PARAMETER_BOUNDS",
        chest_with(lambda p: p["parameters"][0].update(value=500)),
        "parameters.width",
        "Set the value to 400, or max to 500.",
        500,
        400,
    ),
    Case(
        "E_PARAMETER_BOUNDS",
        chest_with(lambda p: p["parameters"][0].update(value="20 * 5")),
        "parameters.width",
        "Set the value to 200, or min to 100.",
        100,
        200,
    ),
    Case(
        "E_PARAMETER_BOUNDS",
        chest_with(lambda p: p["parameters"][0].update(min=401)),
        "parameters.width",
        "Did you mean min 400, max 401?",
        401,
        400,
    ),
    Case(
        "W_PARAMETER_RANGE",
        chest_with(lambda p: part(p, "lid").update(rest_pose={"at": ["width - 300", 100, 80]})),
        "parameters.width.min",
        "At width = 200, its min, the plan breaks: E_MATE_OFFSET joints.hinge: box.hinge and lid.hinge are 100 mm apart",
        200,
        300,
    ),
    Case("E_MATERIAL_UNKNOWN", chest_with(lambda p: part(p, "box").update(material="wod")), "parts.box.material", "Did you mean 'wood'?"),
    Case(
        "E_COUNT",
        chest_with(lambda p: part(p, "box").update(dimensions={"slot_count": "width / 70"})),
        "parts.box.dimensions.slot_count",
        "Give 4, or rename it",
        300 / 70,
    ),
    Case("E_DENSITY", chest_with(lambda p: p["materials"][0].update(density_kg_m3=0)), "materials.wood.density_kg_m3", "steel 7850", 0),
    Case(
        "W_DENSITY",
        chest_with(lambda p: p["materials"][0].update(density_kg_m3=0.7)),
        "materials.wood.density_kg_m3",
        "set density_kg_m3 to 700",
        0.7,
        10,
    ),
    Case(
        "W_SCALE",
        chest_with(lambda p: part(p, "box").update(dimensions={"width": "width", "wall": 0.006})),
        "parts.box.dimensions.wall",
        "Then it is 6; or make it at least 0.05 mm",
        0.006,
        0.05,
    ),
    Case(
        "W_SCALE",
        chest_with(lambda p: part(p, "box").update(dimensions={"width": "width", "play": 0.0002})),
        "parts.box.dimensions.play",
        "at least 0.001 mm",
        0.0002,
        0.001,
    ),
    Case(
        "W_SCALE",
        chest_with(lambda p: part(p, "box").update(dimensions={"width": 300, "height": 300000})),
        "parts.box.dimensions.height",
        "all others of the plan are at most 300 mm",
        300000,
        15000,
    ),
    Case(
        "W_DIMENSION_SIGN",
        chest_with(lambda p: part(p, "box").update(dimensions={"width": "width", "wall_depth": -6, "wall_z": -6})),
        "parts.box.dimensions.wall_depth",
        "Make it 6; or name a place as one",
        -6,
        0,
    ),
    Case("E_FRICTION", chest_with(lambda p: p["materials"][0].update(friction=-0.1)), "materials.wood.friction", "at least 0", -0.1),
    Case(
        "E_ENVELOPE_VALUE",
        chest_with(lambda p: part(p, "box").update(envelope_mm=["width", 0, 5])),
        "parts.box.envelope_mm[1]",
        "Side y of the expected bounding box is 0 mm",
        0,
    ),
    Case("E_SCALE", chest_with(lambda p: part(p, "box").update(envelope_mm=[0.1, 0.2, 0.3])), "plan", "were metres given?", 0.14**0.5, 0.5),
    Case("E_SCALE", chest_with(lambda p: part(p, "box").update(envelope_mm=[3e6, 4e6, 1])), "plan", "micrometres", 5e6, 1e6),
    # connectors
    Case(
        "E_AXIS_ZERO",
        chest_with(lambda p: connector(p, "box", "hinge").update(z=[0, 0, 0])),
        "parts.box.connectors.hinge.z",
        "such as (1, 0, 0)",
    ),
    Case(
        "E_AXIS_ZERO", chest_with(lambda p: part(p, "box").update(rest_pose={"axis": [0, 0, 0]})), "parts.box.rest_pose.axis", "[0, 0, 1]"
    ),
    Case(
        "E_AXIS_ZERO",
        wardrobe_with(lambda p: part(p, "door_right")["derive"]["plane"].update(normal=[0, 0, 0])),
        "parts.door_right.derive.plane.normal",
        "[1, 0, 0] to mirror left and right",
    ),
    Case(
        "E_AXIS_PARALLEL",
        chest_with(lambda p: connector(p, "box", "hinge").update(x=[2, 0, 0])),
        "parts.box.connectors.hinge.x",
        "Choose x perpendicular to z, such as (0, 1, 0).",
    ),
    Case(
        "E_AXIS_NOT_ORTHOGONAL",
        chest_with(lambda p: connector(p, "box", "hinge").update(x=[1, 0, 3**0.5])),
        "parts.box.connectors.hinge.x",
        "x makes 60° with z. Did you mean x=(0, 0, 1)?",
        60,
        90,
    ),
    Case(
        "W_AXIS_NOT_ORTHOGONAL",
        chest_with(lambda p: connector(p, "box", "hinge").update(x=[0.01, 0, 1])),
        "parts.box.connectors.hinge.x",
        "Set x to (0, 0, 1).",
        89.427,
        90,
    ),
    Case(
        "E_CONNECTOR_UNKNOWN",
        chest_with(lambda p: joint(p, "hinge").update(child="lid.hing")),
        "joints.hinge.child",
        "Did you mean 'hinge'? Connectors of lid: hinge.",
    ),
    Case(
        "W_CONNECTOR_KIND",
        chest_with(lambda p: connector(p, "lid", "hinge").update(kind="slide_axis")),
        "parts.lid.connectors.hinge.kind",
        "Use kind 'hinge_axis', 'shaft_axis', 'bore_axis', 'gear_axis' or 'frame'.",
    ),
    Case(
        "W_CONNECTOR_UNUSED",
        chest_with(lambda p: part(p, "lid")["connectors"].append({"name": "knob", "o": [0, 0, 0], "z": Z, "label": ""})),
        "parts.lid.connectors.knob",
        "No joint uses connector 'knob' of lid.",
    ),
    Case(
        "W_DUP_CONNECTOR_USE",
        chest_with(lambda p: (boards(p), second_hinge(p, type="fixed", child="shelf.s"), joint(p, "second").pop("angle_deg"))),
        "parts.box.connectors.hinge",
        "Joints hinge and second share connector box.hinge.",
        2,
        1,
    ),
    Case(
        "E_NO_CONNECTORS",
        chest_with(lambda p: part(p, "lid").update(connectors=[])),
        "parts.lid.connectors",
        "Part 'lid' has no connector.",
    ),
    Case(
        "E_DUP_NAME",
        chest_with(lambda p: part(p, "box")["connectors"].append(connector(p, "box", "hinge"))),
        "parts.box.connectors.hinge",
        "2 connectors are called 'hinge'. Rename all but one.",
        2,
    ),
    Case(
        "E_ENVIRONMENT",
        chest_with(lambda p: part(p, "lid").update(environment=True)),
        "parts.lid.environment",
        "joint 'hinge', which holds it, is not fixed",
    ),
    Case("E_ENVIRONMENT", chest_with(lambda p: part(p, "box").update(environment=True)), "parts.box.environment", "but it is the ground"),
    # joints and graph
    Case("E_PART_UNKNOWN", chest_with(lambda p: joint(p, "hinge").update(child="lidd.hinge")), "joints.hinge", "Did you mean 'lid'?"),
    Case(
        "E_PART_UNKNOWN",
        chest_with(lambda p: p.update(allow=[{"parts": ["box", "led"], "max_depth_mm": 1, "reason": "x"}])),
        "allow[0].parts",
        "Did you mean 'lid'?",
    ),
    Case("E_JOINT_SELF", chest_with(lambda p: second_hinge(p, child="box.hinge")), "joints.second", "Name two different parts."),
    Case("E_JOINT_DUP", chest_with(second_hinge), "joints.second", "connect the same two connectors"),
    Case("E_DUP_NAME", chest_with(lambda p: second_hinge(p, name="hinge")), "joints.hinge", "Rename all but one.", 2),
    Case("E_DUP_NAME", chest_with(lambda p: p["parts"].append(part(p, "lid"))), "parts.lid", "Rename all but one.", 2),
    Case("E_DUP_NAME", chest_with(lambda p: p["materials"].append(p["materials"][0])), "materials.wood", "2 materials", 2),
    Case("E_NO_GROUND", chest_with(lambda p: p.update(ground="bocks")), "ground", "Choose one of ['box', 'lid']."),
    Case("E_DISCONNECTED", chest_with(boards), "joints", "one part of each group and one of ['box', 'lid']", 1),
    Case(
        "E_NOT_TREE",
        wardrobe_with(lambda p: p["joints"].append({**joint(p, "hinge_left"), "name": "again", "parent": "drawer_lower.slide"})),
        "joints.again",
        "closes the loop drawer_lower-cabinet-door_left",
    ),
    Case(
        "E_REVERSE_UNSUPPORTED",
        {**pair({"type": "universal", "a_deg": [-1, 1], "b_deg": [-1, 1]}, 2), "ground": "b"},
        "joints.j",
        "Exchange its parent and child",
    ),
    Case(
        "E_DOF_MISMATCH",
        wardrobe_with(lambda p: p.update(freedoms=3)),
        "freedoms",
        "Declared freedoms 3, but the assembly has 4 (hinge_left 1, hinge_right 1, slide_lower 1, slide_upper 1). Set freedoms to 4",
        3,
        4,
    ),
    Case("E_DOF_MISMATCH", pair({"type": "fixed"}, 1), "freedoms", "has 0 (no joint moves)", 1, 0),
    Case("W_DRIVER", chest_with(lambda p: joint(p, "hinge").update(driver=True)), "joints.hinge.driver", "every joint is a driver"),
    # limits
    Case("E_LIMITS_MISSING", chest_with(lambda p: joint(p, "hinge").pop("angle_deg")), "joints.hinge.angle_deg", 'or "endless"'),
    Case("E_LIMITS_MISSING", pair({"type": "slider"}, 1), "joints.j.travel_mm", 'Add "travel_mm": [0, 100].'),
    Case("E_LIMITS_MISSING", pair({"type": "cylindrical", "angle_deg": "endless"}, 2), "joints.j.travel_mm", '[0, 100], or "endless".'),
    Case("E_LIMITS_MISSING", pair({"type": "ball"}, 3), "joints.j.cone_deg", "180 leaves the swing free"),
    Case(
        "E_LIMITS_ORDER",
        chest_with(lambda p: joint(p, "hinge").update(angle_deg=[110, 0])),
        "joints.hinge.angle_deg",
        "Did you mean [0, 110]?",
        110,
        0,
    ),
    Case("E_LIMITS_ORDER", pair({**BALL, "twist_deg": [9, -9]}, 3), "joints.j.twist_deg", "Did you mean [-9, 9]?", 9, -9),
    Case("E_LIMITS_KIND", pair({"type": "ball", "cone_deg": 200}, 3), "joints.j.cone_deg", "above 0 up to 180", 200, 180),
    Case(
        "W_LIMITS_EQUAL", chest_with(lambda p: joint(p, "hinge").update(angle_deg=[0, 0])), "joints.hinge.angle_deg", "a fixed joint", 0, 0
    ),
    Case(
        "W_LIMITS_UNITS",
        chest_with(lambda p: joint(p, "hinge").update(angle_deg=[0, 1.57])),
        "joints.hinge.angle_deg",
        "[0, 1.57] looks like radians; degrees are expected. If radians were meant, give [0, 89.954].",
        1.57,
        6.3,
    ),
    Case(
        "W_LIMITS_UNITS",
        chest_with(lambda p: joint(p, "hinge").update(angle_deg=[0, 3600])),
        "joints.hinge.angle_deg",
        '"endless"',
        3600,
        720,
    ),
    Case("W_LIMITS_UNITS", pair({"type": "ball", "cone_deg": 0.5}, 3), "joints.j.cone_deg", "0.5 looks like radians", 0.5, 6.3),
    Case(
        "E_REST_OUTSIDE_LIMITS",
        chest_with(lambda p: joint(p, "hinge").update(angle_deg=[10, 110])),
        "joints.hinge.angle_deg",
        "Set rest_deg to 10, or angle_deg to [0, 110].",
        0,
        10,
    ),
    Case(
        "E_REST_OUTSIDE_LIMITS",
        pair({"type": "slider", "travel_mm": [0, 10], "rest_mm": 12}, 1),
        "joints.j.travel_mm",
        "Set rest_mm to 10, or travel_mm to [0, 12].",
        12,
        10,
    ),
    Case(
        "E_REST_OUTSIDE_LIMITS",
        pair({**BALL, "twist_deg": [5, 9]}, 3),
        "joints.j.twist_deg",
        "rests at zero: widen twist_deg to [0, 9]",
        0,
        5,
    ),
    Case(
        "E_LEAD_ZERO", pair({"type": "screw", "lead_mm": 0, "angle_deg": "endless"}, 1), "joints.j.lead_mm", "make it a revolute joint", 0
    ),
    Case("E_EFFORT", pair({**REVOLUTE, "effort_n": 3}, 1), "joints.j.effort_n", "Use effort_n_mm instead", 3),
    Case("E_EFFORT", pair({"type": "fixed", "velocity_mm_s": 3}, 0), "joints.j.velocity_mm_s", "Leave it out.", 3),
    Case("E_EFFORT", pair({**REVOLUTE, "effort_n_mm": 0}, 1), "joints.j.effort_n_mm", "positive number", 0, 0),
    # rest
    Case(
        "E_MATE_FLIP",
        chest_with(lambda p: connector(p, "lid", "hinge").update(z=[-1, 0, 0])),
        "joints.hinge",
        "Set mate to 'opposed'",
        180,
        0.05,
    ),
    Case("E_MATE_TILT", chest_with(lambda p: connector(p, "lid", "hinge").update(z=[1, 1, 0])), "joints.hinge", "to (1, 0, 0)", 45, 0.05),
    Case("E_MATE_ROLL", chest_with(lambda p: connector(p, "lid", "hinge").update(x=[0, 1, 0])), "joints.hinge", "to (0, 0, 1)", 90, 0.05),
    Case("E_MATE_OFFSET", chest_with(lambda p: connector(p, "lid", "hinge").update(o=[0, 0, 2])), "joints.hinge", "to (0, 0, 0)", 2, 0.01),
    Case("I_REST_AUTO", chest_with(lambda p: part(p, "lid").update(rest_pose="auto")), "joints.hinge", "lid is placed by joint 'hinge'"),
    Case(
        "E_REST_AUTO", chest_with(lambda p: part(p, "box").update(rest_pose="auto")), "parts.box.rest_pose", "Give the ground a rest_pose"
    ),
    # derived
    Case(
        "E_DERIVE_UNKNOWN",
        wardrobe_with(lambda p: part(p, "door_right")["derive"].update({"from": "door_lft"})),
        "parts.door_right.derive.from",
        "Did you mean 'door_left'?",
    ),
    Case(
        "E_DERIVE_UNKNOWN",
        wardrobe_with(lambda p: joint(p, "hinge_right")["derive"].update({"from": "hinge"})),
        "joints.hinge_right.derive.from",
        "There is no joint 'hinge' to derive from.",
    ),
    Case(
        "E_DERIVE_CYCLE",
        wardrobe_with(
            lambda p: (
                part(p, "door_right")["derive"].update({"from": "other"}),
                p["parts"].append(
                    {**part(p, "door_right"), "name": "other", "derive": {**part(p, "door_right")["derive"], "from": "door_right"}}
                ),
            )
        ),
        "parts.door_right.derive.from",
        "Parts derive from each other: door_right -> other -> door_right. Define one of door_right, other on its own.",
    ),
    Case(
        "E_DERIVE_CYCLE",
        wardrobe_with(lambda p: joint(p, "hinge_right")["derive"].update({"from": "hinge_right"})),
        "joints.hinge_right.derive.from",
        "hinge_right -> hinge_right",
    ),
    Case(
        "E_DERIVE_COUNT",
        wardrobe_with(
            lambda p: p["parts"].append({"name": "peg", "derive": {"from": "door_left", "op": "pattern", "count": 2.5, "step": {}}})
        ),
        "parts.peg.derive.count",
        "Give a whole number from 1 to 1000. The nearest is 2.",
        2.5,
    ),
    Case(
        "E_DERIVE_JOINT",
        wardrobe_with(lambda p: joint(p, "hinge_right").update(child="drawer_upper.slide")),
        "joints.hinge_right.child",
        "Set child to door_right.hinge, or declare the joint in full.",
    ),
    Case(
        "E_DERIVE_JOINT",
        wardrobe_with(lambda p: joint(p, "slide_upper")["derive"].update(op="mirror")),
        "joints.slide_upper.child",
        "Set op to 'rigid': that is how drawer_upper derives from drawer_lower.",
    ),
    Case(
        "E_DERIVE_JOINT",
        wardrobe_with(lambda p: joint(p, "slide_upper").update(child="drawer_lower.slide")),
        "joints.slide_upper.child",
        "Set child to drawer_upper.slide",
    ),
    Case(
        "W_MIRROR_LIMITS",
        wardrobe_with(
            lambda p: joint(p, "hinge_right").update(type="revolute", angle_deg=["-opening", 0]) or joint(p, "hinge_right").pop("derive")
        ),
        "joints.hinge_right",
        'A symmetric motion needs angle_deg [0, 110]; or derive the joint: {"from": "hinge_left", "op": "mirror"}.',
    ),
    Case(
        "W_CHIRAL",
        wardrobe_with(lambda p: part(p, "door_left").update(description="A panel with a threaded insert.")),
        "parts.door_right.derive",
        "seems to have a handedness (threaded)",
    ),
    Case(
        "I_MIRROR_SIDE",
        wardrobe_with(lambda p: connector(p, "door_left", "hinge").update(label="left edge")),
        "parts.door_right.derive",
        "keeps connectors that say left or right: hinge",
    ),
    # couplings, fits, waivers
    Case(
        "E_JOINT_UNKNOWN",
        gears(type="gear", teeth=[1, 2], joints=["turn_smal", "turn_large"]),
        "couplings.tie.joints[0]",
        "Did you mean 'turn_small'? Joints that can be coupled: turn_small, turn_large, slide.",
    ),
    Case("E_COUPLING", gears(type="gear", teeth=[1, 2], joints=["turn_small", "slide"]), "couplings.tie.joints", "slide is a travel"),
    Case(
        "E_COUPLING",
        gears(type="rack", module_mm=1, teeth=9, joints=["slide", "turn_small"]),
        "couplings.tie.joints",
        'exchange them, ["turn_small", "slide"]',
    ),
    Case("E_COUPLING", gears(type="linear", ratio=1, joints=["slide", "slide"]), "couplings.tie.joints", "ties slide to itself"),
    Case(
        "E_COUPLING",
        gears_with(
            lambda p: joint(p, "slide").update(type="cylindrical", angle_deg="endless"),
            type="linear",
            ratio=1,
            joints=["turn_small", "slide"],
        ),
        "couplings.tie.joints[1]",
        "Use slide.travel or slide.angle.",
    ),
    Case(
        "E_COUPLING",
        gears_with(
            lambda p: joint(p, "slide").pop("travel_mm") and joint(p, "slide").update(type="fixed"),
            type="linear",
            ratio=1,
            joints=["turn_small", "slide"],
        ),
        "couplings.tie.joints[1]",
        "A fixed joint has no coordinate to couple.",
    ),
    Case(
        "E_COUPLING_AXES",
        gears_with(
            lambda p: (connector(p, "frame", "q").update(z=[0, 1, 0]), connector(p, "large", "c").update(z=[0, 1, 0])),
            type="gear",
            teeth=[1, 2],
            **TURNING,
        ),
        "couplings.tie",
        "are 90° apart at rest; a gear needs parallel ones",
        90,
        0.05,
    ),
    Case("E_COUPLING_RATIO", gears(type="gear", teeth=[0, 2], **TURNING), "couplings.tie.teeth[0]", "whole number of teeth", 0),
    Case("E_COUPLING_RATIO", gears(type="gear", teeth=[2, 2.5], **TURNING), "couplings.tie.teeth[1]", "whole number of teeth", 2.5),
    Case("E_COUPLING_RATIO", gears(type="belt", radii_mm=[2, -1], **TURNING), "couplings.tie.radii_mm[1]", "positive length", -1),
    Case("E_COUPLING_RATIO", gears(type="linear", ratio=0, **TURNING), "couplings.tie.ratio", "other than zero", 0),
    Case("E_COUPLING_RATIO", gears(type="screw", lead_mm=0, joints=["turn_small", "slide"]), "couplings.tie.lead_mm", "other than zero", 0),
    Case(
        "E_COUPLING_RATIO",
        gears(type="rack", module_mm=0, teeth=9, joints=["turn_small", "slide"]),
        "couplings.tie.module_mm",
        "positive",
        0,
    ),
    Case(
        "E_COUPLING_REST",
        gears_with(lambda p: joint(p, "slide").update(rest_mm=30), type="linear", ratio=2, offset=10, joints=["turn_small", "slide"]),
        "couplings.tie.offset",
        "At rest slide is 30 mm, but 2 * 0 + 10 is 10. Set offset to 30.",
        10,
        30,
    ),
    Case(
        "E_DUP_NAME",
        gears_with(
            lambda p: p["couplings"].append({"name": "tie", "type": "belt", "radii_mm": [1, 1], **TURNING}),
            type="gear",
            teeth=[1, 2],
            **TURNING,
        ),
        "couplings.tie",
        "2 couplings are called 'tie'.",
        2,
    ),
    Case("E_FIT", pair({**REVOLUTE, "fit": {"gap_mm": [2, 1]}}, 1), "joints.j.fit.gap_mm", "Did you mean [1, 2]?", 2, 1),
    Case("E_FIT", pair({**REVOLUTE, "fit": {"gap_mm": [-1, 1]}}, 1), "joints.j.fit.gap_mm", "Give [0, 1] and contact 'allowed'", -1, 0),
    Case(
        "E_FIT",
        pair({**REVOLUTE, "fit": {"gap_mm": [0, 0], "contact": "forbidden"}}, 1),
        "joints.j.fit",
        "no gap but contact is forbidden",
        0,
    ),
    Case("E_FIT", pair({**REVOLUTE, "fit": {"gap_mm": [1, 2], "contact": "required"}}, 1), "joints.j.fit", "at least 1 mm", 1, 0),
    Case("E_FIT", pair({**REVOLUTE, "fit": {"within_mm": 0}}, 1), "joints.j.fit.within_mm", "the radius about the axis", 0, 0),
    Case(
        "E_ALLOW",
        chest_with(lambda p: p.update(allow=[{"parts": ["box", "box"], "max_depth_mm": 1, "reason": "x"}])),
        "allow[0].parts",
        "twice",
    ),
    Case(
        "E_ALLOW",
        chest_with(lambda p: p.update(allow=[{"parts": ["box", "lid"], "max_depth_mm": 0, "reason": "x"}])),
        "allow[0].max_depth_mm",
        "such as 0.05",
        0,
        0,
    ),
    Case(
        "E_ALLOW",
        chest_with(lambda p: p.update(allow=[{"parts": ["box", "lid"], "max_depth_mm": 1, "reason": " "}])),
        "allow[0].reason",
        "Say why",
    ),
]


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case.code}-{case.where}")
def test_a_fault_is_found_at_its_place_with_its_number_and_hint(case: Case) -> None:
    findings = check(case.plan)
    found = [finding for finding in findings.of(case.code) if finding.where == case.where]
    assert found, f"\n{findings}"
    assert any(case.words in f"{finding.message} {finding.hint}" for finding in found), f"\n{findings}"
    finding = found[0]
    assert finding.hint
    assert finding.stage == "plan"
    if case.value is not None:
        assert finding.value == pytest.approx(case.value, rel=1e-4)
    if case.limit is not None:
        assert finding.limit == pytest.approx(case.limit)


# errors that follow of necessity: a connector in the wrong place is off, a part without its joint is loose
CONSEQUENCES = {
    "E_NO_CONNECTORS": 1,
    "E_NAME": 1,
    "E_NO_GROUND": 1,
    "E_DUP_NAME": 1,
    "E_DERIVE_CYCLE": 1,
    "E_REST_OUTSIDE_LIMITS": 1,
    "E_COUPLING_REST": 1,
    "E_JOINT_UNKNOWN": 1,
    "E_COUPLING": 1,
    "W_DUP_CONNECTOR_USE": 2,
    "E_NOT_TREE": 2,
    "E_DERIVE_JOINT": 3,
}


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case.code}-{case.where}")
def test_one_fault_does_not_drown_in_its_consequences(case: Case) -> None:
    others = [finding for finding in check(case.plan).errors if finding.code != case.code]
    assert len(others) <= CONSEQUENCES.get(case.code, 0), others


FROM_ELSEWHERE = {
    "E_SCHEMA": "reading",
    "E_PARAMETER_UNKNOWN": "overrides",
    "E_NOT_SUPPORTED": "mechanism",
    "E_LEFT_HANDED": "connectors",
    "E_NOT_ROTATION": "connectors",
    "E_QUAT_NORM": "connectors",
    "E_DRIVER": "mechanism: below",
    "E_LOOP_OPEN": "mechanism",
    "E_LOOP_LOCKED": "mechanism",
    "E_COUPLING_LOCKED": "mechanism",
    "W_LOOP_INEXACT": "mechanism",
    "W_SHAKY": "mechanism",
    "W_IDLE_FREEDOM": "mechanism",
    "I_REDUNDANT": "mechanism",
    "W_MOTION_RANGE": "the analysis of a request: agents",
}


def test_every_code_of_the_plans_checks_is_raised_here() -> None:
    registered = {name for name, code in CODES.items() if code.stage == "plan"}
    assert registered - {case.code for case in CASES} - FROM_ELSEWHERE.keys() == set()


# ---------------------------------------------------------------- plans as wholes


def test_the_wardrobe_has_no_finding() -> None:
    assert not check(document("wardrobe"))


def test_a_part_alone_needs_no_connector_and_no_joint() -> None:
    plan = pair({"type": "fixed"}, 0)
    plan["parts"], plan["joints"] = [{**plan["parts"][0], "connectors": []}], []
    assert not check(plan)


def test_a_dimension_that_cannot_be_read_is_quoted_as_it_stands() -> None:
    plan = chest_with(
        lambda p: (
            connector(p, "box", "hinge").update(o=["half + 1", 100, 80])
            or part(p, "box").setdefault("dimensions", {}).update(half="\\g<9>")
        )
    )
    (told,) = [finding for finding in check_plan(AssemblyPlan.from_json(plan)) if finding.where == "parts.box.connectors.hinge.o[0]"]
    assert "half is a dimension of box" in told.message
    assert told.hint == r"Write it in parameters: '(\\g<9>) + 1'."


def test_all_faults_are_found_at_once() -> None:
    plan = document("wardrobe")
    plan["freedoms"] = 7
    part(plan, "cabinet")["material"] = "plywod"
    connector(plan, "door_left", "hinge")["x"] = [0, 1, 0]
    joint(plan, "slide_lower")["travel_mm"] = [10, 20]
    part(plan, "drawer_lower")["dimensions"]["length"] = "depth -"
    findings = check(plan)
    assert set(findings.codes) == {"E_DOF_MISMATCH", "E_MATERIAL_UNKNOWN", "E_MATE_ROLL", "E_REST_OUTSIDE_LIMITS", "E_EXPRESSION"}


def test_a_broken_parameter_is_reported_once_not_wherever_it_is_used() -> None:
    plan = document("wardrobe")
    plan["parameters"][3]["value"] = "1 / 0"
    assert check(plan).codes == ("E_NONFINITE",)


def test_parameters_at_their_bounds_are_not_reported_for_what_is_wrong_anyway() -> None:
    plan = chest()
    part(plan, "lid")["rest_pose"] = {"at": [1, 100, 80]}
    assert check(plan).codes == ("E_MATE_OFFSET",)


def test_many_faults_at_one_bound_are_counted() -> None:
    plan = document("wardrobe")
    for name in ("hinge_left", "hinge_right", "runner_lower", "runner_upper"):
        connector(plan, "cabinet", name)["o"][1] = f"{connector(plan, 'cabinet', name)['o'][1]} + 900 - width"
    findings = check(plan)
    at_min = [finding for finding in findings.of("W_PARAMETER_RANGE") if finding.where == "parameters.width.min"]
    assert len(at_min) == 3
    assert sum("(and 1 more)" in finding.message for finding in at_min) == 1


def test_a_parameter_range_that_divides_by_zero_is_reported() -> None:
    plan = chest()
    plan["parameters"] = [{"name": "width", "value": 300, "min": 0, "max": "2 * 300"}, {"name": "share", "value": "1 / width", "unit": "1"}]
    finding = only(check(plan), "W_PARAMETER_RANGE")
    assert "E_NONFINITE parameters.share.value: '1 / width' has no value: 1 is divided by zero." in finding.message
    assert (finding.value, finding.limit, finding.unit) == (0.0, 300.0, "mm")


def test_a_connector_on_an_axle_may_serve_several_joints() -> None:
    plan = chest_with(lambda p: (boards(p), second_hinge(p, type="fixed", child="shelf.s"), joint(p, "second").pop("angle_deg")))
    connector(plan, "box", "hinge")["kind"] = "shaft_axis"
    assert not check(plan).of("W_DUP_CONNECTOR_USE")


def test_a_connector_that_only_an_image_uses_is_used() -> None:
    plan = document("wardrobe")
    for name in ("door_left", "door_right"):
        part(plan, name)  # both exist
    part(plan, "door_left")["connectors"].append({"name": "latch", "o": [400, 0, 500], "z": Z, "x": [1, 0, 0], "label": ""})
    assert check(plan).codes == ("W_CONNECTOR_UNUSED",)
    latch = {"name": "latch", "material": "lacquer", "description": "", "rest_pose": "auto"}
    latch["connectors"] = [{"name": "foot", "o": [0, 0, 0], "z": Z, "label": ""}]  # type: ignore[assignment]
    plan["parts"].append(latch)
    plan["joints"].append({"name": "latch", "type": "fixed", "parent": "door_right.latch", "child": "latch.foot"})
    assert check(plan).codes == ("I_REST_AUTO",)


def test_a_mirrored_screw_changes_hand_and_says_so() -> None:
    plan = pair({"type": "screw", "lead_mm": 2, "angle_deg": "endless"}, 2)
    plane = {"point": [50, 0, 0], "normal": [1, 0, 0]}
    plan["parts"].append({"name": "b_m", "derive": {"from": "b", "op": "mirror", "plane": plane}})
    part(plan, "a")["connectors"].append({"name": "m", "o": [100, 0, 0], "z": Z, "label": ""})
    plan["joints"].append({"name": "m", "derive": {"from": "j", "op": "mirror"}, "parent": "a.m", "child": "b_m.c"})
    finding = only(check(plan), "W_CHIRAL")
    assert finding.where == "joints.m.derive"
    assert "its lead is -2 mm" in finding.message
    joint(plan, "j")["lead_mm"] = "1 +"
    assert only(check(plan), "W_CHIRAL").message.endswith("its thread has the other hand.")


@pytest.mark.parametrize(
    ("form", "needed"),
    [
        ({"type": "ball", "cone_deg": 30, "twist_deg": [-10, 20]}, "twist_deg [-20, 10]"),
        ({"type": "cylindrical", "travel_mm": [0, 9], "angle_deg": [-10, 20]}, "travel_mm [0, 9], angle_deg [-20, 10]"),
        ({"type": "slider", "travel_mm": [0, 9]}, None),
        ({"type": "revolute", "angle_deg": "endless"}, None),
        ({"type": "revolute", "angle_deg": [-20, 20]}, None),
    ],
)
def test_limits_repeated_on_a_mirrored_part_are_reported_where_the_mirror_changes_them(form: Json, needed: str | None) -> None:
    plan = pair(form, 0)
    plane = {"point": [50, 0, 0], "normal": [1, 0, 0]}
    plan["parts"].append({"name": "b_m", "derive": {"from": "b", "op": "mirror", "plane": plane}})
    part(plan, "a")["connectors"].append({"name": "m", "o": [100, 0, 0], "z": Z, "label": ""})
    plan["joints"].append({"name": "m", "parent": "a.m", "child": "b_m.c", **form})
    found = check(plan).of("W_MIRROR_LIMITS")
    assert [needed in finding.hint for finding in found if needed] == ([True] if needed else [])
    assert bool(found) == (needed is not None)


@pytest.mark.parametrize("angle_deg", [["turn", 1.5], [1.5, "turn"], ["turn", "turn"]])
def test_a_limit_that_names_nothing_is_reported_beside_one_that_looks_like_radians(angle_deg: list[object]) -> None:
    found = check(pair({"type": "revolute", "angle_deg": angle_deg}, 1))
    assert {finding.code for finding in found} == {"E_EXPRESSION"}


def test_screws_may_turn_many_times() -> None:
    assert not check(pair({"type": "screw", "lead_mm": 2, "angle_deg": [0, 7200]}, 1))


def test_a_pattern_name_that_does_not_fit_is_reported() -> None:
    plan = document("wardrobe")
    name = "a" * 39
    plan["parts"].append({"name": name, "derive": {"from": "door_left", "op": "pattern", "count": 1, "step": {"at": [0, 0, 9]}}})
    finding = only(check(plan), "E_NAME")
    assert finding.where == f"parts.{name}"


def test_freedoms_are_not_judged_while_a_joint_has_no_type() -> None:
    plan = document("wardrobe")
    joint(plan, "hinge_right")["derive"]["from"] = "nothing"
    assert check(plan).codes == ("E_DERIVE_UNKNOWN",)


# ---------------------------------------------------------------- loops and couplings


def test_a_loop_and_a_coupling_that_move_have_only_notes() -> None:
    assert check(document("geared_four_bar")).codes == ("I_REDUNDANT",)


def test_freedoms_of_a_loop_are_accounted_for() -> None:
    plan = document("geared_four_bar")
    plan["freedoms"] = 2
    finding = only(check(plan), "E_DOF_MISMATCH")
    assert finding.message == (
        "Declared freedoms 2, but the assembly has 1 "
        "(sum of joint freedoms 5, loop constraints of rank 3: loop frame-crank-coupler-rocker, couplings 1)."
    )
    assert finding.hint == "Set freedoms to 1, or change the joints if 2 is meant."
    assert (finding.value, finding.limit) == (2, 1)
    plan["couplings"], plan["freedoms"] = [], 2
    assert check(plan).codes == ("I_REDUNDANT",)


def test_too_many_drivers_are_refused() -> None:
    plan = document("geared_four_bar")
    joint(plan, "crank")["driver"] = True
    finding = only(check(plan), "E_DRIVER")
    assert finding.where == "joints.crank"
    assert "motor" in finding.message


def test_a_dead_point_in_a_drivers_range_is_reported_with_the_reachable_range() -> None:
    """kinematics §9: a non-Grashof four-bar 60/50/50/100 reaches 72.5423968763° of its crank."""
    plan = document("geared_four_bar")
    plan["couplings"] = plan["allow"] = []
    plan["parts"] = [each for each in plan["parts"] if each["name"] != "pinion"]
    plan["joints"] = [each for each in plan["joints"] if each["name"] != "motor"]
    part(plan, "frame")["connectors"].pop()
    for parameter, value in (("crank_length", 60), ("coupler_length", 50), ("rocker_length", 50), ("crank_rest", 40)):
        next(each for each in plan["parameters"] if each["name"] == parameter)["value"] = value
    joint(plan, "crank").update(angle_deg=[-90, 90], driver=True)
    findings = check(plan)
    assert "E_DEAD_POINT" in findings.codes, findings
    hints = " ".join(finding.hint for finding in findings.of("E_DEAD_POINT"))
    assert "32.54" in hints  # 72.542 less the 40 at which the crank rests


def test_loops_are_not_solved_while_the_rest_pose_does_not_meet() -> None:
    plan = document("geared_four_bar")
    connector(plan, "rocker", "d")["o"][0] = "span + 1"
    assert check(plan).codes == ("E_MATE_OFFSET",)


@pytest.mark.parametrize("error", [KinematicsError("too large"), np.linalg.LinAlgError("SVD did not converge")])
def test_what_the_mechanism_cannot_solve_is_not_supported_rather_than_an_exception(
    error: Exception, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fails(_: Mechanism) -> Findings:
        raise error

    monkeypatch.setattr(Mechanism, "findings", fails)
    finding = only(check(document("geared_four_bar")), "E_NOT_SUPPORTED")
    assert finding.message == f"The mechanism cannot be solved: {error}"


def test_an_error_of_the_mechanism_keeps_its_own_findings(monkeypatch: pytest.MonkeyPatch) -> None:
    finding = Finding(code="E_LOOP_OPEN", where="joints.rocker", message="", hint="")

    def opens(_: Mechanism) -> Findings:
        raise LoopError("open", findings=[finding])

    monkeypatch.setattr(Mechanism, "findings", opens)
    assert check(document("geared_four_bar")).codes == ("E_LOOP_OPEN",)
    monkeypatch.setattr(Mechanism, "findings", lambda _: Findings([finding]))
    assert check(document("geared_four_bar")).codes == ("E_LOOP_OPEN",)


# ---------------------------------------------------------------- it never raises

odd_numbers = st.sampled_from([0, -1, 1e-12, 1e300, -1e300, 360, "width", "nothing", "1 / 0", "1 +", "pi"])
paths: list[tuple[Any, ...]] = [
    ("parameters", 0, "value"),
    ("parameters", 0, "min"),
    ("materials", 0, "density_kg_m3"),
    ("parts", 0, "connectors", 0, "o", 0),
    ("parts", 0, "connectors", 0, "z", 2),
    ("parts", 0, "connectors", 0, "x", 0),
    ("parts", 1, "rest_pose", "at", 1),
    ("parts", 2, "derive", "plane", "normal", 0),
    ("parts", 4, "derive", "move", "at", 2),
    ("parts", 0, "envelope_mm", 1),
    ("joints", 0, "angle_deg", 0),
    ("joints", 2, "travel_mm", 1),
    ("joints", 0, "fit", "gap_mm", 0),
]
odd_names = st.sampled_from(["cabinet", "door_left", "door_right", "drawer_upper", "nothing", "hinge_left"])
name_paths: list[tuple[Any, ...]] = [
    ("ground",),
    ("parts", 0, "name"),
    ("parts", 1, "name"),
    ("parts", 1, "material"),
    ("parts", 2, "derive", "from"),
    ("parts", 4, "derive", "from"),
    ("joints", 0, "name"),
    ("joints", 1, "derive", "from"),
    ("joints", 3, "derive", "from"),
]
references = st.sampled_from(
    ["cabinet.hinge_left", "door_left.hinge", "door_right.hinge", "drawer_upper.slide", "cabinet.nothing", "no.no"]
)


def put(plan: Json, path: tuple[Any, ...], value: Any) -> None:
    node: Any = plan
    for step in path[:-1]:
        if node == "auto":
            return
        node = node[step]
    if node != "auto":
        node[path[-1]] = value


@settings(max_examples=80)
@given(st.data())
def test_no_plan_of_the_form_makes_the_check_raise(data: st.DataObject) -> None:
    plan = document("wardrobe")
    for _ in range(data.draw(st.integers(1, 3))):
        kind = data.draw(st.integers(0, 4))
        if kind == 0:
            put(plan, data.draw(st.sampled_from(paths)), data.draw(odd_numbers))
        elif kind == 1:
            put(plan, data.draw(st.sampled_from(name_paths)), data.draw(odd_names))
        elif kind == 2:
            plan["joints"][data.draw(st.integers(0, 3))][data.draw(st.sampled_from(["parent", "child"]))] = data.draw(references)
        elif kind == 3:
            plan["parts"][data.draw(st.sampled_from([0, 1, 3]))]["rest_pose"] = "auto"
        else:
            plan["parts"][data.draw(st.sampled_from([0, 1, 3]))]["connectors"][0]["frame"] = "assembly"
    try:
        read = AssemblyPlan.from_json(plan)
    except PlanError:
        return
    findings = check_plan(read)
    assert findings.to_json()["ok"] == findings.ok
    assert check_plan(read) == findings


# ---------------------------------------------------------------- corners


def test_a_parameter_that_cannot_be_read_is_reported_once() -> None:
    plan = chest()
    plan["parameters"].append({"name": "half", "value": "width /"})
    part(plan, "box")["dimensions"]["half"] = "half"
    finding = only(check(plan), "E_EXPRESSION")
    assert finding.where == "parameters.half.value"
    assert len(check(plan)) == 1


def test_two_parameters_that_share_a_broken_one_name_only_that() -> None:
    plan = chest()
    plan["parameters"] += [{"name": "a", "value": "b + c"}, {"name": "b", "value": "c"}, {"name": "c", "value": "nothing"}]
    assert [finding.where for finding in check(plan)] == ["parameters.c.value"]


def test_a_derived_joint_names_the_sources_own_connector() -> None:
    plan = document("wardrobe")
    part(plan, "drawer_lower")["connectors"].append({"name": "other", "o": [0, 0, 0], "z": [0, -1, 0], "x": [1, 0, 0], "label": ""})
    joint(plan, "slide_upper")["child"] = "drawer_upper.other"
    finding = only(check(plan), "E_DERIVE_JOINT")
    assert finding.hint == "Set child to drawer_upper.slide, or declare the joint in full."
    assert finding.parts == ("drawer_upper", "drawer_lower")


def test_a_derived_joint_without_any_image_is_to_be_declared_in_full() -> None:
    plan = chest()
    boards(plan)
    plan["joints"].append({"name": "k", "derive": {"from": "hinge", "op": "rigid"}, "parent": "box.hinge", "child": "shelf.s"})
    assert only(check(plan), "E_DERIVE_JOINT").hint == "Declare the joint in full, with its own type and limits."
    joint(plan, "k")["child"] = "shlf.s"
    assert check(plan).codes[0] == "E_PART_UNKNOWN"


def test_a_part_that_derives_from_a_broken_one_is_not_reported_again() -> None:
    plan = document("wardrobe")
    part(plan, "door_right")["derive"]["from"] = "nothing"
    plan["parts"].append({"name": "copy", "derive": {"from": "door_right", "op": "rigid", "move": {}}})
    assert len(check(plan).of("E_DERIVE_UNKNOWN")) == 1


def test_numbers_of_a_joint_that_fail_leave_the_others_judged() -> None:
    plan = pair({"type": "ball", "cone_deg": "1 / 0", "twist_deg": [0, "sqrt(-1)"]}, 3)
    assert {finding.where for finding in check(plan)} == {"joints.j.cone_deg", "joints.j.twist_deg[1]"}
    plan = pair({"type": "revolute", "angle_deg": [0, 90], "velocity_deg_s": "x", "fit": {"gap_mm": [0, 1], "within_mm": 3}}, 1)
    assert check(plan).codes == ("E_EXPRESSION",)


def test_a_coupling_of_a_joint_whose_numbers_fail_is_left_alone() -> None:
    plan = gears(type="gear", teeth=[1, 2], **TURNING)
    joint(plan, "turn_large")["angle_deg"] = [0, "1 / 0"]
    assert check(plan).codes == ("E_NONFINITE",)
    plan = gears(type="gear", teeth=[1, "1 / 0"], **TURNING)
    assert check(plan).codes == ("E_NONFINITE",)
    plan = gears(type="gear", teeth=[1, 2], **TURNING)
    part(plan, "frame")["rest_pose"] = {"axis": [0, 0, 0]}
    assert check(plan).codes == ("E_AXIS_ZERO",)


def test_what_a_joint_of_another_type_ties_is_described() -> None:
    plan = gears(type="belt", radii_mm=[1, 2], joints=["turn_small", "slide.a"])
    joint(plan, "slide").update(type="universal", a_deg=[-9, 9], b_deg=[-9, 9])
    del joint(plan, "slide")["travel_mm"]
    assert "slide.a is angle a of a universal joint" in only(check(plan), "E_COUPLING").message
    plan = gears(type="rack", module_mm=1, teeth=9, **TURNING)
    assert "turn_large is an angle about z" in only(check(plan), "E_COUPLING").message


def test_numbers_that_nothing_has_are_refused() -> None:
    plan = chest()
    connector(plan, "box", "hinge")["o"] = [1e300, 0, 0]
    finding = only(check(plan), "E_SCALE")
    assert (finding.where, finding.value, finding.limit) == ("parts.box.connectors.hinge.o[0]", 1e300, 1e12)


@pytest.mark.parametrize("degrees", [45, 90, 180, 270, 360, 720, 1800, 3600])
def test_limits_that_are_even_in_radians_alone_are_found_whatever_their_size(degrees: int) -> None:
    def codes(low: float, high: float) -> tuple[str, ...]:
        return check(chest_with(lambda p: joint(p, "hinge").update(angle_deg=[low, high]))).codes

    for radians in (math.radians(degrees), round(math.radians(degrees), 3)):
        assert "W_LIMITS_UNITS" in codes(0, radians)
        assert "W_LIMITS_UNITS" in codes(-radians, radians)
    if degrees <= 720:
        assert "W_LIMITS_UNITS" not in codes(0, degrees)
    assert "W_LIMITS_UNITS" not in codes(0, round(math.radians(degrees)) + 6.5)


def test_a_coupled_joint_may_turn_as_often_as_its_partner_asks_for() -> None:
    def turns_ten_times(plan: Json) -> None:
        joint(plan, "turn_small")["angle_deg"] = [0, 3600]

    screw = gears_with(turns_ten_times, type="screw", joints=["turn_small", "slide"], lead_mm=10)
    wheel = gears_with(turns_ten_times, type="screw", joints=["turn_large", "slide"], lead_mm=200)

    assert "W_LIMITS_UNITS" not in check(screw).codes
    assert "W_LIMITS_UNITS" in check(wheel).codes


def test_missing_freedoms_name_the_fixed_joints_at_axes() -> None:
    plan = json.loads((examples.folder("wardrobe") / "plan.json").read_text())
    slide = joint(plan, "slide_lower")
    for key in ("travel_mm", "fit"):
        slide.pop(key)
    slide["type"] = "fixed"
    finding = only(check(plan), "E_DOF_MISMATCH")
    assert finding.hint.endswith("These joints are fixed although their connectors suggest a motion: slide_lower, slide_upper.")
    assert finding.parts == ("cabinet", "drawer_lower", "drawer_upper")


def test_an_offset_may_be_as_small_as_a_clearance() -> None:
    def codes(name: str) -> set[str]:
        return set(
            check(chest_with(lambda p: part(p, "box").update(dimensions={"width": "width", "height": 200, "inset": 20, name: 0.006}))).codes
        )

    assert "W_SCALE" in codes("wall")
    assert "W_SCALE" not in codes("wall_offset")
