"""A model in Newton: loaded by its own readers and stood by its own solver, then driven joint by joint over its ranges.

Newton's solver on the processor is MuJoCo's. Bodies, joints, mimics, loops and collision pairs are what Newton's readers make of the file, in the model
that its solver compiles. That model first stands in steps of Newton's solver, held by springs, without gravity. Then `articad.simulation.mujoco_trial`
asks of it what it asks of an MJCF in MuJoCo: joints are held and driven by computed torque for the inertia that they feel through loops and couplings,
at a pace that followers can keep, with gravity, and the energy after release may not grow. Newton pins MuJoCo, so it lives in an environment of its own:
`judges.py` runs this file there.

Newton 1.8 has a known defect in closed loops: its solver computes a loop joint's anchor on the child from the poses at zero coordinates and
ignores the joint's frame on the child, although its readers have read it (newton-physics/newton, issue 2293 and pull request 4248). A loop
that is open at zero becomes another mechanism. The trial puts the joint's own anchor there, and the outcome says so.
"""

from __future__ import annotations

import json
import signal
import sys
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, Final

import mujoco
import numpy as np
from numpy.typing import NDArray

from articad.simulation import mujoco_trial
from articad.simulation.verdict import GROWTH, EngineOutcome

FloatArray = NDArray[np.float64]

TIMESTEP_S: Final = 0.002
PROCESSOR_SECONDS: Final = 3600.0  # for one file
STIFFNESS: Final = 60.0  # ω of the springs [1/s]
STAND_S: Final = 0.2
ANCHORED: Final = "anchors of loops corrected"
LEAST_ANCHOR_M: Final = 1e-6
EVERY: Final = 5  # steps after which it is asked again what is stable
FINER: Final = (1, 4, 16)  # steps in one of TIMESTEP_S, while energy grows


@dataclass
class Trial(mujoco_trial.Trial):
    """The model that Newton's solver compiled; joints have the names of the file."""

    names: Mapping[int, str] = field(default_factory=dict)

    _told: tuple[int, float] = (0, 1.0)

    def _name(self, joint: int) -> str:
        return self.names[joint]

    def _step(
        self, target: FloatArray | None, held: NDArray[np.int_], free: set[int] | None = None, pace: FloatArray | None = None
    ) -> bool:
        """Step once, with the inertia that joints feel at rest as far as it is stable now.

        Newton's loops are soft, and at a dead point a crank feels less than at rest. A damping of 2 ω times an inertia A that is applied
        explicitly at steps h is stable while 2 ω h λ < 2 for the eigenvalues λ of P A, where P maps forces to accelerations within a step:
        P = M⁻¹ - M⁻¹ Jᵀ (J M⁻¹ Jᵀ + R)⁻¹ J M⁻¹, with MuJoCo's regularisation R. Half of that is used at most.
        """
        felt = self.felt
        if felt is not None:
            age, share = self._told
            if age % EVERY == 0:
                model, data, rows = self.model, self.data, self._equalities()
                mass = np.zeros((model.nv, model.nv))
                mujoco.mj_fullM(model, data, mass)
                inverse, J = np.linalg.inv(mass), self._jacobian(rows)
                R = np.diag(np.asarray(data.efc_R)[: data.nefc][rows])
                P = inverse - inverse @ J.T @ np.linalg.solve(J @ inverse @ J.T + R, J @ inverse)
                largest = np.abs(np.linalg.eigvals(P[np.ix_(held, held)] @ felt)).max(initial=1e-12)
                share = min(1.0, 1 / (2 * mujoco_trial.STIFFNESS * float(model.opt.timestep) * largest))
            self._told, self.felt = (age + 1, share), felt * share
        done = super()._step(target, held, free, pace)
        self.felt = felt
        return done

    def _let_go(self) -> None:
        """Release the model; its file states no time step, so where energy grows at one, shorter ones decide, where integration errs less."""
        own = float(self.model.opt.timestep)
        for finer in FINER:
            self.model.opt.timestep = own / finer
            super()._let_go()
            if (self.outcome.energy_growth or 0.0) <= GROWTH:
                break
        self.model.opt.timestep = own


