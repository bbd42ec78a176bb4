"""Held joints carry what rests on them, however light they are; what overlaps still pushes them."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from articad.simulation.trial import try_out
from articad.simulation.verdict import SimulationVerdict

pytestmark = pytest.mark.engines

MODEL = '<mujoco><compiler angle="radian" autolimits="true"/><option timestep="0.002" integrator="implicitfast"/><worldbody>{}</worldbody></mujoco>'
JOINTS = (
    '<joint name="{name}" type="hinge" axis="0 1 0" range="-1 1"/>',
    '<joint name="{name}" type="slide" axis="0 0 1" range="-0.1 0.1"/>',
    '<joint name="{name}" type="ball"/>',
    '<joint name="{name}" type="hinge" axis="1 0 0"/>',
)


def box(size: tuple[float, float, float], mass: float, pos: tuple[float, float, float] = (0, 0, 0)) -> str:
    """Return a box by its half sizes [m]."""
    words = [" ".join(f"{value:.6g}" for value in values) for values in (size, pos)]
    return f'<geom type="box" size="{words[0]}" pos="{words[1]}" mass="{mass:.6g}"/>'


def free(name: str, size: tuple[float, float, float], mass: float, pos: tuple[float, float, float]) -> str:
    return f'<body name="{name}" pos="{pos[0]:.6g} {pos[1]:.6g} {pos[2]:.6g}"><freejoint/>{box(size, mass)}</body>'


def tray(name: str, joint: str, mass: float, x: float, inside: str = "") -> str:
    """A plate of 200 x 200 x 10 mm beside its joint, whose upper face is 5 mm above that."""
    return f'<body name="{name}" pos="{x} 0 0.5">{joint.format(name=f"{name}_joint")}{box((0.1, 0.1, 0.005), mass, (0.11, 0, 0))}{inside}</body>'


def objections(folder: Path, bodies: str, *, driven: bool = False) -> tuple[str, ...]:
    path = folder / "model.xml"
    path.write_text(MODEL.format(bodies))
    outcome = try_out("mujoco", path, opened=() if driven else tuple(re.findall('joint name="([^"]*)"', bodies)))
    assert outcome.loads, outcome.message
    return tuple(str(finding) for finding in SimulationVerdict(str(path), (outcome,)).findings if finding.severity == "error")


def laden(seed: int) -> str:
    """Return a tray on a joint, perhaps with a second one under it, and a stack of free blocks on the tray.

    No block is more than three times as heavy as the one under it: in MuJoCo, heavy blocks on light ones topple on a fixed plate, too.
    """
    rng = np.random.default_rng(seed)
    mass, joint, x = 10 ** rng.uniform(-2, 0.5), JOINTS[rng.integers(len(JOINTS))], float(rng.uniform(-0.2, 0.2))
    load, blocks, top, at = 10 ** rng.uniform(-2, 1.3), "", 0.505, (x + 0.11 + rng.uniform(-0.05, 0.05), rng.uniform(-0.05, 0.05))
    for number in range(rng.integers(1, 4)):
        half = float(rng.uniform(0.01, 0.04))
        blocks += free(f"block_{number}", (0.03, 0.03, half), load, (*at, top + half))
        top, load = top + 2 * half, load * 10 ** rng.uniform(-1, 0.5)
    if rng.random() < 0.5:
        return tray("tray", joint, mass, x) + blocks
    above = f'<body name="upper" pos="{x} 0 0">{joint.format(name="upper_joint")}{box((0.1, 0.1, 0.005), mass, (0.11, 0, 0))}</body>'
    arm = JOINTS[rng.integers(len(JOINTS))].format(name="lower_joint")
    return f'<body name="lower" pos="0 0 0.5">{arm}{box((0.02, 0.02, 0.004), 10 ** rng.uniform(-2, 0))}{above}</body>' + blocks


@pytest.mark.parametrize("seed", [*range(12), 37, 44, 53, 127, 142, 165])
def test_a_light_part_carries_free_bodies_of_any_mass(seed: int, tmp_path: Path) -> None:
    assert not objections(tmp_path, laden(seed))


@pytest.mark.parametrize("joint", JOINTS[:2])
def test_a_tray_of_200_g_carries_2_kg_and_moves_with_them(joint: str, tmp_path: Path) -> None:
    laden = tray("tray", joint, 0.2, 0.0) + free("block", (0.03, 0.03, 0.03), 2.0, (0.1, 0, 0.535))
    assert not objections(tmp_path, laden, driven=True)


def test_a_free_body_in_the_way_stops_a_drawer(tmp_path: Path) -> None:
    """It stands on the floor and touches nothing at rest: its weight is its own."""
    floor = '<geom type="plane" size="1 1 0.1"/>'
    drawer = (
        f'<body name="drawer" pos="0 0 0.1"><joint name="pull" type="slide" axis="1 0 0" range="0 0.3"/>{box((0.1, 0.1, 0.03), 0.2)}</body>'
    )
    crate = free("crate", (0.1, 0.1, 0.1), 100.0, (0.3, 0, 0.1))
    assert any("E_SIM_RANGE" in finding for finding in objections(tmp_path, floor + drawer + crate, driven=True))


@pytest.mark.parametrize("ratio", [1.0, 30.0, 1000.0])
def test_two_parts_share_a_free_body_that_lies_across(ratio: float, tmp_path: Path) -> None:
    trays = tray("left", JOINTS[0], 0.05, -0.3) + tray("right", JOINTS[1], 0.02, 0.1)
    assert not objections(tmp_path, trays + free("plank", (0.22, 0.05, 0.01), 0.02 * ratio, (0.01, 0, 0.515)))


@pytest.mark.parametrize("mass", [0.5, 20.0])
def test_light_legs_carry_a_floating_body(mass: float, tmp_path: Path) -> None:
    """A table of four hinged legs stands on the ground; nothing but its joints holds it up."""
    legs = "".join(
        f'<body name="leg_{x}_{y}" pos="{0.15 * x} {0.1 * y} 0">{JOINTS[0].format(name=f"hip_{x}_{y}")}{box((0.01, 0.01, 0.1), 0.03, (0.03 * x, 0, -0.1))}</body>'
        for x in (-1, 1)
        for y in (-1, 1)
    )
    ground = '<geom type="plane" size="1 1 0.1"/>'
    body = f'<body name="table" pos="0 0 0.2"><freejoint/>{box((0.2, 0.15, 0.01), mass, (0, 0, 0.02))}{legs}</body>'
    assert not objections(tmp_path, ground + body)


@pytest.mark.parametrize("deep", [0.008, 0.015])
def test_a_free_body_that_is_squeezed_still_pushes(deep: float, tmp_path: Path) -> None:
    """Between two jaws that overlap it, 60 mm below their hinges; its weight, which they also bear, is no excuse."""
    jaws = "".join(
        f'<body name="jaw_{x}" pos="{0.03 * x} 0 0.55">{JOINTS[0].format(name=f"jaw_{x}")}{box((0.01, 0.03, 0.03), 0.1, (0, 0, -0.06))}</body>'
        for x in (-1, 1)
    )
    shelf = f'<body name="shelf" pos="0 0 0.45">{JOINTS[1].format(name="shelf_joint")}{box((0.02, 0.05, 0.005), 0.1)}</body>'
    said = objections(tmp_path, jaws + shelf + free("block", (0.02 + deep, 0.02, 0.025), 2.0, (0, 0, 0.48)))
    assert any("E_SIM_UNSETTLED" in finding for finding in said), said
