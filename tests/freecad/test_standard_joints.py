"""Standard joints are made by both kernels alike, and the pin of a hinge needs no script in either."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from articad import Assembly
from articad.kernels.build123d import Build123dKernel
from articad.kernels.freecad import FreeCADKernel
from articad.kernels.parts import PIN_SCRIPT
from articad.plan.schema import AssemblyPlan
from tests.freecad import opened

pytestmark = [pytest.mark.freecad, opened.needs_freecad]
Json = dict[str, Any]
UP, SIDE, ASKEW = ((0, 0, 1), (1, 0, 0)), ((0, 1, 0), (0, 0, 1)), ((1 / 3, 2 / 3, 2 / 3), (2 / 3, 1 / 3, -2 / 3))
DOWN, TURNED = ((0, 0, -1), (1, 0, 0)), ((0, 0, 1), (math.cos(0.5), math.sin(0.5), 0))
SEGMENT = 10 * math.sqrt(16**2 - 10**2) + 16**2 * math.asin(10 / 16)  # of a half disc of radius 16, cut off at 10 to both sides
HALF_BALL = 2 / 3 * math.pi * 5**3

# box (corner and size) or none, dimensions, place of each connector and its z and x, volume by a closed formula [mm³]
PARTS: dict[str, tuple[Any, Any, Any, float]] = {
    "a pin askew": (
        None,
        {"turn_pin": 8, "turn_length": 24, "turn_head": 14, "turn_thick": 4, "turn_tail": 6},
        {"turn": ((5, -3, 2), ASKEW)},
        math.pi * 16 * 30 + math.pi * 49 * 4,
    ),
    "a fork with its pin and groove": (
        ((-30, -15, -10), (30, 30, 20)),
        {"j_pin": 8, "j_span": 40, "j_gap": 10.3, "j_reach": 16, "clip_shaft": 8, "clip_groove": 7.6, "clip_width": 0.9},
        {"j": ((0, 0, 0), SIDE), "clip": ((0, 18, 0), SIDE)},
        30 * 30 * 20 - SEGMENT * 10.3 + math.pi * 16 * 40 - math.pi * 16 / 2 * 19.7 - math.pi * (16 - 3.8**2) * 0.9,
    ),
    "ends of every other kind": (
        ((-40, -30, -20), (80, 60, 40)),
        {"a_bore": 8, "a_depth": 10, "b_slot_x": 6, "b_slot_y": 4, "b_depth": 12, "c_socket": 10, "d_pin": 8, "d_length": 15}
        | {"e_bar_x": 6, "e_bar_y": 4, "e_length": 9, "f_ball": 10, "g_bore": 5},
        {
            "a": ((-30, -20, 20), DOWN),
            "b": ((-30, 20, 20), DOWN),
            "c": ((-10, 0, 20), UP),
            "d": ((20, -20, 20), UP),
            "e": ((20, 20, 20), TURNED),
            "f": ((40, 0, 0), UP),
            "g": ((0, 0, -10), SIDE),
        },
        80 * 60 * 40 - math.pi * (160 - 240 + 6.25 * 60) - 6 * 4 * (12 - 9) + 0 * HALF_BALL,
    ),
}


@pytest.mark.parametrize("name", PARTS)
def test_both_kernels_make_the_features_of_standard_joints(name: str) -> None:
    """Every dimension drives the solid, too: the probe of both kernels has no finding."""
    box, dimensions, places, volume = PARTS[name]
    connectors = {key: {"o": o, "z": z, "x": x, "label": "", "joints": []} for key, (o, (z, x)) in places.items()}
    told: Json = {"name": "it", "description": "", "material": "steel", "dimensions": dimensions, "envelope_mm": None}
    told["connectors"] = connectors
    scripts = {"freecad": PIN_SCRIPT.decode(), "build123d": PIN_SCRIPT.decode()}
    if box is not None:
        (x, y, z), (a, b, c) = box
        scripts = {
            "freecad": f"def build(part):\n    part.box({box[0]}, {box[1]})\n    return part.made(part.body)\n",
            "build123d": "from build123d import *\ndef build(part):\n"
            f"    return part.made(Pos({x + a / 2}, {y + b / 2}, {z + c / 2}) * Box({a}, {b}, {c}))\n",
        }
    native = FreeCADKernel(timeout=300.0, probe_timeout=300.0).build(scripts["freecad"].encode(), told)
    other = Build123dKernel().build(scripts["build123d"].encode(), told)
    for built in (native, other):
        assert not built.findings, built.findings
        assert built.solid.volume == pytest.approx(volume, rel=1e-9)
    assert native.solid.com == pytest.approx(other.solid.com, abs=1e-6)
    assert native.solid.bbox.ravel() == pytest.approx(other.solid.bbox.ravel(), abs=1e-6)


GATE: Json = {
    "schema": "articad.short/1",
    "name": "gate",
    "ground": "post",
    "freedoms": 1,
    "kernel": "freecad",
    "material": "oak",
    "parts": {"post": "thick=10", "leaf": "thick=10"},
    "joints": {"swing": "hinge post leaf bolt; at 0,0,20.4 along -z; pin 8,20.4; head 14,4; angle 0,90"},
}
BOARD = """
def build(part):
    part.box((-15, -15, {low}), (30, 30, "thick"))
    return part.made(part.body)
"""


def test_freecad_makes_the_pin_of_a_hinge_without_a_script(tmp_path: Path) -> None:
    for name, low in (("post", "0"), ("leaf", '"-thick - 0.2"')):
        (tmp_path / f"{name}.freecad.py").write_text(BOARD.format(low=low))
    built = Assembly.from_plan(AssemblyPlan.from_json(GATE), tmp_path)
    assert built.realised["bolt"].script == PIN_SCRIPT
    mass = built.parts["bolt"].mass
    assert mass is not None
    assert mass.mass == pytest.approx(7850e-9 * math.pi * (16 * 20.4 + 49 * 4), rel=1e-6)
    checks = built.check()
    assert checks.ok, str(checks.findings)
    assert [row.to_json()["play_mm"] for row in checks.fits] == pytest.approx([0.15], abs=1e-3)
