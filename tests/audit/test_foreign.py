"""Models that nobody here made: audits come to an end, in bounded time and memory, and say nothing that cannot be counter-checked.

The numbers of `DRAWN` were worked out by hand; docs/reference/audit.md says how.
"""

from __future__ import annotations

import json
import resource
import time
from pathlib import Path
from typing import Any

import pytest
from lxml import etree

from articad.audit.examine import Choices, audit
from articad.codes import CODES
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
    found = audit(path, Choices(root=ROOT))

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
    """Of the processor: other programs must not make this test fail. The clock's time is bounded by the budget's patience."""
    path = chain(tmp_path)
    before, start = spent(), time.monotonic()

    found = audit(path)

    assert (found.links, found.joints) == (50, 49)
    assert not [finding for finding in found.findings if finding.code != "W_AUDIT_NOT_CHECKED"]
    assert spent() - before < LONGEST_FIFTY_S
    assert time.monotonic() - start < 10 * LONGEST_FIFTY_S
