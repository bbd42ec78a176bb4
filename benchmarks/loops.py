"""Closed loops: a four-bar closed to 1e-10, beside Newton on Pinocchio's constraint Jacobian and MuJoCo's own relaxation.

python benchmarks/loops.py [--out loops.json]
"""

# ruff: noqa: SLF001 - the peer's calls run on the model inside
from __future__ import annotations

import argparse
import math
import sys
import time
from functools import partial
from pathlib import Path

import mujoco
import numpy as np
import pinocchio as pin

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from articad.connectors import SE3, Attachment, Connector
from articad.kinematics import Mechanism
from articad.kinematics.declare import revolute
from benchmarks.timing import Goal, Table, measure, report
from tests.kinematics.linkages import scissor, stewart

cpu_time = partial(measure, clock=time.process_time)  # every method here uses one thread

CRANK, COUPLER, ROCKER, GROUND = 100.0, 250.0, 200.0, 220.0  # mm
AT = 0.7  # rad, crank
COLD = (0.3, -0.2)  # rad, off the solution
CONFIGURATIONS = 10_000
TOLERANCE = 1e-10


def closed_angles(crank: float) -> tuple[float, float]:
    """Return the absolute angles of coupler and rocker by the intersection of two circles: the reference for every method."""
    bx, by = CRANK * math.cos(crank), CRANK * math.sin(crank)
    dx, dy = GROUND - bx, -by
    d2 = dx * dx + dy * dy
    k = (COUPLER**2 - ROCKER**2 + d2) / (2 * d2)
    h = math.sqrt(COUPLER**2 / d2 - k * k)
    x, y = bx + k * dx - h * dy, by + k * dy + h * dx
    return math.atan2(y - by, x - bx), math.atan2(y, x - GROUND)


def four_bar() -> Mechanism:
    """Return the linkage, resting at the crank angle `AT`, joints crank, b, c, rocker."""

    def on(part: str, name: str, x: float) -> Attachment:
        return Attachment(part, Connector(name, SE3.from_translation([x, 0, 0])))

    coupler, rocker = closed_angles(AT)
    joints = [
        revolute("crank", on("frame", "a", 0), on("crank", "a", 0), limits="endless", rest=AT, driver=True),
        revolute("b", on("crank", "b", CRANK), on("coupler", "b", 0), limits="endless", rest=coupler - AT),
        revolute("rocker", on("frame", "d", GROUND), on("rocker", "d", 0), limits="endless", rest=rocker),
        revolute("c", on("coupler", "c", COUPLER), on("rocker", "c", ROCKER), limits="endless", rest=rocker - coupler),
    ]
    return Mechanism(("frame", "crank", "coupler", "rocker"), "frame", joints)


class Articad:
    """The closure solver by itself, from the same cold start, and the whole mechanism along its driver."""

    def __init__(self) -> None:
        self.mechanism = four_bar()
        branch = self.mechanism.branch
        self.system, self.dependent = branch.system, branch.dependent
        coupler, rocker = closed_angles(AT)
        start = {"crank": AT, "b": coupler - AT + COLD[0], "rocker": rocker + COLD[1], "c": rocker - coupler - 0.1}
        everything = np.array([start[coordinate.name] for coordinate in self.mechanism.coordinates])
        self.cold = self.system.to_system(everything[None])[0]
        self.q = np.linspace(AT, AT + 2 * math.pi, CONFIGURATIONS)[:, None]

    def solve(self) -> float:
        """Close, polish, and find the rank; return the residual."""
        closed = self.system.close(self.cold, self.dependent)
        assert closed.rank == 3
        return closed.residual

    def sweep(self) -> np.ndarray:
        """Return all coordinates along the driver, the way itself found anew each time."""
        mechanism = four_bar()
        return mechanism.configuration(self.q).columns

    def tracked(self) -> np.ndarray:
        """The same once the path is known, as for the second call on one mechanism."""
        return self.mechanism.configuration(self.q).columns


