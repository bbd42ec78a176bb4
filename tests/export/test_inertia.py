from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree

from articad.assembly import Assembly
from articad.connectors.se3 import SE3
from articad.export.inertia import CARRIER_INERTIA_KG_M2, CARRIER_MASS_KG, LEAST_SHARE, Inertial, is_possible
from articad.export.lowering import lower
from articad.export.mjcf import RESERVED, write_mjcf
from articad.export.urdf import write_urdf
from articad.geometry.mass import MassProperties
from articad.geometry.shapes import box
from tests.assemblies import all_joint_kinds, four_bar, random_tree

sizes = st.floats(0.5, 500)
points = st.lists(st.floats(-300, 300), min_size=3, max_size=3)


def cuboid(x: float, y: float, z: float, at: list[float], density: float = 1000.0) -> Inertial:
    return Inertial.from_part(MassProperties.from_solid(*box(x, y, z).solid_integrals(), density), SE3.from_translation(at))


def test_millimetres_become_metres() -> None:
    inertial = cuboid(100, 200, 300, [10, 0, 0])

    assert inertial.mass == pytest.approx(6.0)
    assert inertial.com == pytest.approx([0.01, 0, 0])
    assert inertial.inertia == pytest.approx(np.diag([0.5 * (0.04 + 0.09), 0.5 * (0.01 + 0.09), 0.5 * (0.01 + 0.04)]))


@given(sizes, sizes, sizes, points, points, st.integers(1, 3))
def test_body_and_carriers_together_are_the_body(x: float, y: float, z: float, at: list[float], origin: list[float], count: int) -> None:
    whole = cuboid(x, y, z, at)
    where = np.array(origin) / 1000
    rest, carrier = whole.without_carriers(count, where)
    placed = Inertial(carrier.mass, where, carrier.inertia)

    assert np.allclose(rest.pseudo + count * placed.pseudo, whole.pseudo, rtol=1e-12, atol=1e-15 * whole.pseudo.max())


@given(sizes, sizes, sizes, points, st.integers(1, 3))
def test_what_is_left_of_a_body_is_physical(x: float, y: float, z: float, at: list[float], count: int) -> None:
    rest, carrier = cuboid(x, y, z, at).without_carriers(count)
    small, middle, large = np.linalg.eigvalsh(rest.inertia)

    assert rest.mass > 0
    assert small > 0
    assert large < small + middle
    assert 0 < carrier.mass <= CARRIER_MASS_KG


def test_a_heavy_body_gets_full_carriers() -> None:
    rest, carrier = cuboid(100, 100, 100, [0, 0, 0]).without_carriers(2)

    assert (carrier.mass, carrier.inertia[0, 0]) == (CARRIER_MASS_KG, CARRIER_INERTIA_KG_M2)
    assert rest.mass == pytest.approx(1.0 - 2 * CARRIER_MASS_KG)


@pytest.mark.parametrize("flat", [[1, 1, 0], [1, 0, 0]])
def test_bodies_without_thickness_keep_a_little(flat: list[float]) -> None:
    second_moments = np.diag(flat) * 1e-3
    inertia = np.trace(second_moments) * np.eye(3) - second_moments
    rest, carrier = Inertial(1.0, np.zeros(3), inertia).without_carriers(1)

    assert carrier.mass > 0
    assert np.isfinite(rest.inertia).all()


def test_a_thin_sheet_keeps_the_triangle_inequality_when_its_inertia_is_rounded() -> None:
    """1 m by 35 micrometres, turned: with ten digits, A + B was less than C by 2.2e-10 of it, which MuJoCo refuses."""
    products = [
        [10.29519898654466, -1.7523090863176987, -1.5334622978175965],
        [0, 5.647446663844862, -0.5962323333722821],
        [0, 0, 6.527624643951406],
    ]
    upper = np.array(products)
    assert_triangle(Inertial(1.0, np.zeros(3), upper + np.triu(upper, 1).T))


