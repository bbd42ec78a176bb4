"""Planted: a lid that falls in, a drawer that floats, a shelf without pegs, each of several sizes; and the same products as they should be."""

from __future__ import annotations

import math

import manifold3d as m3
import numpy as np
import pytest

from articad.kinematics.joints import Joint
from tests.disassembly.test_order import block
from tests.interference.mechanisms import joint
from tests.support.test_support import supported

Product = tuple[dict[str, m3.Manifold], str, float]  # solids, the part that is loose, how far it falls


def loose(part: str) -> list[Joint]:
    return [joint("lies", "free", "case", part, lower=(-math.inf,) * 6, upper=(math.inf,) * 6)]


def lid(seed: int, *, good: bool) -> Product:
    """A box and a lid at its rim, larger than the opening or smaller."""
    rng = np.random.default_rng(seed)
    side, wall, height = rng.uniform(40, 90), rng.uniform(3, 6), rng.uniform(25, 60)
    case = block((0, side), (0, side), (0, height)) - block((wall, side - wall), (wall, side - wall), (wall, height + 1))
    edge = wall / 2 if good else wall + rng.uniform(0.5, 2)
    low = height if good else height - 4
    return {"case": case, "lid": block((edge, side - edge), (edge, side - edge), (low, low + 4))}, "lid", low - wall


def drawer(seed: int, *, good: bool) -> Product:
    """A case and a tray on runners, or above the bottom without them."""
    rng = np.random.default_rng(seed)
    wide, high, at = rng.uniform(60, 120), rng.uniform(60, 100), rng.uniform(20, 35)
    case = block((0, wide), (0, 80), (0, high)) - block((4, wide - 4), (-1, 76), (4, high - 4))
    if good:
        case += block((3, 12), (0, 77), (at - 5, at)) + block((wide - 12, wide - 3), (0, 77), (at - 5, at))
    return {"case": case, "tray": block((5, wide - 5), (0, 70), (at, at + 15))}, "tray", at - 4


def shelf(seed: int, *, good: bool) -> Product:
    """Two walls and a shelf on four pegs, or without them."""
    rng = np.random.default_rng(seed)
    wide, at = rng.uniform(80, 150), rng.uniform(30, 60)
    case = block((0, 5), (0, 40), (0, 100)) + block((wide - 5, wide), (0, 40), (0, 100)) + block((0, wide), (0, 40), (0, 5))
    for x in (4, wide - 10) if good else ():
        case += block((x, x + 6), (5, 10), (at - 5, at)) + block((x, x + 6), (30, 35), (at - 5, at))
    return {"case": case, "shelf": block((6, wide - 6), (2, 38), (at, at + 4))}, "shelf", at - 5


@pytest.mark.parametrize("make", [lid, drawer, shelf])
@pytest.mark.parametrize("seed", range(3))
def test_what_falls_is_named_with_the_height(make: object, seed: int) -> None:
    solids, part, height = make(seed, good=False)  # type: ignore[operator]
    (finding,) = supported(solids, loose(part), "case").findings
    assert finding.code == "W_NOT_CARRIED"
    assert finding.parts == (part,)
    assert finding.value == pytest.approx(height, abs=0.1)


@pytest.mark.parametrize("make", [lid, drawer, shelf])
@pytest.mark.parametrize("seed", range(3))
def test_nothing_is_named_where_everything_is_carried(make: object, seed: int) -> None:
    solids, part, _ = make(seed, good=True)  # type: ignore[operator]
    assert not supported(solids, loose(part), "case").findings
