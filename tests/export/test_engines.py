"""Exports are read back, unchanged and from disk, by engines that are not ours."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from articad.assembly import Assembly
from articad.export.mjcf import write_mjcf
from articad.export.urdf import write_urdf
from tests.assemblies import all_joint_kinds, random_configurations, random_tree
from tests.engines import (
    MujocoMjcf,
    PinocchioUrdf,
    YourdfpyUrdf,
    bullet_poses,
    disagreement,
    joint_values,
    largest_difference,
    our_poses,
)

POSE_TOLERANCE = 1e-9  # m, and entries of rotation matrices
BULLET_TOLERANCE = 1e-5  # PyBullet reads and keeps single precision in places
HARMLESS_PENETRATION = 5e-5  # m; stacked parts touch

pytestmark = pytest.mark.engines


@pytest.fixture(scope="module")
def assembly() -> Assembly:
    return all_joint_kinds()


@pytest.fixture(scope="module")
def folder(assembly: Assembly, tmp_path_factory: Any) -> Path:
    folder: Path = tmp_path_factory.mktemp("export")
    write_urdf(assembly).write(folder)
    write_mjcf(assembly).write(folder)
    return folder


def test_part_poses_agree_with_pinocchio_and_mujoco_at_a_thousand_configurations(assembly: Assembly, tmp_path: Path) -> None:
    assert disagreement(assembly, tmp_path, random_configurations(assembly, 0, 1000)) < POSE_TOLERANCE


def test_every_part_is_compared(assembly: Assembly, folder: Path) -> None:
    values = joint_values(assembly, assembly.mechanism.rest)

    assert PinocchioUrdf(folder / "all_kinds.urdf").poses(values).keys() == assembly.parts.keys()
    assert MujocoMjcf(folder / "all_kinds.xml").home().keys() == assembly.parts.keys()


def test_yourdfpy_and_mujoco_read_the_urdf_alike(assembly: Assembly, folder: Path) -> None:
    yourdfpy, mujoco = YourdfpyUrdf(folder / "all_kinds.urdf"), MujocoMjcf(folder / "all_kinds.urdf")
    for q in random_configurations(assembly, 1, 20):
        ours, values = our_poses(assembly, q), joint_values(assembly, q)

        assert largest_difference(ours, yourdfpy.poses(values)) < POSE_TOLERANCE
        assert largest_difference(ours, mujoco.poses(values)) < POSE_TOLERANCE


def test_pybullet_reads_the_urdf(assembly: Assembly, folder: Path) -> None:
    q = random_configurations(assembly, 2, 1)[0]
    found = bullet_poses(folder / "all_kinds.urdf", joint_values(assembly, q))

    assert found.keys() == assembly.parts.keys() - {"base"}
    assert largest_difference(our_poses(assembly, q), found) < BULLET_TOLERANCE


def test_masses_are_those_of_the_parts(assembly: Assembly, folder: Path) -> None:
    import mujoco
    import pinocchio as pin

    total = sum(part.mass.mass for part in assembly.parts.values() if part.mass is not None)
    model = pin.buildModelFromUrdf(str(folder / "all_kinds.urdf"))
    mjcf = mujoco.MjModel.from_xml_path(str(folder / "all_kinds.xml"))

    assert sum(inertia.mass for inertia in model.inertias) == pytest.approx(total, rel=1e-12)
    assert mjcf.body_mass.sum() == pytest.approx(total, rel=1e-12)


def test_the_urdf_has_the_whole_assemblys_inertia_in_any_pose_of_its_turning_joints(assembly: Assembly, folder: Path) -> None:
    import pinocchio as pin

    model = pin.buildModelFromUrdf(str(folder / "all_kinds.urdf"))
    data = model.createData()
    q = pin.neutral(model)
    pin.ccrba(model, data, q, np.zeros(model.nv))
    ours = assembly.mass([0.0 if driver.unit != "1" else float(driver.name.endswith("qw")) for driver in assembly.drivers])
    base = model.inertias[0]
    about_com = data.Ig.inertia + _steiner(data.Ig.mass, data.com[0] - ours.com / 1000)
    about_com = about_com + base.inertia + _steiner(base.mass, base.lever - ours.com / 1000)

    assert np.allclose(about_com * 1e6, ours.inertia, rtol=1e-9, atol=1e-9)


def _steiner(mass: float, arm: Any) -> Any:
    return mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))


def test_every_moving_link_has_mass_and_a_collision_shape(assembly: Assembly, folder: Path) -> None:
    import mujoco

    model = mujoco.MjModel.from_xml_path(str(folder / "all_kinds.xml"))
    for part in assembly.parts:
        body = model.body(part)

        assert body.mass[0] > 0
        assert any(model.geom_bodyid[geom] == body.id and model.geom_contype[geom] for geom in range(model.ngeom))


def test_the_world_is_at_peace_at_home(assembly: Assembly, folder: Path) -> None:
    import mujoco

    model = mujoco.MjModel.from_xml_path(str(folder / "all_kinds.xml"))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("home").id)
    mujoco.mj_forward(model, data)

    assert all(contact.dist > -HARMLESS_PENETRATION for contact in data.contact)


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), count=st.integers(2, 9))
def test_random_trees_agree(seed: int, count: int, tmp_path_factory: Any) -> None:
    assembly = random_tree(seed, count)
    assume(assembly.drivers)

    assert disagreement(assembly, tmp_path_factory.mktemp("tree"), random_configurations(assembly, seed, 5)) < POSE_TOLERANCE


def test_limits_are_those_of_the_joints(assembly: Assembly, folder: Path) -> None:
    import mujoco
    import pinocchio as pin

    urdf = pin.buildModelFromUrdf(str(folder / "all_kinds.urdf"))
    mjcf = mujoco.MjModel.from_xml_path(str(folder / "all_kinds.xml"))
    expected = {"hinge": (-1.0, 2.0), "drawer": (0.01, 0.2), "flap": (-1.0, 2.0), "ring__t": (-0.005, 0.025), "cross__ry": (-0.5, 0.7)}
    for name, (lower, upper) in expected.items():
        at = urdf.joints[urdf.getJointId(name)].idx_q

        assert (urdf.lowerPositionLimit[at], urdf.upperPositionLimit[at]) == pytest.approx((lower, upper), rel=1e-15)
        assert tuple(mjcf.joint(name).range) == pytest.approx((lower, upper), rel=1e-15)
    assert not mjcf.joint("wheel").limited[0]
    assert tuple(mjcf.joint("head").range) == pytest.approx((0.0, 2 * math.acos(math.cos(math.pi / 6) * math.cos(0.5))))
