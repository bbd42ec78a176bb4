"""Every export loads, unchanged and from disk, in MuJoCo, Pinocchio, yourdfpy, PyBullet and check_urdf; USD in usd-core."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from articad.assembly import Assembly
from articad.errors import ExportError
from articad.export.mjcf import write_mjcf
from articad.export.urdf import write_urdf
from articad.export.usd import write_usd
from articad.plan.schema import AssemblyPlan
from tests.assemblies import all_joint_kinds, four_bar, geared_pair, rigid_ring

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = [*sorted(path.parent for path in ROOT.glob("examples/*/plan.json")), ROOT / "tests/fixtures/five_joints"]
MADE: dict[str, Any] = {"kinds": all_joint_kinds, "gears": geared_pair, "loop": four_bar, "ring": rigid_ring}
OF_URDF: list[dict[str, Any]] = [
    {},
    {"meshes": "obj"},
    {"collision": "hull"},
    {"loops": "isaac"},
    {"loops": "drake"},
    {"loops": "mimic"},
    {"srdf": True, "ros2_control": True},
]
OF_MJCF: list[dict[str, Any]] = [{}, {"meshes": "obj", "actuators": "position"}, {"collision": "hull"}]
CHECK_URDF = shutil.which("check_urdf") or str(Path(sys.executable).with_name("check_urdf"))  # Pinocchio's wheels bring it

pytestmark = [pytest.mark.engines, pytest.mark.filterwarnings("ignore::DeprecationWarning:yourdfpy")]


def in_mujoco(path: Path) -> int:
    import mujoco

    return int(mujoco.MjModel.from_xml_path(str(path)).nbody)


def in_pinocchio(path: Path) -> int:
    import pinocchio as pin

    model = pin.buildModelFromUrdf(str(path))
    shapes = pin.buildGeomFromUrdf(model, str(path), pin.GeometryType.COLLISION, package_dirs=[str(path.parent)])
    return int(model.nframes + shapes.ngeoms)


def in_yourdfpy(path: Path) -> int:
    import yourdfpy

    robot = yourdfpy.URDF.load(str(path), build_collision_scene_graph=True, load_collision_meshes=True)
    assert robot.validate()
    return len(robot.link_map)


def in_pybullet(path: Path) -> int:
    pybullet = pytest.importorskip("pybullet")
    client = pybullet.connect(pybullet.DIRECT)
    try:
        return (
            int(pybullet.getNumJoints(pybullet.loadURDF(str(path), useFixedBase=True, physicsClientId=client), physicsClientId=client)) + 1
        )
    finally:
        pybullet.disconnect(client)


def in_check_urdf(path: Path) -> int:
    done = subprocess.run([CHECK_URDF, str(path)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout.count("child(")


def assert_loads(assembly: Assembly, folder: Path, urdf: list[dict[str, Any]], mjcf: list[dict[str, Any]]) -> None:
    for index, options in enumerate(urdf):
        try:
            bundle = write_urdf(assembly, **options)
        except ExportError:
            assert options == {"loops": "mimic"}  # where no straight line is good enough
            continue
        bundle.write(folder / f"urdf_{index}")
        path = folder / f"urdf_{index}" / bundle.main
        for load in (in_mujoco, in_pinocchio, in_yourdfpy, in_pybullet, in_check_urdf):
            assert load(path) >= (1 if load in {in_mujoco, in_check_urdf} else len(assembly.parts))
    for index, options in enumerate(mjcf):
        bundle = write_mjcf(assembly, **options)
        bundle.write(folder / f"mjcf_{index}")
        assert in_mujoco(folder / f"mjcf_{index}" / bundle.main) > len(assembly.parts)
    usd = pytest.importorskip("pxr.Usd")
    bundle = write_usd(assembly)
    bundle.write(folder / "usd")
    assert usd.Stage.Open(str(folder / "usd" / bundle.main)).GetDefaultPrim().IsValid()


@pytest.mark.parametrize("name", MADE)
def test_every_joint_kind_coupling_and_loop_loads_with_every_option(name: str, tmp_path: Path) -> None:
    assert_loads(MADE[name](), tmp_path, OF_URDF, OF_MJCF)


@pytest.mark.slow
@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.name)
def test_every_example_loads(example: Path, tmp_path: Path) -> None:
    assembly = Assembly.from_plan(AssemblyPlan.load(example), example / "parts")

    assert_loads(assembly, tmp_path, OF_URDF[:1], OF_MJCF[:1])
