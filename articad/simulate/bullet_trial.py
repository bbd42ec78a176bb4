"""A model in PyBullet: loaded with a fixed base, held by position motors, watched for a second."""

from __future__ import annotations

import importlib
import math
from pathlib import Path
from typing import Any

from articad.simulate.verdict import Outcome

STEPS_PER_S = 240
HOLD_S = 1.0
HOLD_FORCE = 1e5  # N or N·m: whatever it takes
MOST_SPEED = 100.0  # rad/s or m/s


def run(path: Path) -> Outcome:
    """Load, hold and watch a model."""
    pybullet: Any = importlib.import_module("pybullet")
    client = pybullet.connect(pybullet.DIRECT)
    try:
        outcome = Outcome("pybullet", str(pybullet.getAPIVersion(client)))
        pybullet.setGravity(0, 0, -9.81, physicsClientId=client)
        if path.suffix.lower() == ".urdf":
            bodies = [pybullet.loadURDF(str(path), useFixedBase=True, physicsClientId=client)]
        else:
            bodies = list(pybullet.loadMJCF(str(path), physicsClientId=client))
        joints = [(body, joint) for body in bodies for joint in range(pybullet.getNumJoints(body, physicsClientId=client))]
        for body, joint in joints:
            kind = pybullet.getJointInfo(body, joint, physicsClientId=client)[2]
            if kind in {pybullet.JOINT_REVOLUTE, pybullet.JOINT_PRISMATIC}:
                place = pybullet.getJointState(body, joint, physicsClientId=client)[0]
                pybullet.setJointMotorControl2(
                    body, joint, pybullet.POSITION_CONTROL, targetPosition=place, force=HOLD_FORCE, physicsClientId=client
                )
        steps = int(HOLD_S * STEPS_PER_S)
        for step in range(steps):
            pybullet.stepSimulation(physicsClientId=client)
            speeds = [abs(pybullet.getJointState(body, joint, physicsClientId=client)[1]) for body, joint in joints]
            fastest = max(speeds, default=0.0)
            if not math.isfinite(fastest) or fastest > MOST_SPEED:
                outcome.exploded, outcome.top_speed = True, fastest
                return outcome
            outcome.top_speed = max(outcome.top_speed, fastest)
            if step >= 0.9 * steps:
                outcome.speed_at_rest = max(outcome.speed_at_rest, fastest)
        return outcome
    finally:
        pybullet.disconnect(client)
