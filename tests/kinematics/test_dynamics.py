"""Dynamics against closed formulas, Lagrange's equation on poses alone, and MuJoCo with its own constraints."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import articad as ac
from articad import examples
from articad.connectors import SE3
from articad.errors import KinematicsError
from articad.geometry.shapes import box
from tests.assemblies import all_joint_kinds, frame, random_tree

Array = NDArray[np.float64]
G = 9.81
LOOPS = ["four_bar", "slider_crank", "jansen_leg", "scissor_lift", "geared_four_bar"]


def pendulum() -> ac.Assembly:
    """A rod of 400 mm that hangs from its end and swings about y."""
    axis = ac.SE3.from_axes((0, 0, 0), (0, 1, 0), (1, 0, 0))
    base = ac.Part.from_mesh("base", box(10, 10, 10), density=1000, connectors={"pin": ac.Connector("pin", axis)})
    top = ac.SE3.from_axes((0, 0, 200), (0, 1, 0), (1, 0, 0))
    rod = ac.Part.from_mesh("rod", box(20, 10, 400), density=2700, connectors={"eye": ac.Connector("eye", top)})
    joint = ac.revolute("swing", base["pin"], rod["eye"], limits="endless")
    return ac.Assembly.from_parts("pendulum", parts=[base, rod], joints=[joint], ground="base")


def made(name: str) -> ac.Assembly:
    return ac.read(examples.folder(name))


def closed_states(assembly: ac.Assembly, count: int = 3) -> list[Array]:
    """Configurations well inside the ranges of the drivers."""
    rng, drivers = np.random.default_rng(5), assembly.drivers
    rest = assembly.mechanism.rest
    room = np.array([min(0.3 if d.unit == "rad" else 5.0, 0.2 * (d.upper - d.lower)) for d in drivers])
    middle = np.array([np.clip(r, d.lower + w, d.upper - w) for r, d, w in zip(rest, drivers, room, strict=True)])
    return [middle + room * rng.uniform(-1, 1, len(drivers)) for _ in range(count)]


def test_a_pendulum_obeys_its_formula() -> None:
    assembly = pendulum()
    dynamics = assembly.dynamics()
    mass, length = 0.02 * 0.01 * 0.4 * 2700, 0.4
    inertia = mass * (length**2 + 0.02**2) / 12 + mass * (length / 2) ** 2
    for angle in (-2.0, 0.1, 1.3):
        assert dynamics.mass_matrix([angle]) == pytest.approx(np.array([[inertia]]), rel=1e-12)
        # about +y a positive angle swings the rod towards −x
        assert dynamics.gravity_efforts([angle]) == pytest.approx([mass * G * length / 2 * math.sin(angle)], rel=1e-12)
        assert dynamics.forward([angle], [3.0], [0.5]).drivers == pytest.approx(
            [(0.5 - mass * G * length / 2 * math.sin(angle)) / inertia], rel=1e-10
        )
    kinetic, potential = dynamics.energy([math.pi], [2.0])
    base_mass = 0.01**3 * 1000
    assert (kinetic, potential) == pytest.approx((inertia * 2, mass * G * length / 2 + base_mass * 0), rel=1e-12)


def kinetic_from_poses(assembly: ac.Assembly, q: Array, v: Array) -> float:
    """Kinetic energy [J] from differences of poses alone; q in mm, v in SI."""
    si = np.array([1e3 if d.unit == "mm" else 1.0 for d in assembly.drivers])

    def poses(t: float) -> SE3:
        return assembly.poses(q + t * v * si)

    total: float = 0.0
    h = 1e-3
    around = {t: poses(t) for t in (-2 * h, -h, h, 2 * h)}
    here = poses(0.0)
    for index, part in enumerate(assembly.parts.values()):
        if part.mass is None:
            continue

        def rate(values: dict[float, Array]) -> Array:
            one, two = (values[h] - values[-h]) / (2 * h), (values[2 * h] - values[-2 * h]) / (4 * h)
            out: Array = (4 * one - two) / 3
            return out

        centre = rate({t: T[index].apply(part.mass.com) for t, T in around.items()}) * 1e-3
        R = here[index].rotation
        spin = R.T @ rate({t: T[index].rotation for t, T in around.items()})
        omega = np.array([spin[2, 1] - spin[1, 2], spin[0, 2] - spin[2, 0], spin[1, 0] - spin[0, 1]]) / 2
        total += float(part.mass.mass * centre @ centre / 2 + omega @ part.mass.inertia @ omega / 2 * 1e-6)
    return total


@pytest.mark.parametrize("name", LOOPS)
def test_one_driver_obeys_lagrange_on_poses_alone(name: str) -> None:
    assembly = made(name)
    dynamics = assembly.dynamics()
    assert dynamics.nv == 1
    si = 1e3 if assembly.drivers[0].unit == "mm" else 1.0

    def inertia(q: float) -> float:
        return 2 * kinetic_from_poses(assembly, np.array([q]), np.array([0.1])) / 0.01

    def potential(q: float) -> float:
        mass = assembly.mass([q])
        return mass.mass * G * float(mass.com[2]) * 1e-3

    for q in closed_states(assembly, 2):
        at, v, effort, h = float(q[0]), 0.4, 0.3, 3e-4
        M = inertia(at)
        assert dynamics.mass_matrix(q)[0, 0] == pytest.approx(M, rel=1e-8)

        def slope(of: Any, at: float = at, h: float = h) -> float:
            one, two = (of(at + h * si) - of(at - h * si)) / (2 * h), (of(at + 2 * h * si) - of(at - 2 * h * si)) / (4 * h)
            return float(4 * one - two) / 3

        # M a + ½ M′ v² + V′ = τ
        expected = (effort - slope(inertia) * v * v / 2 - slope(potential)) / M
        found = dynamics.forward(q, [v], [effort])
        assert found.drivers[0] == pytest.approx(expected, rel=1e-6, abs=1e-6)
        assert dynamics.inverse(q, [v], found.drivers).efforts == pytest.approx([effort], rel=1e-9, abs=1e-12)
        assert dynamics.bias(q, [v]) == pytest.approx([slope(inertia) * v * v / 2 + slope(potential)], rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("name", [*LOOPS, "toggle_clamp", "stewart_platform"])
def test_energy_stays_where_nothing_drives(name: str) -> None:
    assembly = made(name)
    dynamics, rng = assembly.dynamics(), np.random.default_rng(1)
    si = np.array([1e3 if driver.unit == "mm" else 1.0 for driver in assembly.drivers])
    for q in closed_states(assembly, 2):
        v, h = 0.2 * rng.normal(size=dynamics.nv), 1e-4
        a = dynamics.forward(q, v, np.zeros(dynamics.nv)).drivers
        ahead, behind = (sum(dynamics.energy(q + (t * v + t * t / 2 * a) * si, v + t * a)) for t in (h, -h))
        kinetic, _ = dynamics.energy(q, v)
        assert (ahead - behind) / (2 * h) == pytest.approx(0.0, abs=1e-4 * max(kinetic, 1e-3))


def in_mujoco(assembly: ac.Assembly, folder: Path, q: Array, v: Array) -> tuple[Any, Any, list[int], Any]:
    """Return MuJoCo's model of the export, its data at the same configuration, and each driver's place."""
    import mujoco

    bundle = ac.write(assembly, folder / "model.xml")
    assert bundle.files
    model = mujoco.MjModel.from_xml_path(str(folder / "model.xml"))
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT | mujoco.mjtDisableBit.mjDSBL_LIMIT
    data = mujoco.MjData(model)
    columns = assembly.mechanism.configuration(q).columns
    names = [mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_JOINT, at) for at in range(model.njnt)]
    for at, name in enumerate(names):
        column = assembly.mechanism.layout.column_of[name]
        unit = assembly.mechanism.coordinates[column].unit
        data.qpos[model.jnt_qposadr[at]] = columns[column] * (1e-3 if unit == "mm" else 1.0)
    mujoco.mj_forward(model, data)
    return mujoco, (model, data), [names.index(driver.name) for driver in assembly.drivers], names


@pytest.mark.parametrize("name", ["four_bar", "jansen_leg", "slider_crank"])
def test_mujoco_with_its_own_exact_constraints_accelerates_as_we_do(name: str, tmp_path: Path) -> None:
    assembly = made(name)
    dynamics = assembly.dynamics()
    for q in closed_states(assembly, 2):
        v = np.array([0.7])
        mujoco, (model, data), driving, _ = in_mujoco(assembly, tmp_path, q, v)

        def constraints(qpos: Array, mujoco: Any = mujoco, model: Any = model) -> Array:
            other = mujoco.MjData(model)
            other.qpos[:] = qpos
            mujoco.mj_forward(model, other)
            rows = np.array(other.efc_type) == mujoco.mjtConstraint.mjCNSTR_EQUALITY
            dense = np.array(other.efc_J).reshape(-1, model.nv) if other.efc_J.size == other.nefc * model.nv else None
            if dense is None:
                dense = np.zeros((other.nefc, model.nv))
                mujoco.mju_sparse2dense(dense, other.efc_J, other.efc_J_rownnz, other.efc_J_rowadr, other.efc_J_colind)
            kept: Array = dense[rows]
            return kept

        J = constraints(np.array(data.qpos))
        _, s, Vt = np.linalg.svd(J)
        rank = int((s > 1e-6 * s[0]).sum())
        Z = Vt[rank:].T
        assert Z.shape[1] == 1
        velocity = Z[:, 0] * (v[0] / Z[driving[0], 0])
        h = 1e-3 / np.abs(velocity).max()

        def slope(step: float, velocity: Array = velocity, data: Any = data) -> Array:
            ahead, behind = (constraints(np.array(data.qpos) + t * velocity) for t in (step, -step))
            out: Array = (ahead - behind) @ velocity / (2 * step)
            return out

        c = -np.linalg.pinv(J, rcond=1e-6) @ ((4 * slope(h / 2) - slope(h)) / 3)
        data.qvel[:] = velocity
        mujoco.mj_forward(model, data)
        M = np.zeros((model.nv, model.nv))
        for column in np.eye(model.nv):
            mujoco.mj_mulM(model, data, M[int(column.argmax())], column)
        M -= np.diag(model.dof_armature)
        tau = np.zeros(model.nv)
        tau[driving[0]] = 0.2
        a = Z @ np.linalg.solve(Z.T @ M @ Z, Z.T @ (tau - data.qfrc_bias - M @ c)) + c
        assert dynamics.forward(q, v, [0.2]).drivers[0] == pytest.approx(a[driving[0]], rel=1e-8)


@pytest.mark.parametrize("seed", range(6))
def test_a_tree_of_any_joints_keeps_its_energy_and_its_mass_matrix_is_that_of_its_poses(seed: int) -> None:
    assembly = random_tree(seed) if seed else all_joint_kinds()
    dynamics = assembly.dynamics()
    q, rng = assembly.mechanism.rest, np.random.default_rng(seed)
    plain = [i for i, c in enumerate(assembly.drivers) if c.unit != "1"]
    layout = assembly.mechanism.layout
    freedoms = [layout.freedom_of(i) for i in plain]
    v = np.zeros(dynamics.nv)
    v[freedoms] = rng.normal(size=len(freedoms))
    along = np.zeros(len(q))
    along[plain] = v[freedoms]
    assert v @ dynamics.mass_matrix(q) @ v / 2 == pytest.approx(kinetic_from_poses(assembly, q, along), rel=1e-7)
    efforts = rng.normal(size=dynamics.nv)
    again = dynamics.inverse(q, v, dynamics.forward(q, v, efforts).drivers).efforts
    assert again == pytest.approx(efforts, rel=1e-8, abs=1e-9)


def test_the_loop_carries_the_weight_that_the_pins_do_not() -> None:
    """A beam hangs from two pins; the one that closes the loop carries half of it (statics)."""
    pins = {"left": frame(at=(-100, 0, 0), z=(0, 1, 0), x=(1, 0, 0)), "right": frame(at=(100, 0, 0), z=(0, 1, 0), x=(1, 0, 0))}
    wall = ac.Part.from_mesh("wall", box(300, 5, 5), density=1000, connectors={n: ac.Connector(n, T) for n, T in pins.items()})
    beam = ac.Part.from_mesh("beam", box(200, 10, 10), density=7850, connectors={n: ac.Connector(n, T) for n, T in pins.items()})
    up = frame(at=(0, 0, 50), z=(0, 1, 0), x=(1, 0, 0))
    down = frame(at=(0, 0, -50), z=(0, 1, 0), x=(1, 0, 0))
    links = [
        ac.Part.from_mesh(n, box(4, 4, 100), density=1e-3, connectors={"up": ac.Connector("up", up), "down": ac.Connector("down", down)})
        for n in ("link_left", "link_right")
    ]
    joints = [
        ac.revolute("a", wall["left"], links[0]["up"], limits=(-1, 1)),
        ac.revolute("b", wall["right"], links[1]["up"], limits=(-1, 1)),
        ac.revolute("c", links[0]["down"], beam["left"], limits=(-1, 1)),
        ac.revolute("d", links[1]["down"], beam["right"], limits=(-1, 1)),
    ]
    assembly = ac.Assembly.from_parts("swing", parts=[wall, beam, *links], joints=joints, ground="wall")
    held = assembly.dynamics().inverse(assembly.mechanism.rest, [0.0], [0.0])
    (loop,) = assembly.mechanism.loop_joints
    weight = 0.2 * 0.01 * 0.01 * 7850 * G
    assert np.linalg.norm(held.constraints[loop.name][:3]) == pytest.approx(weight / 2, rel=1e-6)
    assert held.efforts == pytest.approx([0.0], abs=1e-9)


def test_a_wrong_shape_and_a_missing_mass_are_refused_by_name() -> None:
    dynamics = pendulum().dynamics()
    with pytest.raises(KinematicsError, match="1 finite numbers"):
        dynamics.forward([0.0], [1.0, 2.0], [0.0])
    with pytest.raises(KinematicsError, match="no mass"):
        ac.Dynamics(pendulum().mechanism, {}).centre_of_mass([0.0])
