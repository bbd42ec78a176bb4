"""Runs the stages of ./scripts/test: each timed, all run even if one fails, one table, one line at the end."""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as ET
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parent.parent
PYTHON = sys.executable
ENVIRONMENT = os.environ | {
    "PYTHONPATH": str(ROOT),
    "NO_MKDOCS_2_WARNING": "1",
    "OPENBLAS_NUM_THREADS": "1",  # several processes test at a time, and its threads wait by turning
}


class Outcome(NamedTuple):
    """How a stage ended: what it counted, and what it printed if that is worth showing."""

    passed: int
    failed: int
    skipped: int = 0


def _command(*arguments: str) -> Callable[[], Outcome]:
    """Return a stage that counts as one check: it passes when the command exits 0."""

    def run() -> Outcome:
        done = subprocess.run([PYTHON, *arguments], cwd=ROOT, env=ENVIRONMENT, check=False)
        return Outcome(1, 0) if done.returncode == 0 else Outcome(0, 1)

    return run


def _cache() -> Path:
    """Return a folder for built parts that only tests of these sources use: one that others filled would hide what these build."""
    digest = hashlib.sha256()
    for path in sorted((ROOT / "articad").rglob("*.py")):
        digest.update(path.read_bytes())
    folder = ROOT / "build" / f"cache-{digest.hexdigest()[:16]}"
    for other in folder.parent.glob("cache-*"):
        if other != folder:
            shutil.rmtree(other)
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def _tests(*more: str) -> Outcome:
    """Run pytest and count its tests; a run that broke off, or ran none, counts as one failure more."""
    jobs = os.environ.get("ARTICAD_TEST_JOBS", "2")
    with tempfile.TemporaryDirectory() as folder:
        report = Path(os.environ.get("ARTICAD_TEST_REPORT", Path(folder, "report.xml")))
        selection = ["-m", "not crash and not fuzz and not supply and not corpus and not soak and not engines_all and not freecad_next"]
        options = ["-q", "-n", jobs, "--durations=60", "--hypothesis-profile=ci", f"--junit-xml={report}", *more]
        environment = ENVIRONMENT | {"ARTICAD_CACHE": str(_cache())}
        done = subprocess.run([PYTHON, "-m", "pytest", *selection, *options], cwd=ROOT, env=environment, check=False)
        if not report.is_file():
            return Outcome(0, 1)
        # Our own pytest wrote this file a moment ago.
        suites = list(ET.parse(report).getroot().iter("testsuite"))  # noqa: S314
    total, errors, failures, skipped = (
        sum(int(suite.get(key, "0")) for suite in suites) for key in ("tests", "errors", "failures", "skipped")
    )
    failed = errors + failures
    if done.returncode != 0 and failed == 0:
        failed = 1
    return Outcome(max(0, total - errors - failures - skipped), failed, skipped)


def _viewer() -> Outcome:
    """Build the page's script from its sources, compare it with the one that is committed, and look for barriers with axe-core."""
    npm = shutil.which("npm")
    if npm is None:
        print("skipped: npm is missing; as root, apt-get install nodejs npm")
        return Outcome(0, 0, 1)
    report = ROOT / "articad" / "report"
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder, "viewer")
        shutil.copytree(report / "viewer", copy, ignore=shutil.ignore_patterns("node_modules"))
        for command in (["npm", "ci", "--no-audit", "--no-fund"], ["node", "build.mjs", folder]):
            done = subprocess.run(command, cwd=copy, check=False, capture_output=True, text=True)
            if done.returncode != 0:
                print(done.stdout, done.stderr)
                return Outcome(0, 1)
        different = [name for name in ("viewer.js", "viewer.css") if Path(folder, name).read_bytes() != (report / name).read_bytes()]
        barriers = [PYTHON, "-m", "pytest", "-q", "-p", "no:xdist", "tests/report/test_controls.py", "-k", "axe"]
        environment = ENVIRONMENT | {"ARTICAD_AXE": str(copy / "node_modules" / "axe-core" / "axe.min.js")}
        free = subprocess.run(barriers, cwd=ROOT, env=environment, check=False).returncode == 0
    if different:
        print(f"{', '.join(different)}: not what the sources give; cd articad/report/viewer && npm ci && npm run build")
    return Outcome(2 - len(different) + free, len(different) + (not free))


def _bill() -> Outcome:
    """Write the bill of materials of the lock, twice; CI keeps the file that ARTICAD_SBOM names."""
    with tempfile.TemporaryDirectory() as folder:
        files = [Path(os.environ.get("ARTICAD_SBOM", Path(folder, "articad.cdx.json"))).absolute(), Path(folder, "again.cdx.json")]
        for file in files:
            if subprocess.run([PYTHON, "scripts/sbom", str(file)], cwd=ROOT, env=ENVIRONMENT, check=False).returncode != 0:
                return Outcome(0, 1)
        equal = files[0].read_bytes() == files[1].read_bytes()
    if not equal:
        print("scripts/sbom: the same lock gives different bytes")
    return Outcome(int(equal), int(not equal))


STAGES: dict[str, Callable[[], Outcome]] = {
    "ruff": _command("-m", "ruff", "check", "."),
    "format": _command("-m", "ruff", "format", "--check", "."),
    "mypy": _command("-m", "mypy"),
    "imports": _command("-c", "import sys; from importlinter.cli import lint_imports_command; sys.exit(lint_imports_command())"),
    "packages": _command("-m", "pip", "--disable-pip-version-check", "check"),
    "bill": _bill,
    "viewer": _viewer,
    "tests": _tests,
    "tables": _command("scripts/tables.py", "--check"),
    "docs": _command("-m", "mkdocs", "build", "--strict", "--quiet"),
}


FAST: dict[str, Callable[[], Outcome]] = {name: STAGES[name] for name in ("ruff", "format", "imports")}
FAST["fast"] = lambda: _tests("--fast")
"""What `./scripts/test fast` runs: every layer, without the tests that `tests/slow.txt` lists."""


def main(names: list[str]) -> int:
    """Run the named stages, or all; return 0 when nothing failed."""
    stages = STAGES | FAST
    names = list(FAST) if names == ["fast"] else names
    unknown = [name for name in names if name not in stages]
    if unknown:
        print(f"unknown stage {', '.join(unknown)}; there are {', '.join(STAGES)}", file=sys.stderr)
        return 2
    rows: list[tuple[str, Outcome, float]] = []
    for name in names or STAGES:
        print(f"--- {name}", flush=True)
        start = time.monotonic()
        outcome = stages[name]()
        rows.append((name, outcome, time.monotonic() - start))
    print(f"\n{'stage':<10} {'passed':>7} {'failed':>7} {'skipped':>8} {'seconds':>8}")
    for name, outcome, seconds in rows:
        print(f"{name:<10} {outcome.passed:>7} {outcome.failed:>7} {outcome.skipped:>8} {seconds:>8.1f}")
    passed, failed = (sum(getattr(outcome, key) for _, outcome, _ in rows) for key in ("passed", "failed"))
    print(f"{'all':<10} {passed:>7} {failed:>7} {sum(o.skipped for _, o, _ in rows):>8} {sum(s for *_, s in rows):>8.1f}\n")
    print(f"{passed} passed, {failed} failed", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
