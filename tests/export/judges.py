"""Outside judges of the examples' exports, and the table of what they say.

python -m venv DIR; DIR/bin/pip install -r tests/export/judges.lock
ARTICAD_ENGINES=DIR/bin/python .venv/bin/python -m tests.export.judges [EXAMPLE …]

runs MuJoCo, PyBullet, Newton, Pinocchio, simcheck, check_urdf and the validator of USD on the exports of each example, keeps what they say in
docs/reference/simulators.json, and writes docs/reference/simulators.md.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Container, Mapping
from pathlib import Path
from typing import Any, Final, NamedTuple

from articad import examples
from articad.assembly import Assembly
from articad.entry import read
from articad.export.lowering import lower
from articad.export.mjcf import write_mjcf
from articad.export.urdf import write_urdf
from articad.export.usd import write_usd
from articad.simulation.examine import driving, simulate_file
from articad.simulation.expected import held_to_kinematics
from articad.simulation.loading import load
from articad.simulation.trial import try_out
from articad.simulation.verdict import EngineOutcome, SimulationVerdict

ROOT: Final = Path(__file__).resolve().parents[2]
RECORD: Final = ROOT / "docs" / "reference" / "simulators.json"
PAGE: Final = RECORD.with_suffix(".md")
PYTHON: Final = os.environ.get("ARTICAD_ENGINES", "")
SECONDS: Final = 900.0
ARGUED: Final = {
    "UsdAsciiPerformanceChecker": "USD is written as text, which can be read, compared and kept in Git; `usdcat -o x.usdc x.usda` packs it",
}
"""Requirements that exports do not meet on purpose, and why."""


class Said(NamedTuple):
    """What a judge says.

    Attributes:
        passed: Whether it has no objection; None where the format cannot express what would be judged.
        words: For the table.
    """

    passed: bool | None
    words: str


SITES: Final = Said(None, "not judged: Newton's reader drops the second site of a connect")


def folder_of(name: str) -> Path:
    """Return the plan folder or the recorded run of an example."""
    return examples.folder(name) if name in examples.names() else ROOT / "examples" / name / "recording"


def example_names() -> list[str]:
    """Return the names of all examples, those that are recorded runs only as well."""
    return sorted(path.name for path in (ROOT / "examples").iterdir() if (path / "plan.json").exists() or (path / "recording").exists())


def exported(assembly: Assembly, folder: Path) -> dict[str, Path]:
    """Write an assembly in the formats of simulators and return the main files."""
    writers: dict[str, Callable[[Assembly], Any]] = {"mjcf": write_mjcf, "urdf": write_urdf, "usd": write_usd}
    found = {}
    for kind, write in writers.items():
        bundle = write(assembly)
        bundle.write(folder / kind)
        found[kind] = folder / kind / bundle.main
    return found


def judged(assembly: Assembly, files: Mapping[str, Path], without: Container[str] = ()) -> dict[str, Said]:
    """Ask every judge about the exports of an assembly, but those whose names are given."""
    opened = bool(assembly.mechanism.loop_joints)
    judges: dict[str, Callable[[], Said]] = {
        "MuJoCo mjcf": lambda: _verdict(held_to_kinematics(assembly, try_out("mujoco", files["mjcf"], drivers=driving(assembly)))),
        "MuJoCo urdf": lambda: _verdict(*simulate_file(files["urdf"], engines=("mujoco",)).outcomes),
        "PyBullet mjcf": lambda: _verdict(*simulate_file(files["mjcf"], engines=("pybullet",)).outcomes),
        "PyBullet urdf": lambda: _verdict(*simulate_file(files["urdf"], engines=("pybullet",)).outcomes),
        "Newton mjcf": lambda: SITES if opened else _verdict(held_to_kinematics(assembly, newton(assembly, files["mjcf"]))),
        "Newton urdf": lambda: _verdict(newton(assembly, files["urdf"])),
        "Newton usd": lambda: _verdict(held_to_kinematics(assembly, newton(assembly, files["usd"]))),
        "Pinocchio urdf": lambda: _loads(files["urdf"]),
        "check_urdf urdf": lambda: check_urdf(files["urdf"]),
        "simcheck mjcf": lambda: simcheck(files["mjcf"]),
        "simcheck urdf": lambda: simcheck(files["urdf"], opened=opened),
        "USD validator usd": lambda: usd_validator(files["usd"]),
    }
    return {name: judge() for name, judge in judges.items() if name.split()[0] not in without}


def _verdict(outcome: EngineOutcome) -> Said:
    """Return the words of a simulation: how far the joints come that are driven, what was left open, what is wrong."""
    findings = SimulationVerdict("", (outcome,)).findings
    reaches = outcome.judged
    least = 100 * min((reach.share for reach in reaches), default=1.0)
    words = f"{least:.4g} % of {len(reaches)}" if reaches else "stands"
    if outcome.loads is None:
        return Said(None, "not installed")
    if not findings.ok:
        return Said(passed=False, words="; ".join(finding.message for finding in findings if finding.code.startswith("E_")))
    if outcome.passed_over:
        return Said(passed=None if not reaches else True, words=f"{words}; {len(outcome.passed_over)} of open loops not driven")
    notes = ["loops open"] if outcome.open_loops else []
    return Said(passed=True, words=", ".join([words, *notes, *([outcome.message] if outcome.message else [])]))


def newton(assembly: Assembly, path: Path) -> EngineOutcome:
    """Drive an export in Newton."""
    model = lower(assembly)
    joints = (*model.joints, *model.loops)
    freedoms = [freedom for joint in joints for freedom in joint.freedoms]
    loops = {joint.name for joint in assembly.mechanism.loop_joints}
    for loop in assembly.mechanism.loop_joints:
        loops |= {joint.name for joint in assembly.mechanism.tree.joints_between(loop.parent, loop.child)}
    following = {freedom.name for joint in joints if joint.joint.name in loops for freedom in joint.freedoms}
    kinds = {freedom.name: freedom.kind for freedom in freedoms}
    ties = [(freedom.name, freedom.follows.leader, False) for freedom in freedoms if freedom.follows is not None]
    ties += [(name, follows.leader, True) for _, name, follows in model.couplings]
    if path.suffix == ".usda":  # NewtonMimicAPI couples joints of one kind only, which the export states as a loss
        ties = [tie for tie in ties if kinds[tie[0]] == kinds[tie[1]]]
    coupled = {name for name, _, _ in ties} | {leader for _, leader, looped in ties if looped}
    drivers = driving(assembly)
    opened: set[str] = set()
    if path.suffix == ".urdf" and loops:  # a URDF leaves loops open, and what is coupled with their joints
        opened = following | coupled
    told = {
        "rest": {freedom.name: freedom.rest for freedom in freedoms},
        "drivers": None if opened else drivers,
        "following": sorted((following | coupled) - set(drivers) - opened),
        "opened": sorted(opened),
    }
    done = _run([PYTHON, "-W", "ignore", str(Path(__file__).with_name("newton_trial.py")), str(path), json.dumps(told)])
    lines = [line for line in done.stdout.splitlines() if line.startswith("{")]
    if done.returncode or not lines:
        return EngineOutcome("newton", loads=False, message=done.stderr[-300:])
    outcome = EngineOutcome.from_json(json.loads(lines[-1]))
    outcome.open_loops = len(assembly.mechanism.loop_joints) if opened else 0
    return outcome


def _loads(path: Path) -> Said:
    loading = load("pinocchio", path)
    return Said(loading.loads, "loads" if loading.loads else loading.message)


def check_urdf(path: Path) -> Said:
    """Ask the parser of ROS."""
    program = shutil.which("check_urdf")
    if program is None:
        return Said(None, "not installed")
    done = _run([program, str(path)])
    return Said(done.returncode == 0, "accepts" if done.returncode == 0 else done.stderr[-200:])


def simcheck(path: Path, *, opened: bool = False) -> Said:
    """Return the number of errors that simcheck counts, those apart that an open loop causes at zero.

    Args:
        path: A URDF or MJCF file.
        opened: Whether the file leaves closed loops out.
    """
    command = [PYTHON, "-m", "simcheck", "check", "-j", "1", "--no-config", "--no-cache", "--format", "json", str(path)]
    (report,) = json.loads(_run(command).stdout)
    counts = report["counts"]
    wrong = [row for result in report["results"] for row in result["findings"] if row["severity"] == "error"]
    words = f"{counts['error']} errors, {counts['warning']} warnings"
    if wrong and opened and all(row["check"] == "engine.rest_contacts" for row in wrong):
        return Said(None, f"{words}: contacts at zero, where the loops that URDF leaves out do not close")
    return Said(not wrong, words if not wrong else f"{words}: {wrong[0]['message']}")


def usd_validator(path: Path) -> Said:
    """Ask the rules of usdchecker and their extensions in the asset validator."""
    module = "omni.asset_validator"
    program = str(Path(PYTHON).with_name("omni_asset_validate"))
    done = _run([program, str(path)])
    rows = [line for line in (done.stdout + done.stderr).splitlines() if line.startswith(("ERROR", "WARNING")) and module in line]
    names = [line.partition("[")[2].partition("]")[0] for line in rows]
    failed = [line for line, name in zip(rows, names, strict=True) if name not in ARGUED]
    argued = sorted({name for name in names if name in ARGUED})
    if failed:
        return Said(passed=False, words=f"{len(failed)} failures: {failed[0][:200]}")
    return Said(passed=True, words="0 failures" + (f" but {', '.join(argued)}" if argued else ""))


def _run(command: list[str]) -> subprocess.CompletedProcess[str]:
    environment = os.environ | {"PYTHONPATH": str(ROOT), "OPENBLAS_NUM_THREADS": "1"}
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=SECONDS, env=environment)


# ---------------------------------------------------------------------- the table

SIMULATORS: Final = ("MuJoCo", "PyBullet", "Newton")
OTHERS: Final = ("simcheck mjcf", "simcheck urdf", "check_urdf urdf", "Pinocchio urdf", "USD validator usd")

_HEAD = """# What simulators and validators say about the examples

