"""Every example with closed loops: built by the real kernel, moved along its drivers, and closed in MuJoCo as we close it."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray

from articad.assembly import Assembly
from articad.export.mjcf import write_mjcf
from articad.export.urdf import write_urdf
from articad.plan.check import check_plan
from articad.plan.schema import AssemblyPlan
from tests.engines import MujocoMjcf, PinocchioUrdf, YourdfpyUrdf, ball_values, joint_values, largest_difference, our_poses

ROOT = Path(__file__).resolve().parents[2]
NAMES = ["four_bar", "slider_crank", "scissor_lift", "stewart_platform", "jansen_leg", "geared_four_bar", "toggle_clamp"]
POSE_TOLERANCE = 1e-9  # m, and entries of rotation matrices
RESIDUAL = 1e-9  # of MuJoCo's equality constraints
CONFIGURATIONS = 5

pytestmark = [pytest.mark.engines, pytest.mark.slow]


class Linkage(NamedTuple):
    plan: AssemblyPlan
    assembly: Assembly
    q: NDArray[np.float64]
    folder: Path


@pytest.fixture(scope="module", params=NAMES)
def linkage(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Linkage:
    plan = AssemblyPlan.load(ROOT / "examples" / request.param)
    assembly = Assembly.from_plan(plan, ROOT / "examples" / request.param / "parts")
    folder = tmp_path_factory.mktemp(plan.name)
    write_urdf(assembly).write(folder)
    write_mjcf(assembly).write(folder)
    return Linkage(plan, assembly, closed_configurations(assembly), folder)


def closed_configurations(assembly: Assembly) -> NDArray[np.float64]:
    """Five values of each driver within a half of what it can do, the others at rest, `(n, nq)`."""
    rows = []
    for column, driver in enumerate(assembly.drivers):
        feasible = assembly.feasible_range(driver.name)
        lower, upper = max(feasible.lower, driver.rest - 3.0), min(feasible.upper, driver.rest + 3.0)
        for share in np.linspace(-0.5, 0.5, CONFIGURATIONS):
            q = np.array(assembly.mechanism.rest)
            q[column] = driver.rest + share * ((upper - driver.rest) if share > 0 else (driver.rest - lower))
            rows.append(q)
    return np.array(rows)


def test_the_plan_has_no_errors_nor_warnings_and_its_loops_are_declared(linkage: Linkage) -> None:
    findings = check_plan(linkage.plan)

    assert {finding.severity for finding in findings} <= {"info"}, str(findings)
    assert linkage.assembly.mechanism.loop_joints
    assert linkage.assembly.mechanism.mobility == linkage.plan.freedoms
    assert {finding.severity for finding in linkage.assembly.findings} <= {"info"}, str(linkage.assembly.findings)


def test_nothing_interferes_at_rest(linkage: Linkage) -> None:
    findings = linkage.assembly.check().findings

    assert {finding.severity for finding in findings} <= {"info"}, str(findings)


def test_drivers_reach_what_the_plan_declares(linkage: Linkage) -> None:
    for driver in linkage.assembly.drivers:
        feasible = linkage.assembly.feasible_range(driver.name)
        assert feasible.findings.ok, str(feasible.findings)
        assert feasible.lower <= driver.lower + 1e-9 or driver.lower == -np.inf
        assert feasible.upper >= driver.upper - 1e-9 or driver.upper == np.inf


def test_mujoco_finds_the_loops_closed_where_we_close_them(linkage: Linkage) -> None:
    engine = MujocoMjcf(linkage.folder / f"{linkage.plan.name}.xml")
    mujoco, model, data = engine.mujoco, engine.model, engine.data

    assert largest_difference(our_poses(linkage.assembly, linkage.assembly.mechanism.rest), engine.home()) < POSE_TOLERANCE
    for q in [linkage.assembly.mechanism.rest, *linkage.q]:
        values = joint_values(linkage.assembly, q)
        poses = engine.poses(values, ball_values(linkage.assembly, q))
        assert largest_difference(our_poses(linkage.assembly, q), poses) < POSE_TOLERANCE
        mujoco.mj_forward(model, data)
        equality = data.efc_type == mujoco.mjtConstraint.mjCNSTR_EQUALITY
        assert equality.any()
        assert np.abs(data.efc_pos[equality]).max() < RESIDUAL


def test_the_tree_of_the_urdf_poses_every_part_alike(linkage: Linkage) -> None:
    path = linkage.folder / f"{linkage.plan.name}.urdf"
    pinocchio, yourdfpy = PinocchioUrdf(path), YourdfpyUrdf(path)
    in_tree = set(pinocchio.model.names)
    for q in linkage.q:
        ours = our_poses(linkage.assembly, q)
        values = {name: value for name, value in joint_values(linkage.assembly, q).items() if name in in_tree}
        assert largest_difference(ours, pinocchio.poses(values)) < POSE_TOLERANCE
        assert largest_difference(ours, yourdfpy.poses(values)) < POSE_TOLERANCE
