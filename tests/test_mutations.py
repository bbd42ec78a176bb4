"""Mistakes of sign and order in the mate relation, reversal and mirror, each written into a copy of the source: the laws must see it.

Those of lowering are in `tests/export/test_mutations.py`.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pytest

ROOT = Path(__file__).resolve().parents[1]
TESTS_FAILED = 1  # pytest's exit code; a mutation that does not even import ends with another

pytestmark = pytest.mark.slow


class Mutation(NamedTuple):
    """A change of one line, and the tests that hold it."""

    file: str
    right: str
    wrong: str
    tests: str


MATE, JOINTS, CONNECTOR = "articad/connectors/mate.py", "articad/kinematics/joints.py", "articad/connectors/connector.py"
RELATION, LAWS = "tests/connectors/test_connector.py", "tests/kinematics/test_joints.py"

MUTATIONS = {
    "the child's connector is not inverted": Mutation(
        MATE, "return T_parent @ C_p @ motion @ flip(mate) @ C_c.inverse()", "return T_parent @ C_p @ motion @ flip(mate) @ C_c", RELATION
    ),
    "the flip comes before the motion": Mutation(
        MATE,
        "return T_parent @ C_p @ motion @ flip(mate) @ C_c.inverse()",
        "return T_parent @ C_p @ flip(mate) @ motion @ C_c.inverse()",
        RELATION,
    ),
    "an opposed mate is taken for an aligned one": Mutation(
        MATE, "return FLIP if mate == Mate.OPPOSED", "return FLIP if mate is None", RELATION
    ),
    "the parent's pose is not the inverse relation": Mutation(
        MATE,
        "return T_child @ (C_p @ motion @ flip(mate) @ C_c.inverse()).inverse()",
        "return T_child @ (C_p @ motion @ flip(mate) @ C_c.inverse())",
        RELATION,
    ),
    "the flip turns about z": Mutation(MATE, "[1.0, 0.0, 0.0, 0.0]", "[0.0, 0.0, 1.0, 0.0]", RELATION),
    "a reversed joint keeps its connectors": Mutation(
        JOINTS, "T_parent_connector=self.T_child_connector,", "T_parent_connector=self.T_parent_connector,", LAWS
    ),
    "a reversed joint keeps its coordinates' signs": Mutation(
        JOINTS, "signs = self.type.reversal_signs(self.mate)", "signs = abs(self.type.reversal_signs(self.mate))", LAWS
    ),
    "reversal takes one mate for the other": Mutation(
        JOINTS,
        "_KINDS[self].reverse_opposed if mate == Mate.OPPOSED else _KINDS[self].reverse",
        "_KINDS[self].reverse if mate == Mate.OPPOSED else _KINDS[self].reverse_opposed",
        LAWS,
    ),
    "a mirrored connector's z is turned over instead of its y": Mutation(
        CONNECTOR, "np.diag([1.0, -1.0, 1.0, 1.0])", "np.diag([1.0, 1.0, -1.0, 1.0])", RELATION
    ),
    "a mirrored joint keeps its coordinates' signs": Mutation(
        JOINTS, "signs = self.type.mirror_signs()", "signs = abs(self.type.mirror_signs())", LAWS
    ),
    "a mirrored screw keeps its hand": Mutation(JOINTS, "lead=-self.lead + 0.0", "lead=self.lead", LAWS),
    "a screw advances by its lead per radian": Mutation(JOINTS, "value = lead / (2 * math.pi) * value", "value = lead * value", LAWS),
    "a universal joint turns about y first": Mutation(
        JOINTS, "T = moved if T is None else T @ moved", "T = moved if T is None else moved @ T", LAWS
    ),
}


@pytest.mark.parametrize("name", MUTATIONS)
def test_the_laws_see_the_mistake(name: str, tmp_path: Path) -> None:
    mutation = MUTATIONS[name]
    shutil.copytree(ROOT / "articad", tmp_path / "articad", ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copytree(ROOT / "tests", tmp_path / "tests", ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    source = tmp_path / mutation.file
    text = source.read_text()
    assert text.count(mutation.right) == 1, "the line that is to be changed is no longer there"
    source.write_text(text.replace(mutation.right, mutation.wrong))

    command = [sys.executable, "-m", "pytest", "-x", "-q", "--hypothesis-profile=ci", mutation.tests]
    environment = {**os.environ, "PYTHONPATH": str(tmp_path), "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=300, check=False)

    assert done.returncode == TESTS_FAILED, done.stdout[-2000:]
