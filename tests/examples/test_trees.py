"""Every example and the fixture: built by the real kernel, checked, exported, and read by engines that are not ours."""

from __future__ import annotations

import json
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from lxml import etree

from articad.assembly import Assembly
from articad.export.mjcf import write_mjcf
from articad.export.urdf import write_urdf
from articad.interference.check import Checks
from articad.plan.check import check_plan
from articad.plan.schema import AssemblyPlan
from tests.assemblies import random_configurations
from tests.engines import MujocoMjcf, YourdfpyUrdf, bullet_poses, disagreement, joint_values, largest_difference, our_poses

ROOT = Path(__file__).resolve().parents[2]
PRODUCTS = ["examples/metronome", "examples/wardrobe", "examples/desk_lamp", "examples/table_football", "tests/fixtures/five_joints"]
POSE_TOLERANCE = 1e-9  # m, and entries of rotation matrices
BULLET_TOLERANCE = 1e-5  # PyBullet keeps single precision in places

pytestmark = [pytest.mark.engines, pytest.mark.slow]


class Product(NamedTuple):
    plan: AssemblyPlan
    assembly: Assembly
    checks: Checks
    folder: Path


@pytest.fixture(scope="module", params=PRODUCTS, ids=lambda path: path.rpartition("/")[2])
def product(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Product:
    plan = AssemblyPlan.load(ROOT / request.param)
    assembly = Assembly.from_plan(plan, ROOT / request.param / "parts")
    folder = tmp_path_factory.mktemp(plan.name)
    write_urdf(assembly).write(folder)
    write_mjcf(assembly).write(folder)
    return Product(plan, assembly, assembly.check(), folder)


def test_the_plan_is_free_of_findings_and_waivers(product: Product) -> None:
    assert str(check_plan(product.plan)) == "no findings"
    assert product.plan.allow == ()


def test_every_part_builds_without_findings_into_one_valid_solid(product: Product) -> None:
    assert str(product.assembly.findings) == "no findings"
    for realised in product.assembly.realised.values():
        shape = json.loads((realised.built.folder / "result.json").read_text())["shape"]
        assert (shape["solids"], shape["valid"]) == (1, True)
        assert realised.part.mesh is not None
        assert realised.part.mesh.is_closed


def test_nothing_interferes_at_rest(product: Product) -> None:
    deepest = max((pair.depth or 0.0 for pair in product.checks.pairs), default=0.0)

    assert str(product.checks.findings) == "no findings"
    assert {pair.verdict for pair in product.checks.pairs} <= {"clear", "contact"}
    assert deepest <= 0.02, f"largest overlap depth {deepest:.4f} mm"


def test_poses_agree_with_pinocchio_and_mujoco_at_a_thousand_configurations(product: Product, tmp_path: Path) -> None:
    assert disagreement(product.assembly, tmp_path, random_configurations(product.assembly, 7, 1000)) < POSE_TOLERANCE


def test_pinocchio_mujoco_yourdfpy_and_pybullet_read_the_urdf_alike(product: Product) -> None:
    path = product.folder / f"{product.plan.name}.urdf"
    yourdfpy, mujoco = YourdfpyUrdf(path), MujocoMjcf(path)
    for q in random_configurations(product.assembly, 3, 3):
        ours, values = our_poses(product.assembly, q), joint_values(product.assembly, q)
        assert largest_difference(ours, yourdfpy.poses(values)) < POSE_TOLERANCE
        assert largest_difference(ours, mujoco.poses(values)) < POSE_TOLERANCE
        assert largest_difference(ours, bullet_poses(path, values)) < BULLET_TOLERANCE


def test_every_moving_link_has_mass_and_a_collision_shape(product: Product) -> None:
    root = etree.parse(str(product.folder / f"{product.plan.name}.urdf")).getroot()
    for link in root.iterfind("link"):
        mass = link.find("inertial/mass")
        assert mass is not None, link.get("name")
        assert float(mass.get("value")) > 0
        if "__" not in link.get("name"):  # carrier links have no shape of their own
            assert link.find("collision/geometry") is not None, link.get("name")


def test_the_exports_weigh_what_the_parts_weigh(product: Product) -> None:
    root = etree.parse(str(product.folder / f"{product.plan.name}.urdf")).getroot()
    urdf = sum(float(mass.get("value")) for mass in root.iterfind("link/inertial/mass"))
    mujoco = MujocoMjcf(product.folder / f"{product.plan.name}.xml").model

    expected = product.assembly.mass().mass
    assert urdf == pytest.approx(expected, rel=1e-9)
    assert float(np.sum(mujoco.body_mass)) == pytest.approx(expected, rel=1e-9)