Written by `python -m tests.export.judges`, which exports the examples with default settings and runs the judges on the files. Versions are
those of `tests/export/judges.lock` and `requirements.lock`.

"100 % of 4" means: 4 joints were driven, and the one that covered the smallest share of its range covered 100 %. The range of a follower in a loop is
the one that kinematics computes for it. `articad sim` requires 99 %.

- *loops open*: URDF has no closed loops, and PyBullet leaves out the equality constraints of MJCF. "3 of open loops not driven" counts the joints whose motion
  such a loop would determine.
- Newton runs its MuJoCo solver on the processor. Its readers, mimics, loops and contacts are its own. Newton 1.8 closes a loop correctly
  only if it is closed where all joints are zero. From USD it reads both frames of a loop joint, but its solver computes the anchor on the
  child from the poses at zero (newton-physics/newton, issue 2293 and pull request 4248). *Anchors of loops corrected* means: the judge
  restored the anchors that Newton had read; otherwise, the loop is a different mechanism. From MJCF, Newton's reader drops the position of
  the second site of a `connect`, so that file is not judged.
- An empty cell, or an example that is not listed, was not judged.
- PyBullet does not collide parts of one body unless it is asked to, so its rows do not test collision shapes.
"""


def page(record: Mapping[str, Mapping[str, Any]]) -> str:
    """Return the page for what judges said, by example and judge."""
    lines = [_HEAD, "## Simulators", "", "| example | file | " + " | ".join(SIMULATORS) + " |", "|---" * (2 + len(SIMULATORS)) + "|"]
    for name, said in sorted(record.items()):
        for kind in ("mjcf", "urdf", "usd"):
            cells = [_cell(said.get(f"{engine} {kind}")) for engine in SIMULATORS]
            lines.append(f"| {name} | {kind} | " + " | ".join(cells) + " |")
    lines += ["", "## Checkers and validators", "", "| example | " + " | ".join(OTHERS) + " |", "|---" * (1 + len(OTHERS)) + "|"]
    lines += [f"| {name} | " + " | ".join(_cell(said.get(judge)) for judge in OTHERS) + " |" for name, said in sorted(record.items())]
    lines += ["", "## Requirements that are not met, and why", ""]
    lines += [f"- `{name}`: {reason}." for name, reason in ARGUED.items()]
    lines.append(
        "- simcheck's `engine.rest_contacts` on URDFs of closed loops: simcheck uses zero as the rest pose. A loop need not close where all "
        "joints are zero, and URDF has no other pose. The MJCF of the same model rests at its key `home`."
    )
    return "\n".join(lines) + "\n"


def _cell(said: Mapping[str, Any] | None) -> str:
    if said is None:
        return ""
    mark = {True: "", None: "", False: "**fails**: "}[said["passed"]]
    return mark + str(said["words"]).replace("|", "/").replace("\n", " ")


def main(words: list[str]) -> int:
    """Judge examples, keep the record and write the page; `--without NAME` leaves a judge out."""
    without = {words[at + 1] for at, word in enumerate(words) if word == "--without"}
    names = [word for at, word in enumerate(words) if word != "--without" and (at == 0 or words[at - 1] != "--without")]
    for name in names or example_names():
        with tempfile.TemporaryDirectory() as folder:
            assembly = read(folder_of(name))
            said = judged(assembly, exported(assembly, Path(folder)), without)
        record: dict[str, Any] = json.loads(RECORD.read_text()) if RECORD.exists() else {}
        record[name] = record.get(name, {}) | {judge: one._asdict() for judge, one in said.items()}
        print(name, {judge: one.words for judge, one in said.items()}, flush=True)  # noqa: T201 - a command
        RECORD.write_text(json.dumps(record, indent=1, sort_keys=True) + "\n")
        PAGE.write_text(page(record))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
