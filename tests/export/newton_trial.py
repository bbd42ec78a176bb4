"""A model in Newton: loaded by its own readers, then held and driven joint by joint over its ranges.

Springs hold and drive the joints, as stiff as their inertia allows, without gravity: what stops a joint is a contact, a limit or a loop.
Newton's solver is that of MuJoCo on the processor; bodies, joints, mimics, loops and collision pairs are what Newton's readers make of the
file. Newton pins MuJoCo, so it lives in an environment of its own: `judges.py` runs this file there.

Newton 1.8 has a known defect in closed loops: its solver computes a loop joint's anchor on the child from the poses at zero coordinates and
ignores the joint's frame on the child, although its readers have read it (newton-physics/newton, issue 2293 and pull request 4248). A loop
that is open at zero becomes another mechanism. The trial puts the joint's own anchor there, and the outcome says so.
"""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from articad.simulation.strokes import FREE_SLIDE_M, MOST_JOINTS, MOST_SPEED, PACE_M_S, PACE_RAD_S, STROKE_S, strokes
from articad.simulation.verdict import EngineOutcome, JointReach, Role, covered

FloatArray = NDArray[np.float64]

TIMESTEP_S: Final = 0.002
STIFFNESS: Final = 60.0  # ω of the springs [1/s]
HOLD_S: Final = 0.5
ENDLESS: Final = 1e9  # Newton's limits of joints without limits are beyond
ANCHORED: Final = "anchors of loops corrected"
LEAST_ANCHOR_M: Final = 1e-6


