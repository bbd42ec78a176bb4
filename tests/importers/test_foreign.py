"""Files that nobody here wrote: poses of links agree with the engines that read them, before and after a round trip."""

from __future__ import annotations

from pathlib import Path

import pytest

from articad.errors import ReadError
from articad.kinematics.joints import JointType
from tests.foreign import TOLERANCE, assert_survives, configurations, difference, oracle_of, read

pybullet_data = pytest.importorskip("pybullet_data")

ROOT = Path(pybullet_data.getDataPath())
RANDOM = [ROOT / "random_urdfs" / f"{i:03}" / f"{i:03}.urdf" for i in range(0, 1000, 100)]
URDFS = sorted(path for path in ROOT.rglob("*.urdf") if "random_urdfs" not in path.parts) + RANDOM
MJCFS = sorted((ROOT / "mjcf").glob("*.xml"))

REFUSED = {
    "racecar/racecar_differential.urdf": "has 4 numbers",
    "quadruped/microtaur/microtaur.urdf": "has 4 numbers",
    "biped/biped2d_pybullet.urdf": "is not a number",
    "husky/husky.urdf": "is not a number",  # xacro that was not expanded
    "bicycle/bike.urdf": "is not a number",
    "torus_deform.urdf": "0 root links",
    "torus/torus_with_plane.urdf": "0 root links",
    "torus/torus_with_separate_plane.urdf": "0 root links",
    "mjcf/ground.xml": "MuJoCo refuses it",
    "mjcf/ground_plane.xml": "MuJoCo refuses it",
    "mjcf/half_cheetah.xml": "MuJoCo refuses it",
    "mjcf/hopper.xml": "MuJoCo refuses it",
    "mjcf/humanoid_fixed.xml": "MuJoCo refuses it",
    "mjcf/humanoid_symmetric.xml": "MuJoCo refuses it",
    "mjcf/swimmer.xml": "MuJoCo refuses it",
    "mjcf/walker2d.xml": "MuJoCo refuses it",
}

UNREAD_BY_PINOCCHIO = {"spherical_joint_limit.urdf", "humanoid/humanoid.urdf"}

pytestmark = pytest.mark.engines


def relative(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


def test_there_are_enough_files_and_few_are_refused() -> None:
    assert len(URDFS) + len(MJCFS) >= 60
    assert len(REFUSED) <= 0.15 * (len(URDFS) + len(MJCFS))


@pytest.mark.parametrize("path", [*URDFS, *MJCFS], ids=relative)
def test_a_foreign_file_is_posed_as_its_engine_poses_it_and_comes_back(path: Path, tmp_path: Path) -> None:
    if relative(path) in REFUSED:
        with pytest.raises(ReadError, match=REFUSED[relative(path)]):
            read(path, ROOT)
        return
    assembly = read(path, ROOT)
    q = configurations(assembly, 2)
    if relative(path) not in UNREAD_BY_PINOCCHIO:
        for row in q:
            assert difference(assembly, row, oracle_of(path)(assembly, path, row)) < TOLERANCE
    assert_survives(assembly, tmp_path, q)


@pytest.mark.parametrize(("name", "kind"), [("humanoid/humanoid.urdf", JointType.BALL), ("cartpole.urdf", JointType.SLIDER)])
def test_kinds_that_are_rare_are_among_them(name: str, kind: JointType) -> None:
    assert kind in {joint.type for joint in read(ROOT / name, ROOT).joints}


def test_mimic_free_bodies_and_names_of_packages_are_among_them() -> None:
    assert read(ROOT / "franka_panda/panda.urdf", ROOT).mechanism.couplings
    assert "package://" in (ROOT / "franka_panda/panda.urdf").read_text()
    assert any(joint.type is JointType.FREE for joint in read(ROOT / "mjcf/capsule.xml", ROOT).joints)
