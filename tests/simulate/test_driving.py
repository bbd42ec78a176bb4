"""A crank drives heavy rockers through the ends of their swings: there it feels nothing of them."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from articad.simulation.trial import try_out
from articad.simulation.verdict import SimulationVerdict


def crank_rocker(seed: int) -> str:
    """Return a four-bar linkage as MJCF whose crank turns round (Grashof) and whose rocker is 100 to 1,000 times as heavy as the crank."""
    rng = np.random.default_rng(seed)
    crank, ground = rng.uniform(0.02, 0.04), rng.uniform(0.12, 0.2)
    rocker = rng.uniform(2.2 * crank, 0.9 * ground)
    coupler = ground + rng.uniform(-0.3, 0.3) * crank
    assert crank + max(coupler, ground) < rocker + min(coupler, ground)
    angle, heavy = rng.uniform(-math.pi, math.pi), 0.02 * 10 ** rng.uniform(2, 3)
    tip = crank * np.array([math.cos(angle), math.sin(angle)])
    across = np.array([ground, 0.0]) - tip
    span = float(np.linalg.norm(across))
    inside = math.acos((coupler**2 + span**2 - rocker**2) / (2 * coupler * span))
    of_coupler = math.atan2(across[1], across[0]) + inside
    end = tip + coupler * np.array([math.cos(of_coupler), math.sin(of_coupler)])
    bar = '<geom type="capsule" fromto="0 0 0 {0} 0 0" size="0.004" mass="{1}" contype="0" conaffinity="0"/>'
    of_rocker = math.atan2(end[1], end[0] - ground)
    return (
        '<mujoco><compiler angle="radian" autolimits="true"/><option gravity="0 0 0"/><worldbody>'
        f'<body euler="0 0 {angle}"><joint name="crank" axis="0 0 1" range="{-math.tau} {math.tau}"/>{bar.format(crank, 0.02)}'
        f'<body name="coupler" pos="{crank} 0 0" euler="0 0 {of_coupler - angle}"><joint name="pin" axis="0 0 1"/>{bar.format(coupler, 0.02)}</body></body>'
        f'<body name="rocker" pos="{ground} 0 0" euler="0 0 {of_rocker}"><joint name="rocker" axis="0 0 1"/>{bar.format(rocker, heavy)}</body></worldbody>'
        f'<equality><connect body1="coupler" body2="rocker" anchor="{coupler} 0 0"/></equality></mujoco>'
    )


@pytest.mark.parametrize("seed", range(8))
def test_a_crank_drives_a_heavy_rocker_all_round(seed: int, tmp_path: Path) -> None:
    path = tmp_path / "linkage.xml"
    path.write_text(crank_rocker(seed))

    outcome = try_out("mujoco", path, drivers=("crank",))

    assert "E_SIM_EXPLODES" not in SimulationVerdict(str(path), (outcome,)).findings.codes
    assert {reach.joint: reach.share for reach in outcome.reaches}["crank"] == pytest.approx(1.0, abs=0.02)
