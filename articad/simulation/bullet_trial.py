"""A model in PyBullet: loaded with a fixed base, held by position motors, then driven joint by joint over its ranges."""

from __future__ import annotations

import importlib
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from articad.simulation.strokes import FREE_SLIDE_M, MOST_JOINTS, MOST_SPEED, PACE_M_S, PACE_RAD_S, STROKE_S, led, strokes
from articad.simulation.verdict import EngineOutcome, JointReach, covered

STEPS_PER_S = 240
SOLVER_ITERATIONS = 500  # PyBullet's 50 do not converge where a light link carries a heavy one: held joints drift
HOLD_S = 1.0
MOST_TURN_RAD = 40 * PACE_RAD_S  # over which a hinge is driven
HOLD_FORCE = 1e5  # N or N·m: as large as needed


@dataclass(frozen=True)
class _Joint:
    """A hinge or slide of a loaded body, driven between two values [rad or m] from its initial value."""

    body: int
    index: int
    name: str
    unit: str
    lower: float
    upper: float
    start: float


@dataclass
class _Trial:
    """One model under test."""

    bullet: Any
    client: int
    outcome: EngineOutcome
    bodies: list[int]
    rest: Mapping[str, float]
    mimics: Mapping[str, tuple[str, float, float]]
    opened: frozenset[str]

    def run(self) -> EngineOutcome:
        """Hold, then drive; return the measurements."""
        made = list(self._joints())
        found = {joint.name: joint for joint in made}
        followers = led(self.mimics, found)
        starts = {name: ratio * found[leader].start + offset for name, (leader, ratio, offset) in followers.items()}
        joints = [replace(joint, start=starts.get(joint.name, joint.start)) for joint in made]
        self._reset(joints)
        steps = int(HOLD_S * STEPS_PER_S)
        seen: dict[_Joint, list[float]] = {joint: [] for joint in joints}
        for step in range(steps):
            self._step({joint: joint.start for joint in joints})
            if self.outcome.exploded:
                return self.outcome
            if step >= 0.9 * steps:
                for joint, values in seen.items():
                    values.append(self._value(joint))
        # by travel over time: a motor at a stop always reports a speed, which the stop cancels in each step
        ways = (max(values) - min(values) for values in seen.values())
        self.outcome.speed_at_rest = max(ways, default=0.0) / (0.1 * HOLD_S)
        away = (abs(self._value(joint) - joint.start) for joint in joints)
        self.outcome.moved_at_rest = max(away, default=0.0)
        kept = [joint for joint in joints if "*" not in self.opened and joint.name not in self.opened]
        self.outcome.passed_over = tuple(joint.name for joint in joints if joint not in kept)
        kept = [joint for joint in kept if joint.name not in followers]
        self.outcome.untried = max(0, len(kept) - MOST_JOINTS)
        for joint in kept[:MOST_JOINTS]:
            self.outcome.reaches.append(self._stroke(joint, joints, followers))
            if self.outcome.exploded:
                break
        return self.outcome

    def _stroke(self, joint: _Joint, joints: list[_Joint], led_by: Mapping[str, tuple[str, float, float]]) -> JointReach:
        """Drive one joint over its range with its followers, and hold the others."""
        self._reset(joints)
        targets = {other: other.start for other in joints}
        followers = [(one, *led_by[one.name][1:]) for one in joints if one.name in led_by and led_by[one.name][0] == joint.name]
        low = high = joint.start
        pace = PACE_RAD_S if joint.unit == "rad" else PACE_M_S
        steps = round(max(STROKE_S, (joint.upper - joint.lower) / pace) * STEPS_PER_S)
        for value in strokes(joint.start, joint.lower, joint.upper, steps):
            self._step(targets | {joint: value} | {one: ratio * value + offset for one, ratio, offset in followers})
            if self.outcome.exploded:
                break
            here = self._value(joint)
            low, high = min(low, here), max(high, here)
        return JointReach(joint.name, joint.lower, joint.upper, low, high, covered(low, high, joint.lower, joint.upper), joint.unit)

    def _joints(self) -> Iterator[_Joint]:
        """Yield hinges and slides; unlimited ones are driven through one turn or a short travel."""
        bullet = self.bullet
        for body in self.bodies:
            for index in range(bullet.getNumJoints(body, physicsClientId=self.client)):
                row = bullet.getJointInfo(body, index, physicsClientId=self.client)
                kind, lower, upper = row[2], float(row[8]), float(row[9])
                if kind not in {bullet.JOINT_REVOLUTE, bullet.JOINT_PRISMATIC}:
                    continue
                turns = kind == bullet.JOINT_REVOLUTE
                if lower > upper:  # PyBullet's notation for an endless joint
                    lower, upper = (0.0, math.tau) if turns else (-FREE_SLIDE_M, FREE_SLIDE_M)
                elif turns and upper - lower > MOST_TURN_RAD:
                    lower, upper = max(lower, -MOST_TURN_RAD / 2), min(upper, MOST_TURN_RAD / 2)
                name = row[1].decode(errors="replace")
                yield _Joint(body, index, name, "rad" if turns else "m", lower, upper, min(max(self.rest.get(name, 0.0), lower), upper))

    def _reset(self, joints: list[_Joint]) -> None:
        for joint in joints:
            self.bullet.resetJointState(joint.body, joint.index, joint.start, 0.0, physicsClientId=self.client)

    def _value(self, joint: _Joint) -> float:
        return float(self.bullet.getJointState(joint.body, joint.index, physicsClientId=self.client)[0])

    def _step(self, targets: dict[_Joint, float]) -> float:
        """Step once with the motors at their targets; return the largest speed."""
        for joint, value in targets.items():
            self.bullet.setJointMotorControl2(
                joint.body,
                joint.index,
                self.bullet.POSITION_CONTROL,
                targetPosition=value,
                force=HOLD_FORCE,
                physicsClientId=self.client,
            )
        self.bullet.stepSimulation(physicsClientId=self.client)
        speeds = [abs(self.bullet.getJointState(joint.body, joint.index, physicsClientId=self.client)[1]) for joint in targets]
        fastest = max(speeds, default=0.0)
        self.outcome.top_speed = max(self.outcome.top_speed, fastest)
        self.outcome.exploded = not math.isfinite(fastest) or fastest > MOST_SPEED
        return fastest