class Standing:
    """A model in Newton.

    Args:
        path: A URDF, MJCF or USD file.
        rest: Where hinges and slides start by name [rad or m].
        freedoms: Names of the freedoms of joints that have several, slides before turns.
    """

    def __init__(self, path: Path, rest: Mapping[str, float], freedoms: Mapping[str, list[str]]) -> None:
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
        self.newton, self.rest, self.freedoms = newton, rest, freedoms
        self.model = model = builder.finalize(device="cpu")
        self.outcome = EngineOutcome("newton", str(newton.__version__))
        self.solver = SolverMuJoCo(model, use_mujoco_cpu=True)
        self.names = self._names()
        self._anchor_loops()

    def _names(self) -> dict[int, str]:
        """Return the names of the compiled joints in the file; those of one body have their names in one label."""
        labels, owners = list(self.model.joint_label), _flat(self.solver.mjc_jnt_to_newton_jnt).tolist()
        found = {}
        for joint, owner in enumerate(owners):
            own = [one for one, other in enumerate(owners) if other == owner]
            label = labels[owner].rpartition("/")[2]
            words = self.freedoms.get(label, [])
            found[joint] = (words if len(words) == len(own) else _split(label, len(own)))[own.index(joint)]
        return found

    def trial(self) -> Trial:
        """Return the trial of the compiled model."""
        mj = self.solver.mj_model
        mj.opt.timestep = TIMESTEP_S
        mj.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_ACTUATION)
        mj.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
        trial = Trial(mj, mujoco.MjData(mj), self.outcome, rest=self.rest, names=self.names)
        trial.reset()
        trial.start = np.array(trial.data.qpos)
        return trial

    def stand(self, start: Trial) -> None:
        """Hold every hinge and slide at rest by springs in Newton's own solver, without gravity, and measure."""
        model, mj, count = self.model, self.solver.mj_model, self.model.joint_dof_count
        dofs = _flat(self.solver.mjc_dof_to_newton_dof)
        held = [int(mj.jnt_dofadr[joint]) for joint in start._single_joints()]
        whole = np.zeros((mj.nv, mj.nv))
        mujoco.mj_fullM(mj, start.data, whole)
        inertia = np.diag(whole)[held]
        places = model.joint_q_start.numpy(), model.joint_qd_start.numpy()
        q = model.joint_q.numpy().astype(float)
        for dof in held:
            owner = int(np.searchsorted(places[1], dofs[dof], side="right")) - 1
            q[places[0][owner] + dofs[dof] - places[1][owner]] = start.start[mj.jnt_qposadr[mj.dof_jntid[dof]]]
        gains = np.zeros((2, count))
        gains[:, dofs[held]] = inertia * STIFFNESS**2, 2 * inertia * STIFFNESS
        model.joint_target_ke.assign(gains[0].astype(np.float32))
        model.joint_target_kd.assign(gains[1].astype(np.float32))
        model.joint_target_mode.assign(np.full(count, int(self.newton.JointTargetMode.POSITION), dtype=np.int32))
        model.joint_effort_limit.assign(np.full(count, 1e6, dtype=np.float32))
        model.set_gravity((0.0, 0.0, 0.0))
        self.solver = type(self.solver)(model, use_mujoco_cpu=True)
        self._anchor_loops()
        now, after, control = model.state(), model.state(), model.control()
        now.joint_q.assign(q.astype(np.float32))
        now.joint_qd.zero_()
        target = np.array(control.joint_target_q.numpy(), dtype=float)
        for dof in held:
            owner = int(np.searchsorted(places[1], dofs[dof], side="right")) - 1
            at = int(places[0][owner] + dofs[dof] - places[1][owner])
            target[at if len(target) == len(q) else dofs[dof]] = q[at]
        control.joint_target_q.assign(target.astype(np.float32))
        for _ in range(round(STAND_S / TIMESTEP_S)):
            now.clear_forces()
            self.solver.step(now, after, control, None, TIMESTEP_S)
            now, after = after, now
        speeds = np.abs(now.joint_qd.numpy()[dofs[held]])
        self.outcome.speed_at_rest = float(speeds.max(initial=0.0))
        self.outcome.top_speed, self.outcome.exploded = self.outcome.speed_at_rest, not np.isfinite(speeds).all()

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


def _flat(array: Any) -> NDArray[Any]:
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
    told = Path(path), options.get("rest", {}), options.get("freedoms", {})
    try:
        model = Standing(*told)
        model.stand(model.trial())
        calm, message = model.outcome.speed_at_rest, model.outcome.message
        if model.outcome.exploded:
            return model.outcome
        outcome = Standing(*told).trial().run(None if drivers is None else tuple(drivers), frozenset(options.get("opened", ())))
    except Exception as error:  # noqa: BLE001 - whatever Newton raises about a file is its answer
        return EngineOutcome("newton", loads=False, message=f"{type(error).__name__}: {error}"[:300])
    outcome.speed_at_rest, outcome.message = max(outcome.speed_at_rest, calm), message
    return outcome


def main() -> int:
    """Try the models that lines of the input name, `[path, options]`, and print what was measured, a line for each."""
    for line in sys.stdin:
        signal.setitimer(signal.ITIMER_PROF, PROCESSOR_SECONDS)  # its signal ends the process; other processes' load does not count
        path, options = json.loads(line)
        row = {key: value for key, value in asdict(tried(path, options)).items() if key != "frames"}
        print("\n" + json.dumps(row), flush=True)  # noqa: T201 - this is the answer
    return 0


if __name__ == "__main__":
    sys.exit(main())