class Trial:
    """One model under test.

    Args:
        path: A URDF, MJCF or USD file.
        rest: Where hinges and slides start by name [rad or m].
    """

    def __init__(self, path: Path, rest: Mapping[str, float]) -> None:
        import newton
        import warp
        from newton.solvers import SolverMuJoCo

        warp.config.quiet = True
        builder = newton.ModelBuilder()
        SolverMuJoCo.register_custom_attributes(builder)
        kind = path.suffix.lower()
        if kind == ".urdf":
            builder.add_urdf(str(path), floating=False)
        elif kind.startswith(".usd"):
            builder.add_usd(str(path))
        else:
            builder.add_mjcf(str(path))
        self.solver_class, self.newton = SolverMuJoCo, newton
        self.model = builder.finalize(device="cpu")
        self.model.set_gravity((0.0, 0.0, 0.0))
        self.outcome = EngineOutcome("newton", str(newton.__version__))
        self.names = self._names()
        q = self.model.joint_q.numpy().astype(float)
        for dof, name in self.names.items():
            q[self.coordinates[dof]] = rest.get(name, q[self.coordinates[dof]])
        self.start = q

    def _names(self) -> dict[int, str]:
        """Return the names of hinges and slides of the tree by degree of freedom; a body's joints have their names in one label.

        Newton does not update the coordinates of joints that close loops.
        """
        model = self.model
        labels, kinds = list(model.joint_label), model.joint_type.numpy()
        starts, places = model.joint_qd_start.numpy(), model.joint_q_start.numpy()
        dims, articulations = model.joint_dof_dim.numpy(), model.joint_articulation.numpy()
        single = {int(self.newton.JointType.REVOLUTE), int(self.newton.JointType.PRISMATIC), int(self.newton.JointType.D6)}
        found: dict[int, str] = {}
        self.coordinates: dict[int, int] = {}
        self.slides: set[int] = set()
        for joint, label in enumerate(labels):
            if int(kinds[joint]) not in single or articulations[joint] < 0:
                continue
            linear, angular = (int(n) for n in dims[joint])
            words = _split(label.rpartition("/")[2], linear + angular)
            for index in range(linear + angular):
                dof = int(starts[joint]) + index
                found[dof] = words[index]
                self.coordinates[dof] = int(places[joint]) + index
                if index < linear:
                    self.slides.add(dof)
        return found

    def run(self, drivers: tuple[str, ...] | None, following: frozenset[str], opened: frozenset[str]) -> EngineOutcome:
        """Hold, then drive; return what was measured.

        Args:
            drivers: Joints that drive; None for all.
            following: Joints that follow drivers, by loops or couplings.
            opened: Joints that are not driven, because their loop is open; "*" for all.
        """
        self._prepare()
        mimics = {self.names[dof] for dof in self.names if self._follows(dof)}
        self.outcome.passed_over = tuple(name for name in self.names.values() if "*" in opened or name in opened)
        free = (following | mimics) - set(drivers or ())
        driven = [dof for dof, name in self.names.items() if name not in free and name not in self.outcome.passed_over]
        self._hold([dof for dof, name in self.names.items() if name not in free])
        self.outcome.untried = max(0, len(driven) - MOST_JOINTS)
        low, high = np.array(self.start), np.array(self.start)
        tied = bool(free)
        for dof in driven[:MOST_JOINTS]:
            if self.outcome.exploded:
                return self.outcome
            ends = self._stroke(dof, {one for one, name in self.names.items() if name in free})
            at = self.coordinates[dof]
            lower, upper = self._range(dof)
            name, unit = self.names[dof], "m" if dof in self.slides else "rad"
            role: Role = "driver" if tied and drivers is not None and name in drivers else "free"
            share = covered(ends[0][at], ends[1][at], lower, upper)
            loop = 0 if role == "driver" else None
            self.outcome.reaches.append(JointReach(name, lower, upper, float(ends[0][at]), float(ends[1][at]), share, unit, "", role, loop))
            np.minimum(low, ends[0], out=low)
            np.maximum(high, ends[1], out=high)
        for dof, name in self.names.items():
            if name in following and name in free:
                at, unit = self.coordinates[dof], "m" if dof in self.slides else "rad"
                ends_ = float(low[at]), float(high[at])
                self.outcome.reaches.append(JointReach(name, *ends_, *ends_, 1.0, unit, "", "follower", 0))
        return self.outcome

    def _prepare(self) -> None:
        """Turn the joints into springs that are as stiff as their inertia at rest allows."""
        import mujoco

        model = self.model
        model.joint_q.assign(self.start.astype(np.float32))
        dofs = model.joint_dof_count
        model.joint_target_ke.assign(np.zeros(dofs, dtype=np.float32))
        model.joint_target_kd.assign(np.zeros(dofs, dtype=np.float32))
        mode = np.full(dofs, int(self.newton.JointTargetMode.POSITION), dtype=np.int32)
        model.joint_target_mode.assign(mode)
        model.joint_effort_limit.assign(np.full(dofs, 1e6, dtype=np.float32))
        self.solver = self.solver_class(model, use_mujoco_cpu=True)
        mj, data = self.solver.mj_model, self.solver.mj_data
        mujoco.mj_forward(mj, data)
        whole = np.zeros((mj.nv, mj.nv))
        mujoco.mj_fullM(mj, data, whole)
        inertia = np.diag(whole)
        self._anchor_loops()
        self.inertia = np.full(dofs, float(inertia.max(initial=1e-6)))
        self.inertia[: len(inertia)] = inertia[:dofs]
        self._held: tuple[int, ...] | None = None

    def _springs(self, held: list[int]) -> None:
        """Give springs to these degrees of freedom, none to the others."""
        if self._held == tuple(held):
            return
        self._held = tuple(held)
        ke, kd = np.zeros(len(self.inertia)), np.zeros(len(self.inertia))
        ke[held] = self.inertia[held] * STIFFNESS**2
        kd[held] = 2 * self.inertia[held] * STIFFNESS
        self.model.joint_target_ke.assign(ke.astype(np.float32))
        self.model.joint_target_kd.assign(kd.astype(np.float32))
        self.solver.notify_model_changed(self.newton.ModelFlags.JOINT_DOF_PROPERTIES)
        self._anchor_loops()  # the solver has computed them anew

    def _anchor_loops(self) -> None:
        """Put the child's anchor of each row of a loop joint where the joint's frames say.

        With the joint's frames (R_p, p_p) on the parent and (R_c, p_c) on the child, the point a on the parent meets
        p_c + R_c R_pᵀ (a − p_p) on the child, for any a on the joint's axis.
        """
        model, mj = self.model, self.solver.mj_model
        if not mj.neq:
            return
        places = [_flat(getattr(self.solver, name)) for name in ("mjc_eq_to_newton_jnt", "mjc_eq_to_newton_eq")]
        targets = getattr(getattr(model, "mujoco", None), "equality_constraint_target", None)
        targets = None if targets is None else targets.numpy()
        parents, children = model.joint_X_p.numpy().astype(float), model.joint_X_c.numpy().astype(float)
        for row in range(mj.neq):
            if mj.eq_type[row] != 0:  # not a CONNECT
                continue
            joint = int(places[0][row])
            if joint < 0 and targets is not None and places[1][row] >= 0:
                joint = int(targets[places[1][row]])
            if joint < 0:
                continue
            way = _matrix(parents[joint][3:]).T @ (mj.eq_data[row, :3] - parents[joint][:3])
            anchor = children[joint][:3] + _matrix(children[joint][3:]) @ way
            self.outcome.message = ANCHORED if np.abs(mj.eq_data[row, 3:6] - anchor).max() > LEAST_ANCHOR_M else self.outcome.message
            mj.eq_data[row, 3:6] = anchor

    def _reset(self) -> None:
        self.now, self.next, self.control = self.model.state(), self.model.state(), self.model.control()
        self.now.joint_q.assign(self.start.astype(np.float32))
        self.now.joint_qd.zero_()
        self.solver.reset(self.now) if hasattr(self.solver, "reset") else None

    def _step(self, target: FloatArray) -> None:
        self.control.joint_target_q.assign(target.astype(np.float32))
        self.now.clear_forces()
        self.solver.step(self.now, self.next, self.control, None, TIMESTEP_S)
        self.now, self.next = self.next, self.now
        speed = np.abs(self.now.joint_qd.numpy()[list(self.names)]).max(initial=0.0)
        self.outcome.top_speed = max(self.outcome.top_speed, float(speed))
        self.outcome.exploded = not math.isfinite(speed) or bool(speed > MOST_SPEED)

    def _hold(self, held: list[int]) -> None:
        self._reset()
        self._springs(held)
        steps, calm = round(HOLD_S / TIMESTEP_S), 0.0
        for step in range(steps):
            self._step(self._target())
            if self.outcome.exploded:
                return
            if step >= 0.9 * steps:
                calm = max(calm, float(np.abs(self.now.joint_qd.numpy()[list(self.names)]).max(initial=0.0)))
        self.outcome.speed_at_rest = calm
        here = self.now.joint_q.numpy()
        away = (abs(float(here[self.coordinates[dof]] - self.start[self.coordinates[dof]])) for dof in self.names)
        self.outcome.moved_at_rest = max(away, default=0.0)
        data, mj = self.solver.mj_data, self.solver.mj_model
        rows = data.efc_type[: data.nefc] == 0  # equality constraints
        self.outcome.residual = float(np.abs(data.efc_pos[: data.nefc][rows]).max(initial=0.0)) if mj.neq else 0.0

    def _target(self) -> FloatArray:
        """Return the rest pose as targets."""
        target = np.array(self.control.joint_target_q.numpy(), dtype=float)
        for dof, at in self.coordinates.items():
            target[at if len(target) == len(self.start) else dof] = self.start[at]
        return target

    def _stroke(self, dof: int, free: set[int]) -> tuple[FloatArray, FloatArray]:
        """Drive one degree of freedom over its range; return the least and greatest coordinates of all."""
        self._reset()
        self._springs([one for one in self.names if one == dof or one not in free])
        lower, upper = self._range(dof)
        at, target = self.coordinates[dof], self._target()
        place = at if len(target) == len(self.start) else dof
        low, high = np.array(self.start), np.array(self.start)
        pace = PACE_M_S if dof in self.slides else PACE_RAD_S
        steps = round(max(STROKE_S, (upper - lower) / pace) / TIMESTEP_S)
        for value in strokes(float(self.start[at]), lower, upper, steps):
            target[place] = value
            self._step(target)
            if self.outcome.exploded:
                break
            here = self.now.joint_q.numpy().astype(float)
            np.minimum(low, here, out=low)
            np.maximum(high, here, out=high)
        return low, high

    def _range(self, dof: int) -> tuple[float, float]:
        """Return what a joint is driven over: its limits, else one turn or a little travel."""
        lower, upper = (float(bounds.numpy()[dof]) for bounds in (self.model.joint_limit_lower, self.model.joint_limit_upper))
        rest = float(self.start[self.coordinates[dof]])
        if lower < -ENDLESS or upper > ENDLESS:
            return (rest - FREE_SLIDE_M, rest + FREE_SLIDE_M) if dof in self.slides else (rest, rest + math.tau)
        if dof not in self.slides and upper - lower > 2 * math.tau:
            return max(lower, rest - math.tau), min(upper, rest + math.tau)
        return lower, upper

    def _follows(self, dof: int) -> bool:
        """True for a joint that Newton ties to another one."""
        joints = self.model.joint_qd_start.numpy()
        joint = int(np.searchsorted(joints, dof, side="right")) - 1
        named = self.model.joint_mimic_joint
        rows = getattr(self.model, "constraint_mimic_joint0", None)
        return (named is not None and int(named.numpy()[joint]) >= 0) or (rows is not None and joint in rows.numpy().tolist())