def run(
    path: Path,
    rest: Mapping[str, float] | None = None,
    mimics: Mapping[str, tuple[str, float, float]] | None = None,
    opened: frozenset[str] = frozenset(),
) -> EngineOutcome:
    """Load, hold and drive a model; parts of one body do not collide, as with PyBullet's defaults.

    Inertias are those of the file. PyBullet reads them from a URDF, and from an MJCF with `diaginertia` and `inertiafromgeom="false"`;
    otherwise, it computes them from the boxes of the collision shapes. An MJCF is not tried if a link has neither: it would be another model.

    Args:
        path: A URDF or MJCF file.
        rest: Initial values of joints by name [rad or m], zero by default.
        mimics: Leader, multiplier and offset of joints that follow others: PyBullet couples nothing, so they are driven with their
            leader.
        opened: Joints that are not driven; "*" for all.
    """
    bullet: Any = importlib.import_module("pybullet")
    client = bullet.connect(bullet.DIRECT)
    try:
        outcome = EngineOutcome("pybullet", str(bullet.getAPIVersion(client)))
        stated = bullet.URDF_USE_INERTIA_FROM_FILE
        if path.suffix.lower() == ".urdf":
            bodies = [bullet.loadURDF(str(path), useFixedBase=True, flags=stated, physicsClientId=client)]
        else:
            for flags in (stated, 0):
                bodies = list(bullet.loadMJCF(str(path), flags=flags, physicsClientId=client))
                outcome.unread = tuple(_without_inertia(bullet, client, bodies))
                if not outcome.unread:
                    break
                bullet.resetSimulation(physicsClientId=client)
            for body in bodies if not outcome.unread else ():
                bullet.changeDynamics(body, -1, mass=0, physicsClientId=client)  # makes its base a fixed one
        if outcome.unread:
            return outcome
        bullet.setGravity(0, 0, -9.81, physicsClientId=client)
        bullet.setPhysicsEngineParameter(numSolverIterations=SOLVER_ITERATIONS, physicsClientId=client)
        return _Trial(bullet, client, outcome, bodies, rest or {}, mimics or {}, opened).run()
    finally:
        bullet.disconnect(client)


def _without_inertia(bullet: Any, client: int, bodies: list[int]) -> Iterator[str]:
    """Yield the names of links that have a mass and no inertia."""
    for body in bodies:
        for link in range(bullet.getNumJoints(body, physicsClientId=client)):
            mass, _, inertia = bullet.getDynamicsInfo(body, link, physicsClientId=client)[:3]
            if mass > 0 and not any(inertia):
                yield bullet.getJointInfo(body, link, physicsClientId=client)[12].decode(errors="replace")