class Pinocchio:
    """Newton with Pinocchio's own constraint Jacobian, crank held."""

    def __init__(self) -> None:
        model = pin.Model()

        def place(x: float) -> pin.SE3:
            return pin.SE3(np.eye(3), np.array([x / 1000, 0.0, 0.0]))

        crank = model.addJoint(0, pin.JointModelRZ(), place(0), "crank")
        self.coupler = model.addJoint(crank, pin.JointModelRZ(), place(CRANK), "coupler")
        self.rocker = model.addJoint(0, pin.JointModelRZ(), place(GROUND), "rocker")
        self.tip, self.end = place(COUPLER), place(ROCKER)
        self.model, self.data = model, model.createData()
        local = pin.ReferenceFrame.LOCAL
        self.closure = pin.RigidConstraintModel(pin.ContactType.CONTACT_3D, model, self.coupler, self.tip, self.rocker, self.end, local)
        self.closure_data = self.closure.createData()
        coupler, rocker = closed_angles(AT)
        self.cold = np.array([AT, coupler - AT + COLD[0], rocker + COLD[1]])

    def newton(self, q: np.ndarray) -> np.ndarray:
        """Return the closed configuration."""
        for _ in range(50):
            pin.computeJointJacobians(self.model, self.data, q)
            A, B = self.data.oMi[self.coupler] * self.tip, self.data.oMi[self.rocker] * self.end
            gap = A.translation - B.translation
            if gap @ gap < TOLERANCE**2:
                return q
            self.closure.calc(self.model, self.data, self.closure_data)  # the Jacobian is stale without it
            J = pin.getConstraintJacobian(self.model, self.data, self.closure, self.closure_data)
            q = q.copy()
            q[1:] -= np.linalg.lstsq(J[:, 1:], A.rotation.T @ gap, rcond=None)[0]
        raise RuntimeError("no convergence")

    def solve(self) -> np.ndarray:
        """From the cold start."""
        return self.newton(self.cold)

    def sweep(self) -> np.ndarray:
        """Warm-started along the crank."""
        q, rows = self.cold, []
        for angle in np.linspace(AT, AT + 2 * math.pi, CONFIGURATIONS // 10):  # a tenth: the rest is proportional
            q = q.copy()
            q[0] = angle
            q = self.newton(q)
            rows.append(q)
        return np.array(rows)


class Mujoco:
    """What users do: step the dynamics until a `connect` has closed."""

    def __init__(self) -> None:
        def body(name: str, x: float, inner: str) -> str:
            inertial = '<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>'
            return f'<body name="{name}" pos="{x / 1000} 0 0"><joint name="{name}" axis="0 0 1"/>{inertial}{inner}</body>'

        coupler = body("coupler", CRANK, f'<site name="tip" pos="{COUPLER / 1000} 0 0"/>')
        rocker = body("rocker", GROUND, f'<site name="end" pos="{ROCKER / 1000} 0 0"/>')
        self.model = mujoco.MjModel.from_xml_string(
            '<mujoco><option gravity="0 0 0" timestep="0.001" solver="Newton" tolerance="0" iterations="200"/>'
            f"<worldbody>{body('crank', 0, coupler)}{rocker}</worldbody>"
            '<equality><connect site1="tip" site2="end" solref="0.002 1" solimp="0.9999 0.9999 0.001"/></equality></mujoco>'
        )
        self.data = mujoco.MjData(self.model)
        angles = closed_angles(AT)
        self.cold = np.array([AT, angles[0] - AT + COLD[0], angles[1] + COLD[1]])

    def solve(self) -> float:
        """Return the gap that is left [m]."""
        mujoco.mj_resetData(self.model, self.data)
        self.data.qpos[:] = self.cold
        gap = 1.0
        for _ in range(3000):
            self.data.qvel[:] *= 0.9
            mujoco.mj_step(self.model, self.data)
            gap = float(np.linalg.norm(self.data.site("tip").xpos - self.data.site("end").xpos))
            if gap < TOLERANCE:
                break
        return gap


def one_configuration_table(name: str, mechanism: Mechanism) -> Table:
    """Return the times of all residuals and their Jacobian at rest, beside the calls of Pinocchio that give the same numbers.

    Both use one model of the linkage: Pinocchio's part is computeJointJacobians, calc and getConstraintsJacobian, and log6 of each loop.
    Its Jacobian is unscaled, in its own order, and right on closed loops alone; the difference is what scaling and order cost.
    """
    (group,) = mechanism.branch.groups
    system = group.system
    loop_model = system._one
    assert loop_model is not None
    Q, model, data = group.Q, loop_model._model, loop_model._data
    q, constraints, workspaces = loop_model._map.q(Q), loop_model._constraints, loop_model._workspaces
    pairs = list(zip(constraints, workspaces, strict=True))

    def bare() -> tuple[np.ndarray, np.ndarray]:
        pin.computeJointJacobians(model, data, q)
        for constraint, workspace in pairs:
            constraint.calc(model, data, workspace)
        J = pin.getConstraintsJacobian(model, data, constraints, workspaces)
        return np.concatenate([pin.log6(workspace.c1Mc2).vector for _, workspace in pairs]), J

    ranks = [np.linalg.matrix_rank(J, 1e-9) for J in (bare()[1], system.evaluate_one(Q)[1])]
    assert ranks[0] == ranks[1]
    methods = {
        "articad": lambda: system.evaluate_one(Q),
        "Pinocchio's constraint Jacobian": bare,
        "articad, batch of one": lambda: system.evaluate(Q[None]),
    }
    goal = Goal("articad", "Pinocchio's constraint Jacobian", at_most=1.5)
    return Table(f"{name}: residuals and Jacobian of one configuration", cpu_time(methods), (goal,))


def cold_table(name: str, mechanism: Mechanism, at_most: float) -> Table:
    """Return the times of closing a linkage from 0.2 rad and 0.2 lengths off, drivers held, beside Newton on the same model in Pinocchio.

    Newton takes bare least-squares steps until |r| < 1e-10: no damping, no polish, no units.

    Args:
        name: Of the linkage.
        mechanism: The linkage.
        at_most: Goal for the ratio. Closing in NumPy took 2.4 times Newton for the scissor and 4.4 times for the Stewart platform: the
            first must not be slower than that, the second twice as fast.
    """
    branch = mechanism.branch
    system, free = branch.system, branch.dependent
    loop_model = system._one
    assert loop_model is not None
    offsets = np.random.default_rng(3).uniform(-0.2, 0.2, len(free))
    cold = system.move(system.to_system(branch.Q_rest), np.where(free, offsets, 0.0))
    model, data = loop_model._model, loop_model._data
    start, constraints, workspaces = loop_model._map.q(cold), loop_model._constraints, loop_model._workspaces
    order = np.arange(model.nv) if loop_model._order is None else loop_model._order
    moving = order[free]

    def newton() -> np.ndarray:
        q, v = start, np.zeros(model.nv)
        for _ in range(50):
            pin.computeJointJacobians(model, data, q)
            for constraint, workspace in zip(constraints, workspaces, strict=True):
                constraint.calc(model, data, workspace)
            r = np.concatenate([pin.log6(workspace.c1Mc2).vector for workspace in workspaces])
            if r @ r < TOLERANCE**2:
                return q
            J = pin.getConstraintsJacobian(model, data, constraints, workspaces)
            v[moving] = np.linalg.lstsq(J[:, moving], r, rcond=1e-10)[0]
            q = pin.integrate(model, q, v)
        raise RuntimeError("no convergence")

    newton()
    assert system.close(cold, free).ok
    times = cpu_time({"articad": lambda: system.close(cold, free), "Newton on Pinocchio": newton})
    return Table(f"{name}: one cold close", times, (Goal("articad", "Newton on Pinocchio", at_most=at_most),))


def main() -> int:
    """Measure, print, and return the number of goals missed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", help="write the tables as JSON")
    options = parser.parse_args()
    ours, newton, dynamics = Articad(), Pinocchio(), Mujoco()
    coupler, rocker = closed_angles(AT)
    found = newton.solve()
    assert abs(found[1] - (coupler - AT)) < 1e-8
    assert abs(found[2] - rocker) < 1e-8
    columns = [coordinate.name for coordinate in ours.mechanism.coordinates]
    swept = ours.tracked()
    truth = np.unwrap([closed_angles(angle)[1] for angle in ours.q[:, 0]])
    error = float(np.abs(swept[:, columns.index("rocker")] - truth).max())
    single = Table(
        "four-bar, one cold solve to 1e-10, 0.3 rad off (articad: with polish and rank)",
        cpu_time({"articad": ours.solve, "Newton on Pinocchio": newton.solve, "MuJoCo stepping": dynamics.solve}),
        (Goal("articad", "Newton on Pinocchio", at_most=3.0), Goal("articad", "MuJoCo stepping", at_least=8.0)),
        (f"residual articad {ours.solve():.1e}, gap MuJoCo {dynamics.solve():.1e} m",),
    )
    times = cpu_time({"articad": ours.sweep, "articad, way known": ours.tracked, "Newton on Pinocchio": newton.sweep}, rounds=5)
    each = times.each({"articad": CONFIGURATIONS, "articad, way known": CONFIGURATIONS, "Newton on Pinocchio": CONFIGURATIONS // 10})
    along = Table(
        f"four-bar, {CONFIGURATIONS} closed configurations along the crank, time for each",
        each,
        (Goal("articad", "Newton on Pinocchio", at_most=0.2),),
        (f"largest error of the rocker against the closed formula {error:.1e} rad",),
    )
    linkages = {"four-bar": four_bar(), "scissor of four stages": scissor(4), "Stewart platform": stewart()}
    closing = [cold_table(name, linkages[name], goal) for name, goal in (("scissor of four stages", 2.4), ("Stewart platform", 2.2))]
    return report([single, along, *(one_configuration_table(*row) for row in linkages.items()), *closing], options.out)


if __name__ == "__main__":
    sys.exit(min(main(), 1))