def _flat(array: Any) -> FloatArray:
    return np.asarray(array.numpy() if hasattr(array, "numpy") else array).reshape(-1)


def _matrix(quaternion: FloatArray) -> FloatArray:
    """Return the rotation of a quaternion x, y, z, w."""
    v, w = quaternion[:3], quaternion[3]
    cross = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    return np.asarray(np.eye(3) + 2 * w * cross + 2 * cross @ cross)


def _split(label: str, count: int) -> list[str]:
    """Return the names of a body's joints: Newton puts those of one body into one label, "slide__t_slide__r"."""
    if count <= 1:
        return [label]
    words = label.split("_")
    share = len(words) // count
    if share * count == len(words):
        return ["_".join(words[index * share : (index + 1) * share]) for index in range(count)]
    return [f"{label}.{index}" for index in range(count)]


def tried(path: str, options: dict[str, Any]) -> EngineOutcome:
    """Return what was measured of a file; a failure to load it as a message."""
    drivers = options.get("drivers")
    try:
        return Trial(Path(path), options.get("rest", {})).run(
            None if drivers is None else tuple(drivers), frozenset(options.get("following", ())), frozenset(options.get("opened", ()))
        )
    except Exception as error:  # noqa: BLE001 - whatever Newton raises about a file is its answer
        return EngineOutcome("newton", loads=False, message=f"{type(error).__name__}: {error}"[:300])


def main() -> int:
    """Try the models that lines of the input name, `[path, options]`, and print what was measured, a line for each."""
    for line in sys.stdin:
        path, options = json.loads(line)
        print("\n" + json.dumps(asdict(tried(path, options))), flush=True)  # noqa: T201 - this is the answer
    return 0


if __name__ == "__main__":
    sys.exit(main())
