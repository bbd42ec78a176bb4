"""Standing and tipping: closed formulas, and MuJoCo on a tilted floor."""

from __future__ import annotations

import math

import mujoco
import numpy as np
import pytest

from articad.support.stance import Stance, stance

WITHIN = math.radians(1.0)
SURFACE = 'friction="8 0 0" solref="0.004 1"'  # with MuJoCo's own contacts, which give way, the stools fall 2° earlier
Boxes = list[tuple[np.ndarray, np.ndarray]]  # middle and half sides [mm]


def stool(seed: int) -> Boxes:
    """Return three or four legs of one length under a top with a weight on it, somewhere."""
    rng = np.random.default_rng(seed)
    height = rng.uniform(60, 300)
    angles = (
        np.sort(rng.uniform(0, 2 * np.pi, 1)) + np.arange(3 + seed % 2) * 2 * np.pi / (3 + seed % 2) + rng.uniform(-0.3, 0.3, 3 + seed % 2)
    )
    feet = rng.uniform(60, 140) * np.column_stack([np.cos(angles), np.sin(angles)])
    boxes = [(np.array([x, y, height / 2]), np.array([5.0, 5.0, height / 2])) for x, y in feet]
    boxes.append((np.array([0.0, 0.0, height + 5]), np.array([150.0, 150.0, 5.0])))
    boxes.append((np.array([*rng.uniform(-30, 30, 2), height + 10 + 20]), np.array([30.0, 30.0, 20.0])))
    return boxes


def stands(boxes: Boxes) -> Stance:
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    points = np.concatenate([middle + signs * half for middle, half in boxes])
    volumes = np.array([half.prod() for _, half in boxes])
    return stance(points, volumes @ np.array([middle for middle, _ in boxes]) / volumes.sum())


def topples(boxes: Boxes, tilt: float, towards: np.ndarray) -> bool:
    """Return whether the boxes, as one body, fall over in MuJoCo with gravity tilted by an angle towards a direction."""
    geoms = "".join(
        f'<geom type="box" pos="{" ".join(map(str, middle / 1000))}" size="{" ".join(map(str, half / 1000))}" density="700" {SURFACE}/>'
        for middle, half in boxes
    )
    pull = 9.81 * np.array([*(math.sin(tilt) * towards), -math.cos(tilt)])
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><option timestep="0.001" gravity="{" ".join(map(str, pull))}" cone="elliptic" impratio="10"/>'
        f'<worldbody><geom type="plane" size="9 9 1" {SURFACE}/><body><freejoint/>{geoms}</body></worldbody></mujoco>'
    )
    data = mujoco.MjData(model)
    for _ in range(2000):
        mujoco.mj_step(model, data)
        if data.xmat[1][8] < math.cos(math.radians(12)):
            return True
    return False


@pytest.mark.parametrize("seed", range(25))
def test_a_stool_tips_over_in_mujoco_at_the_angle_that_is_stated(seed: int) -> None:
    boxes = stool(seed)
    found = stands(boxes)
    assert found.stands
    for towards in (found.towards, np.array([math.cos(seed), math.sin(seed)])):
        tip = found.tip_towards(towards)
        assert tip >= found.tip - 1e-9
        assert topples(boxes, tip + WITHIN, towards)
        assert not topples(boxes, tip - WITHIN, towards)


def test_a_block_tips_over_its_nearest_edge() -> None:
    found = stands([(np.array([0.0, 0.0, 30.0]), np.array([20.0, 10.0, 30.0]))])
    assert found.margin == pytest.approx(10.0)
    assert found.tip == pytest.approx(math.atan(10 / 30))
    assert abs(found.towards[1]) == pytest.approx(1.0)
    assert found.tip_towards(np.array([1.0, 0.0])) == pytest.approx(math.atan(20 / 30))


def test_a_gallows_with_its_mass_beside_its_foot_does_not_stand() -> None:
    foot = (np.array([0.0, 0.0, 5.0]), np.array([20.0, 20.0, 5.0]))
    found = stands([foot, (np.array([100.0, 0.0, 100.0]), np.array([30.0, 30.0, 30.0]))])
    assert not found.stands
    assert found.margin < -50
    assert found.tip < 0


def test_what_stands_on_an_edge_does_not_stand() -> None:
    points = np.array([[-10.0, 0, 0], [10, 0, 0], [0, 5, 8], [0, -5, 8]])
    assert not stance(points, np.array([0.0, 0.0, 5.0])).stands