@given(st.floats(-7, -3), st.floats(0.3, 1.0), st.lists(st.floats(-1, 1), min_size=4, max_size=4))
def test_no_sheet_or_rod_violates_the_triangle_inequality(thin: float, wide: float, turn: list[float]) -> None:
    moments = np.array([1.0, wide, 10.0**thin]) ** 2  # second moments along the axes
    R = SE3.from_axis_angle((turn[0], turn[1], turn[2] + 2), turn[3]).rotation
    about_com = R @ np.diag(moments) @ R.T
    assert_triangle(Inertial(1.0, np.zeros(3), np.trace(about_com) * np.eye(3) - (about_com + about_com.T) / 2))


def assert_triangle(body: Inertial) -> None:
    """Assert that the written moments, by Jacobi's method and as NumPy has them, satisfy A + B >= C."""
    written = body.inside_bounds().without_dust()
    for moments in (written.principal()[0], np.linalg.eigvalsh(written.inertia)):
        small, middle, large = np.sort(moments)
        assert small + middle >= large
    assert np.abs(written.inertia - body.inertia).max() <= 1e-8 * np.abs(body.inertia).max()


def test_no_carriers_take_nothing() -> None:
    whole = cuboid(1, 2, 3, [0, 0, 0])

    assert whole.without_carriers(0)[0] is whole


@pytest.mark.parametrize("moments", [(1.0, 1.0, 9.0), (0.0, 0.0, 0.0), (-1.0, 2.0, 2.0), (1e-20, 1.0, 1.0)])
def test_the_nearest_possible_body_is_possible_and_no_other_body_changes(moments: tuple[float, float, float]) -> None:
    R = SE3.exp([0, 0, 0, 0.3, -0.5, 0.9]).rotation
    odd = Inertial(2.0, np.array([0.1, 0.2, 0.3]), R @ np.diag(moments) @ R.T)
    found = odd.possible()

    assert not is_possible(odd.mass, odd.inertia)
    assert is_possible(found.mass, found.inertia)
    assert (found.mass, found.com.tolist()) == (odd.mass, odd.com.tolist())
    assert found.possible() is found


EQUAL = [(1.0, 1.0, 2.0), (1.0, 2.0, 2.0), (3.0, 3.0, 3.0), (1.0, 1.0 + 1e-15, 2.0), (1e-12, 1.0, 1.0), (0.2, 0.5, 0.6)]


@given(st.sampled_from(EQUAL), st.lists(st.floats(-4, 4), min_size=3, max_size=3))
def test_principal_axes_and_moments_are_the_inertia_also_where_moments_are_equal(
    moments: tuple[float, float, float], turn: list[float]
) -> None:
    R = SE3.exp([0, 0, 0, *turn]).rotation
    inertia = (R * moments) @ R.T
    inertia = (inertia + inertia.T) / 2
    found, axes = Inertial(1.0, np.zeros(3), inertia).principal()

    assert np.allclose((axes * found) @ axes.T, inertia, rtol=0, atol=1e-14)
    assert np.allclose(axes.T @ axes, np.eye(3), rtol=0, atol=1e-14)
    assert np.linalg.det(axes) > 0
    assert sorted(found) == pytest.approx(sorted(moments), abs=1e-14)


def test_axes_of_a_disk_turn_no_further_than_its_axis_does() -> None:
    R = SE3.exp([0, 0, 0, 0.3, 0, 0]).rotation
    found, axes = Inertial(1.0, np.zeros(3), (R * (1.0, 1.0, 2.0)) @ R.T).principal()

    assert found == pytest.approx([1, 1, 2], abs=1e-15)
    assert axes == pytest.approx(R, abs=1e-15)
    diagonal = np.diag([0.3, 0.1, 0.2])
    found, axes = Inertial(1.0, np.zeros(3), diagonal).principal()
    assert found.tolist() == [0.3, 0.1, 0.2]
    assert axes.tolist() == np.eye(3).tolist()


