"""A small cupboard for tests of edits: every kind of part that a document has, all with feature trees of FreeCAD's."""

from __future__ import annotations

import json
from functools import cache

import articad as ac

PLAN = {
    "schema": "articad.plan/1",
    "name": "cupboard",
    "ground": "cabinet",
    "freedoms": 4,
    "tree": True,
    "kernel": "freecad",
    "parameters": [
        {"name": "width", "value": 400, "min": 200, "max": 900},
        {"name": "height", "value": 300, "min": 100, "max": 900},
        {"name": "depth", "value": 200, "min": 100, "max": 400},
        {"name": "wall", "value": 16, "min": 8, "max": 30},
        {"name": "door", "value": "width / 2 - 2", "description": "width of a door"},
        {"name": "opening", "value": 95, "unit": "deg", "min": 30, "max": 120},
        {"name": "ajar", "value": 10, "unit": "deg", "min": 0, "max": 30, "description": "how far the flap stands open at rest"},
    ],
    "materials": [
        {"name": "oak", "density_kg_m3": 700, "color": "#b08050"},
        {"name": "brass", "density_kg_m3": 8500, "color": "#d0b040"},
    ],
    "parts": [
        {
            "name": "cabinet",
            "material": "oak",
            "description": "A slab behind the doors.",
            "dimensions": {"width": "width", "height": "height", "wall": "wall"},
            "connectors": [
                {"name": "left", "o": ["-width / 2", 0, 0], "z": [0, 0, 1], "x": [1, 0, 0], "label": "hinge of the left door"},
                {"name": "right", "o": ["width / 2", 0, 0], "z": [0, 0, 1], "x": [-1, 0, 0], "label": "hinge of the right door"},
                {"name": "rail", "o": [0, "wall", "height"], "z": [0, -1, 0], "x": [1, 0, 0], "label": "where the tray slides"},
                {"name": "stop", "o": [-22, "200 - wall", "height / 2"], "z": [0, -1, 0], "x": [1, 0, 0], "label": "seat of the stop"},
                {"name": "top", "o": [0, 0, "height + 60"], "z": [1, 0, 0], "x": [0, -1, 0], "label": "hinge of the flap"},
            ],
        },
        {
            "name": "door_left",
            "material": "oak",
            "description": "A board from its hinge along +X.",
            "dimensions": {"door": "door", "height": "height", "wall": "wall"},
            "rest_pose": {"at": ["-width / 2", 0, 0]},
            "connectors": [
                {"name": "hinge", "o": [0, 0, 0], "z": [0, 0, 1], "x": [1, 0, 0], "label": "axis"},
                {
                    "name": "grip",
                    "o": ["door - 20", "-wall", "height / 2"],
                    "z": [0, -1, 0],
                    "x": [1, 0, 0],
                    "label": "where the knob sits",
                },
            ],
        },
        {
            "name": "door_right",
            "color": "#205080",
            "derive": {"from": "door_left", "op": "mirror", "plane": {"point": [0, 0, 0], "normal": [1, 0, 0]}},
        },
        {
            "name": "knob",
            "material": "brass",
            "description": "A cylinder along -Y.",
            "dimensions": {"radius": 8, "length": 20},
            "rest_pose": "auto",
            "connectors": [{"name": "foot", "o": [0, 0, 0], "z": [0, -1, 0], "x": [1, 0, 0], "label": "foot"}],
        },
        {
            "name": "tray",
            "material": "oak",
            "description": "A board that slides along -Y.",
            "dimensions": {"width": "width - 40", "depth": "depth"},
            "rest_pose": {"at": [0, "wall", "height"]},
            "connectors": [{"name": "rail", "o": [0, 0, 0], "z": [0, -1, 0], "x": [1, 0, 0], "label": "runner"}],
        },
        {
            "name": "flap",
            "material": "oak",
            "description": "A board that hangs from its hinge along -Y, and stands ajar.",
            "dimensions": {"width": "width - 50", "depth": "depth"},
            "rest_pose": "auto",
            "connectors": [{"name": "hinge", "o": [0, 0, 0], "z": [1, 0, 0], "x": [0, -1, 0], "label": "axis"}],
        },
        {
            "name": "stop",
            "color": "#303030",
            "derive": {"from": "knob", "op": "rigid", "move": {"at": [0, 200, 0]}},
        },
    ],
    "joints": [
        {"name": "left", "type": "revolute", "parent": "cabinet.left", "child": "door_left.hinge", "angle_deg": ["-opening", 0]},
        {"name": "right", "derive": {"from": "left", "op": "mirror"}, "parent": "cabinet.right", "child": "door_right.hinge"},
        {"name": "grip", "type": "fixed", "parent": "door_left.grip", "child": "knob.foot"},
        {"name": "slide", "type": "slider", "parent": "cabinet.rail", "child": "tray.rail", "travel_mm": [0, "depth - 30"]},
        {
            "name": "flap_hinge",
            "type": "revolute",
            "parent": "cabinet.top",
            "child": "flap.hinge",
            "angle_deg": [0, 100],
            "rest_deg": "ajar",
        },
        {"name": "stopper", "type": "fixed", "parent": "cabinet.stop", "child": "stop.foot"},
    ],
}

SCRIPTS = {
    "cabinet": """
def build(part):
    part.box(("-width / 2", 0, 0), ("width", "wall", "height"), name="Slab")
    return part.body, {
        "left": part.connector("left", ("-width / 2", 0, 0), (0, 0, 1)),
        "right": part.connector("right", ("width / 2", 0, 0), (0, 0, 1)),
        "rail": part.connector("rail", (0, "wall", "height"), (0, -1, 0)),
        "stop": part.connector("stop", (-22, "200 - wall", "height / 2"), (0, -1, 0)),
        "top": part.connector("top", (0, 0, "height + 60"), (1, 0, 0)),
    }
""",
    "door_left": """
def build(part):
    part.box((0, "-wall", 0), ("door", "wall", "height"), name="Board")
    part.cylinder(("door - 40", "-wall", "height - 40"), "+Y", 10, "wall", cut=True, name="Window")
    return part.body, {
        "hinge": part.connector("hinge", (0, 0, 0), (0, 0, 1)),
        "grip": part.connector("grip", ("door - 20", "-wall", "height / 2"), (0, -1, 0)),
    }
""",
    "knob": """
def build(part):
    part.cylinder((0, 0, 0), "-Y", "radius", "length", name="Stem")
    return part.body, {"foot": part.connector("foot", (0, 0, 0), (0, -1, 0))}
""",
    "tray": """
def build(part):
    part.box(("-width / 2", "-depth", 0), ("width", "depth", 12), name="Board")
    return part.body, {"rail": part.connector("rail", (0, 0, 0), (0, -1, 0))}
""",
    "flap": """
def build(part):
    part.box(("-width / 2", "-depth", -6), ("width", "depth", 12), name="Board")
    return part.body, {"hinge": part.connector("hinge", (0, 0, 0), (1, 0, 0))}
""",
}


def plan() -> ac.AssemblyPlan:
    return ac.AssemblyPlan.loads(json.dumps(PLAN))


@cache
def assembly(**parameters: float) -> ac.Assembly:
    return ac.Assembly.from_plan(plan(), SCRIPTS, parameters=parameters)
