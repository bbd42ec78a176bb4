"""A blocker is looked for among the bodies that a joint moves."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from articad.simulation.mujoco_trial import Trial
from articad.simulation.verdict import EngineOutcome

pytestmark = pytest.mark.engines


def tree(rng: np.random.Generator, depth: int = 0) -> str:
    """Return random bodies below one another, each with up to three joints."""
    kinds = rng.choice(["hinge", "slide"], size=rng.integers(0, 4))
    joints = "".join(f'<joint type="{kind}" axis="{" ".join(map(str, rng.normal(size=3)))}"/>' for kind in kinds)
    below = "".join(tree(rng, depth + 1) for _ in range(rng.integers(0, 3))) if depth < 4 else ""
    return f'<body pos="{" ".join(map(str, rng.normal(size=3)))}"><geom size="0.1"/>{joints}{below}</body>'


@pytest.mark.parametrize("seed", range(10))
def test_a_joint_moves_the_bodies_whose_pose_changes_with_it(seed: int) -> None:
    rng = np.random.default_rng(seed)
    text = f"<mujoco><worldbody>{''.join(tree(rng) for _ in range(3))}</worldbody></mujoco>"
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)

    def poses() -> np.ndarray:
        mujoco.mj_kinematics(model, data)
        return np.hstack([data.xpos, data.xquat])

    rest, moves = poses(), Trial(model, data, EngineOutcome("mujoco", mujoco.__version__))._moves
    for joint in range(model.njnt):
        data.qpos[model.jnt_qposadr[joint]] = 0.3
        np.testing.assert_array_equal(moves[joint], (np.abs(poses() - rest) > 1e-9).any(axis=1))
        data.qpos[model.jnt_qposadr[joint]] = 0.0
