"""A model in MuJoCo: held at rest, driven joint by joint over its ranges, then released.

Joints are held and driven by computed torque: `τ = M (ω² e - 2 ω v) + bias`, with e limited so that an obstacle is pushed but not
penetrated. Where other joints follow by loops and couplings with the Jacobian J, the inertia that the driven joints S feel replaces M:
`(S P Sᵀ)⁻¹` with `P = M⁻¹ - M⁻¹ Jᵀ (J M⁻¹ Jᵀ)⁺ J M⁻¹` (Gauss's principle: the accelerations that the constraints permit). Where it
is less than at rest, it is computed anew as the pose changes: a crank feels nothing of a heavy rocker at the ends of its swing. At a dead point of
the driver itself it has no bound; that at rest is used there. A model's own actuators are switched off.

Free bodies may rest on what joints hold, or joints may hold up a body that floats, as legs do. Then the held joints get rotors that match its mass, and
the torque that its weight causes is added to theirs. It is measured while the joints are locked and the free bodies settle, less what the same
contacts still press without gravity: an overlap pushes as before.

Everything runs in a process of its own (`articad.simulation.trial`), because files are untrusted.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from articad.arrays import FloatArray
from articad.simulation.strokes import FREE_SLIDE_M, MOST_JOINTS, MOST_SPEED, PACE_FOLLOWER, PACE_M_S, PACE_RAD_S, STROKE_S, led, strokes
from articad.simulation.verdict import EngineOutcome, FilmFrame, JointReach, Role, covered

STIFFNESS = 20.0  # ω of the controller [1/s]: a tenth of a second to arrive
MOST_ERROR = 0.2  # rad or m: largest error on which the controller acts
HOLD_S = 1.0
SETTLE_S = 2.0  # for free bodies to come to rest on locked joints
WEIGHTLESS_S = 0.5  # for weights to leave their supports
LEAST_SETTLE_S = 0.1
STILL = 1e-3  # rad/s or m/s of everything: settled
LEAST_ARM_M = 0.05  # 2 g/ω²: a hinge with a rotor of this arm holds a mass up that stands on it at any height
LOCKING = 1e6  # kg or kg·m², added to a joint's own inertia
MOST_STEPS = 20_000  # of a stroke: 40 s at MuJoCo's default time step
FREE_S = 1.0
IMPACT_S = 0.3  # until an impact in loops and couplings has decayed
LOCKED = 1e-6  # share of its mobility that loops leave to a joint that cannot move
TURNED = 0.02  # rad or m: a change of pose after which the inertia that driven joints feel is computed anew
PUSH = 0.2  # rad/s or m/s with which a model is released


class Stroke(NamedTuple):
    """Smallest and largest `qpos` while a joint was driven, and the bodies that blocked it."""

    low: FloatArray
    high: FloatArray
    blocker: str


@dataclass
class Trial:
    """One model under test.

    Attributes:
        model: As MuJoCo compiled it.
        data: Its state.
        outcome: The measurements.
    """

    model: Any
    data: Any
    outcome: EngineOutcome
    start: FloatArray = field(default_factory=lambda: np.zeros(0))
    rest: Mapping[str, float] = field(default_factory=dict)
    mimics: Mapping[str, tuple[str, float, float]] = field(default_factory=dict)
    felt: FloatArray | None = None
    load: FloatArray | None = None
    borne: list[int] = field(default_factory=list)  # free bodies that rest on joints, at once or on each other
    geared: Any = None  # the model with rotors that match the mass of free bodies that rest on joints
    longest: dict[int, float] = field(default_factory=dict)  # range of a hinge that one stroke covers [rad], by joint

    @classmethod
    def of(cls, path: Path, rest: Mapping[str, float] | None = None, mimics: Mapping[str, tuple[str, float, float]] | None = None) -> Trial:
        """Load a model.

        Args:
            path: A URDF or MJCF file.
            rest: Initial values of hinges and slides by name [rad or m], for a file without a key `home`.
            mimics: Leader, multiplier and offset of joints that follow others by <mimic>. They have no drive of their own, whether this
                version of MuJoCo couples them or not.

        Raises:
            ValueError: If MuJoCo refuses it.
        """
        model = mujoco.MjModel.from_xml_path(str(path))
        model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_ACTUATION)
        model.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE  # which `_inertia` reads
        trial = cls(model, mujoco.MjData(model), EngineOutcome("mujoco", str(mujoco.__version__)), rest=rest or {}, mimics=mimics or {})
        trial.reset()
        trial.start = np.array(trial.data.qpos)
        return trial

    def run(self, drivers: tuple[str, ...] | None = None, opened: frozenset[str] = frozenset()) -> EngineOutcome:
        """Hold, drive and release; return the measurements.

        Args:
            drivers: Joints that drive closed loops; None if they are unknown, so that each joint is driven.
            opened: Joints that are not driven, because the loop that would lead their bodies is open in the file.
        """
        self._hold()
        if not self.outcome.exploded:
            own, self.model = self.model, self.geared
            self._drive(drivers, opened)
            self.model = own
            self._let_go()
        return self.outcome

    def reset(self) -> None:
        """Return to the key `home`, or to the model's own pose."""
        home = mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_KEY, "home")
        if home >= 0:
            mujoco.mj_resetDataKeyframe(self.model, self.data, home)
        else:
            mujoco.mj_resetData(self.model, self.data)
            for joint in self._single_joints():
                at = self.model.jnt_qposadr[joint]
                self.data.qpos[at] = self.rest.get(self._name(joint), self.data.qpos[at])
            for joint, (leader, ratio, offset) in self._mimicked.items():
                self.data.qpos[self.model.jnt_qposadr[joint]] = ratio * self.data.qpos[self.model.jnt_qposadr[leader]] + offset
        self.data.qvel[:] = 0.0
        mujoco.mj_forward(self.model, self.data)

    # ------------------------------------------------------------------ phases

    def _hold(self) -> None:
        """Hold every joint at rest against gravity and contact, and what rests on it."""
        held, own = self._hinged_dofs(), self.model
        self.model = self.geared = self._carry(held)
        self._stand(held)
        self.model, self.load = own, None

    def _stand(self, held: NDArray[np.int_]) -> None:
        """Hold these degrees of freedom, and measure."""
        steps, calm = self._steps(HOLD_S), 0.0
        for step in range(steps):
            if not self._step(self.start, held):
                return
            if step >= 0.9 * steps and len(held):
                calm = max(calm, float(np.abs(self.data.qvel[held]).max()))
        self.outcome.speed_at_rest = calm
        moved = self._error(self.start)[held]
        self.outcome.moved_at_rest = float(np.abs(moved).max(initial=0.0))
        rows = self._equalities()
        self.outcome.residual = float(np.abs(self.data.efc_pos[: self.data.nefc][rows]).max(initial=0.0)) if self.model.neq else 0.0

    def _carry(self, held: NDArray[np.int_]) -> Any:
        """Let free bodies settle on locked joints; set the load that the joints feel, and return the model with joints heavy enough for it."""
        model, data = self.model, self.data
        if len(held) in {0, model.nv}:
            return model
        self.model, settled = _heavier(model, held, LOCKING), mujoco.MjData(model)
        resting = self._settled(held, SETTLE_S)
        mujoco.mj_copyData(settled, model, data)
        self.model.opt.gravity[:] = 0.0
        pressing = self._settled(held, WEIGHTLESS_S)
        self.model = model
        mujoco.mj_copyData(data, model, settled)
        mujoco.mj_forward(model, data)
        rotors = self._matching(held)
        if self.outcome.exploded or not rotors.any():
            self.reset()
            return model
        self.load, self.borne = resting - pressing, self._resting()
        return _heavier(model, held, rotors)

    def _matching(self, held: NDArray[np.int_]) -> FloatArray:
        """Return the inertia, per held degree of freedom, of all that floats if its mass moved with the bodies that bear it [kg or kg·m²]."""
        floating = [body for body in range(self.model.nbody) if self._floats(body)]
        bearing = {int(body) for index in self._supporting() for body in self.model.geom_bodyid[self.data.contact[index].geom]}
        squares, jacobian = np.zeros(len(held)), np.zeros((3, self.model.nv))
        for body in bearing:
            for other in floating:
                mujoco.mj_jac(self.model, self.data, jacobian, None, self.data.subtree_com[other], body)
                squares = np.maximum(squares, (jacobian[:, held] ** 2).sum(axis=0))
        mass = float(self.model.body_subtreemass[floating].sum())
        return np.where(squares > 0, mass * (squares + LEAST_ARM_M**2), 0.0)

    def _settled(self, held: NDArray[np.int_], seconds: float) -> FloatArray:
        """Step with held joints until nothing moves; return the torque that holds what rests on them, per degree of freedom."""
        for step in range(self._steps(seconds)):
            if not self._step(self.start, held) or (step >= self._steps(LEAST_SETTLE_S) and np.abs(self.data.qvel).max() < STILL):
                break
        rows = self._supports()
        return np.asarray(-self._jacobian(rows).T @ self.data.efc_force[: self.data.nefc][rows])

    def _supporting(self) -> list[int]:
        """Return the contacts that bear a body that floats, or what it carries."""
        roots = self.model.body_rootid[self.model.geom_bodyid[self.data.contact.geom]]
        return [index for index, pair in enumerate(roots.reshape(-1, 2)) if any(self._floats(int(root)) for root in pair)]

    def _supports(self) -> NDArray[np.bool_]:
        """Return which constraints are those contacts."""
        found = np.zeros(self.data.nefc, dtype=bool)
        starts = sorted(int(contact.efc_address) for contact in self.data.contact)
        for index in self._supporting():
            first = int(self.data.contact[index].efc_address)
            if first >= 0:
                found[first : next((start for start in starts if start > first), self.data.nefc)] = True
        return found

    def _floats(self, body: int) -> bool:
        """True for a body with a free joint."""
        joint = int(self.model.body_jntadr[body])
        return joint >= 0 and self.model.jnt_type[joint] == int(mujoco.mjtJoint.mjJNT_FREE)

    def _resting(self) -> list[int]:
        """Return the free bodies of one part that rest on what joints move, at once or on each other."""
        pairs = [self.model.geom_bodyid[self.data.contact[index].geom].tolist() for index in self._supporting()]
        alone = {body for body in range(self.model.nbody) if self._floats(body)} - set(self.model.body_parentid.tolist())
        found: set[int] = set()
        for _ in alone:
            for pair in pairs:
                for one, other in (pair, pair[::-1]):
                    if one in alone and (other in found or (other not in alone and self._joints_above(other))):
                        found.add(one)
        return sorted(found)

    def _equalities(self) -> NDArray[np.bool_]:
        """Return which constraints are equalities."""
        return np.asarray(self.data.efc_type[: self.data.nefc] == int(mujoco.mjtConstraint.mjCNSTR_EQUALITY))

    def _jacobian(self, rows: NDArray[np.bool_]) -> FloatArray:
        """Return the Jacobian of some of the constraints, `(rows, nv)`."""
        return np.asarray(self.data.efc_J).reshape(-1, self.model.nv)[: self.data.nefc][rows]

    def _drive(self, drivers: tuple[str, ...] | None, opened: frozenset[str]) -> None:
        """Drive each hinge and slide over its range; in a loop only its drivers, with the rest of the loop free to follow.

        If the drivers are unknown, a joint that an equality makes a function of another joint is not driven: through a screw, it would
        turn the other one a thousand times as fast.
        """
        single, count = list(self._single_joints()), 0
        self.outcome.passed_over = tuple(self._name(joint) for joint in single if self._name(joint) in opened)
        single = [joint for joint in single if self._name(joint) not in opened and joint not in self._mimicked]
        for number, loop in enumerate(self._loops(single)):
            inside = [joint for joint in single if joint in loop]
            leading = [joint for joint in inside if drivers is not None and self._name(joint) in drivers]
            driven = leading or [joint for joint in inside if joint not in self._coupled] or inside
            taken = driven[: max(0, MOST_JOINTS - count)]
            count += len(taken)
            self.outcome.untried += len(driven) - len(taken)
            strokes_made: dict[int, Stroke] = {}
            for joint in taken:
                strokes_made[joint] = self._stroke(joint, loop - {joint} - set(leading))  # the other drivers are held
                if self.outcome.exploded:
                    return
            for joint in inside if len(taken) == len(driven) else taken:
                role: Role = "free" if len(loop) == 1 else "tied" if not leading else "driver" if joint in taken else "follower"
                self.outcome.reaches.append(self._reach(joint, number, role, strokes_made))
                self.outcome.reaches += self._followed(joint, number, strokes_made)

    def _reach(self, joint: int, number: int, role: Role, made: dict[int, Stroke]) -> JointReach:
        """Return how far a joint moved in any stroke of its loop."""
        lower, upper, unit = self._range(joint)
        at = self.model.jnt_qposadr[joint]
        low, high = min(float(stroke.low[at]) for stroke in made.values()), max(float(stroke.high[at]) for stroke in made.values())
        share = covered(low, high, lower, upper)
        blocker = made[joint].blocker if joint in made and share < 1 else ""
        return JointReach(self._name(joint), lower, upper, low, high, share, unit, blocker, role, None if role == "free" else number)

    @cached_property
    def _mimicked(self) -> dict[int, tuple[int, float, float]]:
        """Joints that follow others by <mimic>: the leader that follows none, and value = ratio · leader + offset."""
        by_name = {self._name(joint): joint for joint in self._single_joints()}
        return {by_name[name]: (by_name[leader], ratio, offset) for name, (leader, ratio, offset) in led(self.mimics, by_name).items()}

    @cached_property
    def _coupled(self) -> set[int]:
        """Joints that equalities make functions of other joints."""
        rows = np.flatnonzero(
            (self.model.eq_type == int(mujoco.mjtEq.mjEQ_JOINT)) & (self.model.eq_obj2id >= 0) & (self.model.eq_active0 > 0)
        )
        return {int(self.model.eq_obj1id[row]) for row in rows}

    def _followers(self, joint: int) -> list[tuple[int, float, float]]:
        """Return the joints that follow one, each with its multiplier and offset."""
        return [(one, ratio, offset) for one, (leader, ratio, offset) in self._mimicked.items() if leader == joint]

    def _followed(self, leader: int, number: int, made: dict[int, Stroke]) -> list[JointReach]:
        """Return how far the followers of a leader moved, relative to their expected ranges."""
        lower, upper, _ = self._range(leader)
        found = []
        for joint, ratio, offset in self._followers(leader):
            low, high = sorted((ratio * lower + offset, ratio * upper + offset))
            reach = self._reach(joint, number, "follower", made)
            found.append(replace(reach, lower=low, upper=high, share=covered(reach.low, reach.high, low, high), loop=None))
        return found

    def _stroke(self, joint: int, following: frozenset[int]) -> Stroke:
        """Drive one joint over its range with its followers, all others held.

        Free bodies of one part that rest on what joints move may fall off it, so they have no weight here. What lies in the way keeps its own.
        """
        self.reset()
        self.data.xfrc_applied[self.borne, :3] = -self.model.body_mass[self.borne, None] * self.model.opt.gravity
        turns = self.model.jnt_type[joint] == int(mujoco.mjtJoint.mjJNT_HINGE)
        mean_pace = PACE_RAD_S if turns else PACE_M_S
        if following:
            mean_pace = min(mean_pace, PACE_FOLLOWER / self._gearing(joint))
        if turns:
            self.longest[joint] = max(2 * math.tau, mean_pace * MOST_STEPS * float(self.model.opt.timestep))
        lower, upper, _ = self._range(joint)
        at, target = self.model.jnt_qposadr[joint], np.array(self.start)
        free = set(np.flatnonzero(np.isin(self.model.dof_jntid, list(following))).tolist())
        held = np.array([dof for dof in self._hinged_dofs() if dof not in free], dtype=int)
        self.felt = at_rest = self._inertia(held) if free else None
        felt_at, own = np.array(self.data.qpos), int(np.searchsorted(held, self.model.jnt_dofadr[joint]))
        rest = float(self.start[at])
        low, high, blocker, lag = np.array(self.start), np.array(self.start), "", 0.0
        steps = self._steps(max(STROKE_S, (upper - lower) / mean_pace))
        shown = {steps, 2 * steps, 3 * steps - 1}
        before, followers = rest, self._followers(joint)
        for step, value in enumerate(strokes(rest, lower, upper, steps)):
            target[at] = value
            pace = np.zeros(self.model.nv)
            speed = (value - before) / self.model.opt.timestep
            pace[self.model.jnt_dofadr[joint]] = speed
            for follower, ratio, offset in followers:
                target[self.model.jnt_qposadr[follower]] = ratio * value + offset
                pace[self.model.jnt_dofadr[follower]] = ratio * speed
            before = value
            if at_rest is not None and np.abs(self.data.qpos - felt_at).max() > TURNED:
                now, felt_at = self._inertia(held), np.array(self.data.qpos)
                self.felt = now if now[own, own] < at_rest[own, own] else at_rest
            if not self._step(target, held, free, pace):
                break
            np.minimum(low, self.data.qpos, out=low)
            np.maximum(high, self.data.qpos, out=high)
            here = float(self.data.qpos[at])
            if abs(value - here) > lag:
                lag, blocker = abs(value - here), self._contact(joint)
            if step in shown:
                self.outcome.frames.append(FilmFrame(self._name(joint), self._values()))
        self.felt = None
        return Stroke(low, high, blocker)

    def _let_go(self) -> None:
        """Release the model with a push, without contact or limits; its energy may only decrease.

        A push that a loop cannot follow is an impact, and what it stores in the constraints, which are springs, is not in MuJoCo's sum of
        energies. So the sum is compared after that has decayed, and with the kinetic energy of the push.
        """
        model = self.model
        model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONTACT) | int(mujoco.mjtDisableBit.mjDSBL_LIMIT)
        model.opt.enableflags |= int(mujoco.mjtEnableBit.mjENBL_ENERGY)
        self.reset()
        if not model.nv:
            return
        rng = np.random.default_rng(0)
        self.data.qvel[:] = PUSH * rng.uniform(-1, 1, model.nv)
        mujoco.mj_forward(model, self.data)
        kinetic = abs(float(self.data.energy[1]))
        if model.neq:
            for _ in range(self._steps(IMPACT_S)):
                if not self._step(None, np.zeros(0, dtype=int)):
                    return
            mujoco.mj_forward(model, self.data)
        first, most = float(self.data.energy.sum()), -math.inf
        for _ in range(self._steps(FREE_S)):
            if not self._step(None, np.zeros(0, dtype=int)):
                return
            most, kinetic = max(most, float(self.data.energy.sum())), max(kinetic, float(self.data.energy[1]))
        self.outcome.energy_growth = (most - first) / kinetic if kinetic > 1e-12 else 0.0

    # ------------------------------------------------------------------ one step

    def _step(
        self, target: FloatArray | None, held: NDArray[np.int_], free: set[int] | None = None, pace: FloatArray | None = None
    ) -> bool:
        """Step once with the controller at `target`, moving at `pace`; return False if the numbers diverge."""
        model, data = self.model, self.data
        mujoco.mj_step1(model, data)
        data.qfrc_applied[:] = 0.0
        if target is not None:
            wanted = np.zeros(model.nv)
            error = np.clip(self._error(target), -MOST_ERROR, MOST_ERROR)
            late = (0.0 if pace is None else pace) - data.qvel
            wanted[held] = STIFFNESS**2 * error[held] + 2 * STIFFNESS * late[held]
            torque = np.zeros(model.nv)
            if self.felt is not None:
                torque[held] = self.felt @ wanted[held]
            else:
                mujoco.mj_mulM(model, data, torque, wanted)
            weight = data.qfrc_bias - data.qfrc_passive
            data.qfrc_applied[held] = torque[held] + weight[held]
            if self.load is not None:
                data.qfrc_applied[held] += self.load[held]
            following = sorted(free or ())  # joints of the same loop follow, they are not controlled
            data.qfrc_applied[following] = weight[following]
        mujoco.mj_step2(model, data)
        bad = data.warning[int(mujoco.mjtWarning.mjWARN_BADQACC)].number or data.warning[int(mujoco.mjtWarning.mjWARN_BADQPOS)].number
        hinged = self._hinged_dofs() if target is not None else np.zeros(0, dtype=int)
        speed = float(np.abs(data.qvel[hinged]).max(initial=0.0)) if len(hinged) else 0.0
        self.outcome.top_speed = max(self.outcome.top_speed, speed)
        if bad or not np.isfinite(data.qpos).all() or speed > MOST_SPEED:
            self.outcome.exploded = True
            return False
        return True

    def _inertia(self, held: NDArray[np.int_]) -> FloatArray:
        """Return the inertia that controlled joints feel through loops and couplings, `(H, H)`.

        In coordinates in which M⁻¹ of these joints is 1, the eigenvalues of P are the shares of mobility that loops leave, from 0 to 1.
        Directions that are locked have their own inertia.
        """
        permitted, free = self._permitted()
        root = np.linalg.cholesky(free[np.ix_(held, held)])
        shares, ways = np.linalg.eigh(np.linalg.solve(root, np.linalg.solve(root, permitted[np.ix_(held, held)]).T))
        ways = np.linalg.solve(root.T, ways)
        return np.asarray(ways @ np.diag(1 / np.where(shares > LOCKED, shares, 1.0)) @ ways.T)

    def _permitted(self) -> tuple[FloatArray, FloatArray]:
        """Return P, which maps generalised forces to the accelerations that loops and couplings permit, and M⁻¹, both `(nv, nv)`."""
        model, data = self.model, self.data
        mass = np.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, data, mass)
        inverse = np.linalg.inv(mass)
        J = self._jacobian(self._equalities())
        return inverse - inverse @ J.T @ np.linalg.pinv(J @ inverse @ J.T, rcond=1e-9, hermitian=True) @ J @ inverse, inverse

    def _gearing(self, joint: int) -> float:
        """Return how many times as fast as a driven joint the fastest of its followers moves from rest."""
        dof, hinged = int(self.model.jnt_dofadr[joint]), self._hinged_dofs()
        permitted, free = self._permitted()
        speeds = np.abs(permitted[:, dof])
        return float(speeds[hinged].max() / speeds[dof]) if speeds[dof] > LOCKED * free[dof, dof] else 1.0

    def _error(self, target: FloatArray) -> FloatArray:
        """Return the difference to a pose, per degree of freedom."""
        error = np.zeros(self.model.nv)
        mujoco.mj_differentiatePos(self.model, error, 1.0, self.data.qpos, target)
        return error

    # ------------------------------------------------------------------ the model

    def _steps(self, seconds: float) -> int:
        return max(1, min(round(seconds / float(self.model.opt.timestep)), MOST_STEPS))

    def _hinged_dofs(self) -> NDArray[np.int_]:
        """Return the degrees of freedom that do not belong to free bodies."""
        kinds = self.model.jnt_type[self.model.dof_jntid] if self.model.nv else np.zeros(0, dtype=int)
        return np.flatnonzero(kinds != int(mujoco.mjtJoint.mjJNT_FREE))

    def _single_joints(self) -> Iterator[int]:
        for joint in range(self.model.njnt):
            if self.model.jnt_type[joint] in {int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE)}:
                yield joint

    def _range(self, joint: int) -> tuple[float, float, str]:
        """Return the range over which a joint is driven: its limits as far as a stroke can last, else one turn or a short travel."""
        turns = self.model.jnt_type[joint] == int(mujoco.mjtJoint.mjJNT_HINGE)
        unit, rest = "rad" if turns else "m", float(self.start[self.model.jnt_qposadr[joint]])
        lower, upper = (float(bound) for bound in self.model.jnt_range[joint])
        if not self.model.jnt_limited[joint]:
            lower, upper = (rest, rest + math.tau) if turns else (rest - FREE_SLIDE_M, rest + FREE_SLIDE_M)
        elif turns and upper - lower > (longest := self.longest.get(joint, 2 * math.tau)):
            lower, upper = max(lower, rest - longest / 2), min(upper, rest + longest / 2)
        for follower, ratio, offset in self._followers(joint):
            if self.model.jnt_limited[follower] and ratio:
                ends = sorted((float(bound) - offset) / ratio for bound in self.model.jnt_range[follower])
                lower, upper = max(lower, ends[0]), min(upper, ends[1])
        return lower, upper, unit

    def _loops(self, single: list[int]) -> list[frozenset[int]]:
        """Return the sets of joints that move together, in the order of their first; a joint outside of loops forms a set of its own."""
        tied = self._tied()
        return list(dict.fromkeys(next((group for group in tied if joint in group), frozenset({joint})) for joint in single))

    def _tied(self) -> list[frozenset[int]]:
        """Return the sets of joints that equality constraints couple."""
        sets: list[set[int]] = []
        for row in range(self.model.neq):
            kind, first, second = self.model.eq_type[row], int(self.model.eq_obj1id[row]), int(self.model.eq_obj2id[row])
            if not self.model.eq_active0[row]:
                continue
            if kind == int(mujoco.mjtEq.mjEQ_JOINT):
                sets.append({first, *([second] if second >= 0 else [])})
            elif kind in {int(mujoco.mjtEq.mjEQ_CONNECT), int(mujoco.mjtEq.mjEQ_WELD)}:
                if self.model.eq_objtype[row] == int(mujoco.mjtObj.mjOBJ_SITE):
                    first, second = int(self.model.site_bodyid[first]), int(self.model.site_bodyid[second])
                sets.append(self._joints_above(first) ^ self._joints_above(second))
        merged: list[set[int]] = []
        for one in sets:
            touching = [other for other in merged if other & one]
            merged = [other for other in merged if not other & one]
            merged.append(one.union(*touching))
        return [frozenset(one) for one in merged]

    def _joints_above(self, body: int) -> set[int]:
        found: set[int] = set()
        while body > 0:
            first, count = int(self.model.body_jntadr[body]), int(self.model.body_jntnum[body])
            found |= set(range(first, first + count)) if count else set()
            body = int(self.model.body_parentid[body])
        return found

    def _contact(self, joint: int) -> str:
        """Return the two bodies with the largest contact force, one of them moved by the joint; "" if nothing touches."""
        best, pair = 0.0, None
        force = np.zeros(6)
        bodies = self.model.geom_bodyid[self.data.contact.geom]
        for index in np.flatnonzero(self._moves[joint][bodies].any(axis=1)):
            mujoco.mj_contactForce(self.model, self.data, int(index), force)
            if abs(force[0]) > best:
                best, pair = abs(float(force[0])), bodies[index]
        return "" if pair is None else " and ".join(self.model.body(int(body)).name or f"body_{body}" for body in pair)

    @cached_property
    def _moves(self) -> NDArray[np.bool_]:
        """Whether a joint moves a body, `(joints, bodies)`."""
        moves = np.zeros((self.model.njnt, self.model.nbody), dtype=bool)
        for body in range(self.model.nbody):
            moves[list(self._joints_above(body)), body] = True
        return moves

    def _values(self) -> dict[str, float]:
        """Return the values of hinges and slides by name [rad, m]."""
        return {self._name(joint): float(self.data.qpos[self.model.jnt_qposadr[joint]]) for joint in self._single_joints()}

    def _name(self, joint: int) -> str:
        return self.model.joint(joint).name or f"joint_{joint}"


def _heavier(model: Any, held: NDArray[np.int_], inertia: FloatArray | float) -> Any:
    """Return a copy of a model with more inertia at the held joints, as of rotors [kg or kg·m²]."""
    heavier = copy.copy(model)
    heavier.dof_armature[held] += inertia
    mujoco.mj_setConst(heavier, mujoco.MjData(heavier))
    heavier.eq_data[:] = model.eq_data  # which it computes from the pose at zero
    return heavier
