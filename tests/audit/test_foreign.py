"""Models that nobody here made: audits come to an end, in bounded time and memory, and say nothing that cannot be counter-checked.

The numbers of `DRAWN` were worked out by hand; docs/reference/audit.md says how.
"""

from __future__ import annotations

import json
import resource
import time
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from lxml import etree

from articad.auditing.examine import AuditOptions, audit_file
from articad.findings import Finding
from articad.findings.codes import CODES
from articad.geometry.shapes import box, cylinder
from tests.audit import defects

pybullet_data = pytest.importorskip("pybullet_data")

ROOT = Path(pybullet_data.getDataPath())
EVERY = sorted(path for path in ROOT.rglob("*.urdf") if "random_urdfs" not in path.parts)
EVERY += [ROOT / "random_urdfs" / f"{i:03}" / f"{i:03}.urdf" for i in range(0, 1000, 100)] + sorted((ROOT / "mjcf").glob("*.xml"))
FEW = ["TwoJointRobot_wo_fixedJoints.urdf", "cube_no_rotation.urdf", "differential/diff_ring.urdf", "torus_deform.urdf", "pendulum5.urdf", "random_urdfs/300/300.urdf", "mjcf/ant.xml", "mjcf/reacher.xml"]  # fmt: skip

LONGEST_S = 40.0  # of the processor, the motion's 12 s included
LONGEST_FIFTY_S = 20.0
MOST_MB = 2500.0  # of a process that audits one file after the other

pytestmark = pytest.mark.engines


def relative(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


def spent() -> float:
    own, children = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return own.ru_utime + own.ru_stime + children.ru_utime + children.ru_stime


def assert_comes_to_an_end(path: Path) -> None:
    before = spent()
    found = audit_file(path, AuditOptions(root=ROOT))

    assert spent() - before < LONGEST_S
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024 < MOST_MB
    report = json.loads(json.dumps(found.to_json(), allow_nan=False))
    assert report["schema"] == "articad.audit/1"
    for finding in found.findings:
        assert finding.code in CODES
        assert finding.message
        assert finding.hint
    if found.ok:
        assert found.links


@pytest.mark.parametrize("name", FEW)
def test_an_audit_comes_to_an_end(name: str) -> None:
    assert_comes_to_an_end(ROOT / name)


@pytest.mark.corpus
@pytest.mark.parametrize("path", EVERY, ids=relative)
def test_every_audit_comes_to_an_end(path: Path) -> None:
    assert_comes_to_an_end(path)


def test_there_are_enough_files() -> None:
    assert len(EVERY) >= 60


# ---------------------------------------------------------------------- fifty links


def chain(folder: Path, count: int = 50) -> Path:
    """Boxes and cylinders on top of each other, each turning on the one below."""
    root = etree.Element("robot", name="chain")
    for index in range(count):
        mesh = defects.moved(cylinder(8, 30) if index % 2 else box(16, 16, 30), 0, 0, 15)
        root.append(defects.link(f"link_{index}", mesh, folder))
        if index:
            joint: Any = defects.joint(f"joint_{index}", "revolute", f"link_{index - 1}", f"link_{index}", "0 0 0.0305", lower=-1, upper=1)
            joint.find("limit").set("effort", f"{2 + index / 10:.6g}")
            joint.find("limit").set("velocity", f"{1 + index / 10:.6g}")
            root.append(joint)
    return defects.write(root, folder)


def test_a_robot_of_fifty_links_takes_less_than_twenty_seconds(tmp_path: Path) -> None:
    """Of the processor: other programs must not make this test fail. The budget counts work, which a busy machine does as well, but later."""
    path = chain(tmp_path)
    before, start = spent(), time.monotonic()

    found = audit_file(path)

    assert (found.links, found.joints) == (50, 49)
    assert not [finding for finding in found.findings if finding.code != "W_AUDIT_NOT_CHECKED"]
    assert spent() - before < LONGEST_FIFTY_S
    assert time.monotonic() - start < 10 * LONGEST_FIFTY_S


# ---------------------------------------------------------------------- worked out by hand


class Drawn(NamedTuple):
    """A finding that was drawn at random, with the number that was worked out by other means."""

    file: str
    code: str
    part: str
    value: float
    tolerance: float = 1e-3
    unit: str | None = None


DRAWN = [
    Drawn("mini_cheetah/mini_cheetah.urdf", "E_STATIC_OVERLAP", "abduct_fl", 139.712 - 135.514, 0.01, "mm"),
    Drawn("racecar/racecar_differential.urdf", "I_AUDIT_BASE", "right_rear_wheel", 50.0, unit="mm"),
    Drawn("quadruped/spirit40.urdf", "W_AUDIT_ENDLESS", "", 720.0, unit="deg"),
    Drawn("cartpole.urdf", "W_AUDIT_NO_COLLISION", "slideBar", 1),
    Drawn("aliengo/aliengo.urdf", "I_AUDIT_BASE", "FL_toe", 526.5, unit="mm"),
    Drawn("aliengo/aliengo.urdf", "W_AUDIT_INERTIA_SHAPE", "imu_link", 1e-4, unit="kg·m²"),
    Drawn("cube_no_rotation.urdf", "W_AUDIT_DENSITY", "baseLink", 0.1, unit="kg/m³"),
    Drawn("cube_no_rotation.urdf", "W_AUDIT_NO_EFFORT", "", 4),
    Drawn("teddy_large.urdf", "W_AUDIT_COM", "baseLink", 983.44, unit="mm"),
    Drawn("kuka_iiwa/model_free_base.urdf", "W_AUDIT_MESH_OPEN", "lbr_iiwa_link_6", 21, unit="edges"),
    Drawn("laikago/laikago_toes.urdf", "I_AUDIT_UNFUSED", "FR_upper_leg", 2, unit="bodies"),
    Drawn("mjcf/thrower.xml", "W_AUDIT_DENSITY", "shoulder_lift_link", 1e-4, 0.03, "kg/m³"),
    Drawn("quadruped/minitaur_rainbow_dash_v1.urdf", "E_NOT_TOUCHING", "chassis_right", 53.5, unit="mm"),
]
MENDED = [  # false alarms that were drawn
    ("mjcf/pusher.xml", "W_AUDIT_PIECES", "fingertip"),
    ("quadruped/minitaur.urdf", "W_AUDIT_PIECES", "chassis_left"),
    ("humanoid/humanoid.urdf", "E_FLOATING", "chest"),
]


def told(file: str, code: str, part: str) -> list[Finding]:
    """The findings about a file at rest."""
    found = audit_file(ROOT / file, AuditOptions(root=ROOT, engines=file.endswith(".xml"), budget=0.0)).findings.of(code)
    return [finding for finding in found if not part or part in finding.parts]


@pytest.mark.corpus
@pytest.mark.parametrize("drawn", DRAWN, ids=lambda drawn: f"{drawn.file}-{drawn.code}")
def test_a_number_is_what_was_worked_out_by_hand(drawn: Drawn) -> None:
    found = told(drawn.file, drawn.code, drawn.part)

    assert any(finding.value == pytest.approx(drawn.value, rel=drawn.tolerance) for finding in found), [finding.value for finding in found]
    assert {finding.unit for finding in found} == {drawn.unit}


@pytest.mark.corpus
@pytest.mark.parametrize(("file", "code", "part"), MENDED)
def test_a_false_alarm_does_not_come_back(file: str, code: str, part: str) -> None:
    assert not told(file, code, part)
