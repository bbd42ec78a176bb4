"""The recipe for gear teeth that designers are told: what is made by it meshes, and would not if it stood half a tooth off."""

from __future__ import annotations

import math

import numpy as np
import pytest
from manifold3d import CrossSection

from articad.agents.prompts import prompt_file

RECIPE = (
    "At radius r a tooth reaches to each side of its middle by 90/z + v(20) - v(acos(rb/r)) degrees, v(a) = 180/pi*tan(a) - a, with base radius "
    "rb = m*z/2*cos(20) (straight inwards below rb), less 3/z degrees for play."
)
RACK = "A rack's teeth are pi*m apart, their flanks straight, 20 degrees from upright, pi*m/4 - 0.025*m to each side of the middle at the pitch line"


def reach(module: float, teeth: int, radius: float) -> float:
    """Return how far a tooth reaches to each side of its middle [degrees]."""
    base = module * teeth / 2 * math.cos(math.radians(20))
    angle = math.degrees(math.acos(base / max(radius, base)))
    return 90 / teeth + involute(20) - involute(angle) - 3 / teeth


def involute(angle: float) -> float:
    return 180 / math.pi * math.tan(math.radians(angle)) - angle


def gear(module: float, teeth: int, turned: float = 0.0) -> CrossSection:
    """Return a gear about the origin; a tooth points to `turned` degrees."""
    pitch = module * teeth / 2
    radii = np.linspace(pitch - 1.25 * module, pitch + module, 24)
    points = []
    for tooth in range(teeth):
        middle = 360 * tooth / teeth + turned
        for side, along in ((-1, radii), (1, radii[::-1])):
            angles = np.radians([middle + side * reach(module, teeth, radius) for radius in along])
            points += list(zip(along * np.cos(angles), along * np.sin(angles), strict=True))
    return CrossSection([np.array(points)])


def rack(module: float, pitch_line: float, shift: float = 0.0) -> CrossSection:
    """Return a rack whose teeth point to -X; a tooth's middle stands at y = shift."""
    half, slope = math.pi * module / 4 - 0.025 * module, math.tan(math.radians(20))
    tip, root = pitch_line - module, pitch_line + 1.25 * module
    points = [(root + module, 20 * module), (root + module, -20 * module)]
    for tooth in range(-5, 6):
        y = tooth * math.pi * module + shift
        near, far = half - module * slope, half + 1.25 * module * slope
        points += [(root, y - far), (tip, y - near), (tip, y + near), (root, y + far)]
    return CrossSection([np.array(points)[::-1]]) if _turns_left(points) < 0 else CrossSection([np.array(points)])


def _turns_left(points: list[tuple[float, float]]) -> float:
    x, y = np.array(points).T
    return float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))


def test_the_recipe_that_is_tried_here_is_the_one_that_designers_are_told() -> None:
    told = " ".join(prompt_file("teeth.md").split())
    assert RECIPE in told
    assert RACK in told


@pytest.mark.parametrize(("module", "a", "b"), [(1.0, 17, 17), (1.0, 18, 60), (2.0, 20, 30), (0.5, 24, 24), (3.0, 17, 40)])
def test_gears_by_the_recipe_turn_together_without_overlap_and_overlap_half_a_tooth_off(module: float, a: int, b: int) -> None:
    def overlap(turn: float, off: float = 0.0) -> float:
        other = gear(module, b, 180 + 180 / b + off / b - turn * a / b).translate((module * (a + b) / 2, 0))
        return float((gear(module, a, turn) ^ other).area())

    assert max(overlap(turn) for turn in np.linspace(0, 360 / a, 15)) < 1e-3 * module**2
    assert overlap(0.0, off=180) > module**2


@pytest.mark.parametrize(("module", "teeth"), [(1.0, 17), (2.0, 24), (0.5, 40)])
def test_a_pinion_by_the_recipe_rolls_on_its_rack_without_overlap(module: float, teeth: int) -> None:
    def overlap(turn: float, off: float = 0.0) -> float:
        rolled = math.radians(turn) * module * teeth / 2
        return float((gear(module, teeth, 180 / teeth + turn) ^ rack(module, module * teeth / 2, rolled + off)).area())

    assert max(overlap(turn) for turn in np.linspace(0, 360 / teeth, 15)) < 1e-3 * module**2
    assert overlap(0.0, off=math.pi * module / 2) > module**2
