"""Every robot in the packages that ship robots: posed as its engine poses it, and the same again after a round trip.

The packages are gigabytes, so they are no dependency: `scripts/corpus` fetches and unpacks them, and runs this.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import subprocess
import sys
from collections import Counter
from pathlib import Path
from typing import Any

import pytest

from articad.errors import ReadError
from tests.differences import examine, page
from tests.foreign import TOLERANCE, assert_survives, configurations, difference, oracle_of, read

ROOT = Path(os.environ.get("ARTICAD_CORPUS", "/nonexistent"))
LARGEST_TAKEN_ROUND = 80  # links: an export of more takes a minute of looking for contacts, and shows nothing new
REFUSED_SHARE = 0.15

REFUSED = {  # besides MJCF that MuJoCo itself refuses, because it is a piece of another file or its meshes are not there
    "romeo_laas_small.urdf": "leads out of",  # names meshes by an absolute path of somebody's machine
    "ur3.urdf": "has no name",
    "finger_macro.urdf": "has no name",  # nothing is in it
    "trifinger_stage.urdf": "Its link 'base_link' is not in the file",
    "trifingeredu_stage.urdf": "Its link 'base_link' is not in the file",
}


def models() -> list[Path]:
    """URDF files, and MJCF files that are a model: with bodies, and no piece that others include; ten of PyBullet's 1,000 random objects."""
    found = [path for path in ROOT.rglob("*.urdf") if "random_urdfs" not in path.parts or re.fullmatch(r"00\d", path.stem)]
    for path in ROOT.rglob("*.xml"):
        text = path.read_text(errors="replace")
        root = re.search(r"<(\w+)[\s>]", re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL))
        if root is not None and root[1] == "mujoco" and "<worldbody" in text:
            found.append(path)
    return sorted(found)


pytestmark = [pytest.mark.corpus, pytest.mark.skipif(not ROOT.is_dir(), reason="scripts/corpus fetches the packages")]
MODELS = models() if ROOT.is_dir() else []
PAGE = Path(__file__).parents[2] / "docs/reference/conversions.md"
refused: dict[str, str] = {}


APART = {
    "agents",
    "auditing",
    "batches",
    "cli",
    "commands",
    "examples",
    "mcp",
    "memory",
    "render",
    "report",
    "runs",
    "simulation",
    "starter",
}
"""Rooms that no conversion imports."""


def results_file() -> Path:
    """Return the file with the results of this code: results of other code would prove nothing."""
    top = Path(__file__).parents[2]
    digest = hashlib.sha256()
    code = [path for path in top.glob("articad/**/*.py") if path.relative_to(top / "articad").parts[0].removesuffix(".py") not in APART]
    for path in sorted([*code, top / "tests/differences.py"]):
        digest.update(path.read_bytes())
    return ROOT.parent / f"{ROOT.name}.results" / f"{digest.hexdigest()[:16]}.jsonl"


def results() -> dict[tuple[str, str, str], dict[str, Any]]:
    """Return what has been found, by package, path below it and target."""
    if not RESULTS.is_file():
        return {}
    rows = map(json.loads, RESULTS.read_text().splitlines())
    return {(row["package"], row["path"], row["target"]): row for row in rows}


RESULTS = results_file() if ROOT.is_dir() else Path()
BEFORE = results()


@pytest.mark.parametrize("path", MODELS, ids=lambda path: str(path.relative_to(ROOT)))
def test_a_robot_is_posed_as_its_engine_poses_it_and_comes_back(path: Path, tmp_path: Path) -> None:
    package = ROOT / path.relative_to(ROOT).parts[0]
    try:
        assembly = read(path, package)
    except ReadError as error:
        refused[str(path)] = str(error)
        if REFUSED.get(path.name, "MuJoCo refuses it") not in str(error):
            raise
        return
    q = configurations(assembly, 2)
    for row in q:
        assert difference(assembly, row, oracle_of(path)(assembly, path, row)) < TOLERANCE
    if len(assembly.parts) <= LARGEST_TAKEN_ROUND:
        assert_survives(assembly, tmp_path, q)


@pytest.mark.parametrize("target", ["urdf", "mjcf"])
@pytest.mark.parametrize("path", MODELS, ids=lambda path: str(path.relative_to(ROOT)))
def test_no_difference_of_a_conversion_is_silent(path: Path, target: str, tmp_path: Path) -> None:
    package, *below = path.relative_to(ROOT).parts
    key = (package, "/".join(below), target)
    result = BEFORE.get(key)
    if result is None:
        result = examine(path, target, tmp_path, ROOT / package)
        result |= {"package": package, "path": key[1], "origin": "urdf" if path.suffix == ".urdf" else "mjcf", "target": target}
        RESULTS.parent.mkdir(exist_ok=True)
        with RESULTS.open("a") as file:
            file.write(json.dumps(result) + "\n")

    assert "copy refused" not in result, result
    assert result.get("silent", []) == []
    assert result.get("free", []) == []


def test_no_conversion_imports_a_room_that_the_digest_leaves_out(tmp_path: Path) -> None:
    body = '<worldbody><body name="a"><joint name="j"/><geom size="1"/></body></worldbody>'
    (tmp_path / "a.xml").write_text(f"<mujoco>{body}</mujoco>")
    code = "import sys; from pathlib import Path; from tests.differences import examine; path = Path(sys.argv[1])\n"
    code += "for target in ('urdf', 'mjcf'): assert not examine(path, target, path.parent / target, path.parent)['silent']\n"
    code += "print(*{name.split('.')[1] for name in sys.modules if name.startswith('articad.')})"
    command = [sys.executable, "-c", code, str(tmp_path / "a.xml")]
    imported = subprocess.run(command, cwd=Path(__file__).parents[2], check=True, capture_output=True, text=True).stdout.split()

    assert {"importers", "export"} <= set(imported)
    assert not APART & set(imported)


def test_the_page_of_conversions_says_what_was_found() -> None:
    """With ARTICAD_CORPUS_WRITE=1 it is written."""
    found = results()
    if len(found) < 2 * len(MODELS):
        pytest.skip("only after all models")
    files = Counter((path.relative_to(ROOT).parts[0], "urdf" if path.suffix == ".urdf" else "mjcf") for path in MODELS)
    text = page(found.values(), files)
    if os.environ.get("ARTICAD_CORPUS_WRITE") == "1":
        PAGE.write_text(text)
    assert PAGE.read_text() == text


def test_few_are_refused() -> None:
    for path, reason in refused.items():
        print(f"refused {path}: {reason.splitlines()[0]}")  # noqa: T201 - each by name, with -s
    assert len(MODELS) >= 60
    assert len(refused) <= REFUSED_SHARE * len(MODELS)