@pytest.mark.engines
@pytest.mark.parametrize("seed", range(4))
def test_mujoco_and_bullet_read_the_inertia_of_every_link_from_mjcf(seed: int, tmp_path: Path) -> None:
    import mujoco

    assembly = random_tree(seed)
    bundle = write_mjcf(assembly)
    bundle.write(tmp_path)
    path = str(tmp_path / bundle.main)
    expected = {link.name: link.inertial for link in lower(assembly, RESERVED).links if link.inertial is not None}
    assert len(expected) == 6

    model = mujoco.MjModel.from_xml_path(path)
    for name, inertial in expected.items():
        body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name)
        w, *xyz = model.body_iquat[body]
        axes = SE3.from_quaternion([*xyz, w]).rotation
        largest = np.abs(inertial.inertia).max()
        assert model.body_mass[body] == pytest.approx(inertial.mass, rel=1e-15)
        assert np.allclose(
            (axes * model.body_inertia[body]) @ axes.T, inertial.inertia, rtol=0, atol=5e-10 * largest
        )  # written with 10 digits

    bullet = pytest.importorskip("pybullet", reason="PyBullet has no wheel for this Python")
    client = bullet.connect(bullet.DIRECT)
    found = {}
    for robot in bullet.loadMJCF(path, flags=bullet.URDF_USE_INERTIA_FROM_FILE, physicsClientId=client):
        for index in range(-1, bullet.getNumJoints(robot, physicsClientId=client)):
            said = bullet.getBodyInfo(robot, client)[0] if index < 0 else bullet.getJointInfo(robot, index, physicsClientId=client)[12]
            found[said.decode()] = bullet.getDynamicsInfo(robot, index, physicsClientId=client)[:5]
    bullet.disconnect(client)
    balls = etree.parse(path).xpath("//body[joint[@type='ball']]")  # PyBullet leaves them out, with what they carry
    lost = {body.get("name") for ball in balls for body in ball.iter("body")}
    assert expected.keys() - found.keys() == lost
    for name in expected.keys() & found.keys():
        inertial = expected[name]
        mass, _, moments, com, turn = found[name]
        axes, largest = SE3.from_quaternion(turn).rotation, np.abs(inertial.inertia).max()
        assert mass == pytest.approx(inertial.mass, rel=1e-6)  # PyBullet keeps vectors in single precision
        assert np.allclose(com, inertial.com, rtol=1e-6, atol=1e-7)
        assert np.allclose((axes * moments) @ axes.T, inertial.inertia, rtol=0, atol=1e-6 * largest)


KINDS = {"rod": (1.0, 0.0, 0.0), "plate": (1.0, 0.6, 0.0), "disk": (1.0, 1.0, 0.0), "thin": (1.0, 1e-13, 1e-15), "solid": (1.0, 0.5, 0.3)}


@pytest.mark.engines
@pytest.mark.parametrize("scale", [1e-9, 1e-5, 1.0, 1e4])
@pytest.mark.parametrize("write", [write_urdf, write_mjcf])
def test_rods_and_plates_load_in_mujoco_however_they_are_turned(write: Any, scale: float, tmp_path: Path) -> None:
    """Bodies on the bound A + B = C, on every joint kind: with carriers, with ghosts of loops, and with none."""
    import mujoco

    random = np.random.default_rng(int(1 / scale) % 97)
    for case, assembly in enumerate((all_joint_kinds(), four_bar(), all_joint_kinds())):
        parts, expected = [], {}
        for part in assembly.parts.values():
            second = np.array(KINDS[random.choice(list(KINDS))]) * scale
            R = SE3.exp([0, 0, 0, *random.normal(size=3)]).rotation
            about_com = (R * second) @ R.T
            inertia = np.trace(about_com) * np.eye(3) - about_com
            mass = MassProperties(2.5, random.normal(size=3) * 30, inertia * 1e6)
            parts.append(replace(part, mass=mass))
            if sum(sorted(second)[:2]) > 1e-9 * scale and is_possible(2.5, inertia):  # else it is a row of the losses
                expected[part.name] = sorted(second)
        heavy = Assembly.from_parts("heavy", parts=parts, joints=assembly.joints, ground=assembly.ground)
        bundle = write(heavy)
        bundle.write(tmp_path / str(case))

        model = mujoco.MjModel.from_xml_path(str(tmp_path / str(case) / bundle.main))

        for body in range(1, model.nbody):
            second = model.body_inertia[body].sum() / 2 - model.body_inertia[body]
            assert second.min() > 0
            name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_BODY, body)
            if case == 0 and write is write_mjcf and name in expected:  # no loop takes half of it
                assert sorted(second) == pytest.approx(expected[name], abs=4 * LEAST_SHARE * scale + 1e-13)
