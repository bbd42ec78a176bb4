"""Outside judges of exports, and the table of what they say of the examples and of the references of the benchmark's hard tasks.

python -m venv DIR; DIR/bin/pip install -r tests/export/judges.lock
python -m venv OTHER; OTHER/bin/pip install -r tests/export/simready.lock
ARTICAD_ENGINES=DIR/bin/python ARTICAD_SIMREADY=OTHER/bin/python .venv/bin/python -m tests.export.judges [NAME …] [--without JUDGE] [--only JUDGE] [--again]

runs MuJoCo, PyBullet, Newton, Pinocchio, simcheck, check_urdf and the validators of USD and SimReady on the exports of each model, keeps what they say in
docs/reference/simulators.json, and writes docs/reference/simulators.md and the table of README. Each answer is kept with a digest of the files and one of the judge (its
program here, and its version). A judge that has judged the same files is not asked again, unless it has changed or `--again` is given. With `--check`, no judge is
asked: the command lists the answers that are not about the present files by the present judges, and fails if there are any.
"""

from __future__ import annotations

import ast
import fcntl
import hashlib
import inspect
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable, Mapping
from functools import cache
from importlib.metadata import version
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
from articad.simulation.verdict import CALM, DRIFT, GROWTH, RESIDUAL, SHARE, EngineOutcome, SimulationVerdict
from articad_bench.reference import reference_folder
from articad_bench.task import tasks_in

ROOT: Final = Path(__file__).resolve().parents[2]
RECORD: Final = ROOT / "docs" / "reference" / "simulators.json"
PAGE: Final = RECORD.with_suffix(".md")
README: Final = ROOT / "README.md"
MARKS: Final = ("<!-- simulators: written by tests.export.judges -->", "<!-- end of simulators -->")
PYTHON: Final = os.environ.get("ARTICAD_ENGINES", "")
SIMREADY: Final = os.environ.get("ARTICAD_SIMREADY", "")  # its rules would join those of the USD validator in one environment
SECONDS: Final = 900.0
HANG_SECONDS: Final = 14400.0  # of Newton, which bounds its own processor time
PROFILE: Final = ("Robotics-Prop", "4.0.0")  # of SimReady Foundation
ARGUED: Final = {
    "UsdAsciiPerformanceChecker": "USD is written as text, which can be read, compared and kept in Git; `usdcat -o x.usdc x.usda` packs it",
    "SR.002": "a thumbnail is a picture for a catalogue of assets, not a property of the model",
    "SR.004": "an author, a licence and a Wikidata code cannot be derived from a model. Who publishes it adds them in `NAME.json` beside the file",
}
"""Requirements that exports do not meet on purpose, and why."""
OPTIONAL: Final = {
    "NP.006, SR.001": "the provenance of SR.004 in earlier forms",
    "RV.001, RV.004, RV.007": "a variant for each of PhysX, Newton and MuJoCo: the file has one set of prims, which is valid for each of them",
    "MUJOCO.COL.001": "MuJoCo's own schema: MuJoCo loads the MJCF",
    "VM.MDL.003, VM.PBR.001": "MDL and OpenPBR materials: the file has UsdPreviewSurface, which is required",
    "NVM.001, NVM.002, NVM.003": "materials for lidar and radar, which a model does not state",
    "GSP.001": "where a gripper takes hold, which a model does not state",
    "ISA.001": "layers by purpose for Isaac Sim: the file is one layer",
}
"""Requirements of optional features of the profile that exports do not have, and what they are."""


class Said(NamedTuple):
    """What a judge says.

    Attributes:
        passed: Whether it has no objection; None where the format cannot express what would be judged.
        words: For the table.
    """

    passed: bool | None
    words: str


NOT_JUDGED: Final = "not judged"
SITES: Final = Said(None, f"{NOT_JUDGED}: Newton's reader drops the second site of a connect")


def folder_of(name: str) -> Path:
    """Return the plan folder or the recorded run of an example, or the plan folder of a hard task's reference."""
    if name in examples.names():
        return examples.folder(name)
    if (ROOT / "examples" / name).is_dir():
        return ROOT / "examples" / name / "recording"
    ((folder, task),) = tasks_in(names=[name])
    return reference_folder(folder, task)


def example_names() -> list[str]:
    """Return the names of all examples, those that are recorded runs only as well."""
    return sorted(path.name for path in (ROOT / "examples").iterdir() if (path / "plan.json").exists() or (path / "recording").exists())


def hard_names() -> list[str]:
    """Return the names of the hard tasks whose references are no examples."""
    examples_ = {folder_of(name) for name in example_names()}
    return sorted(task.name for folder, task in tasks_in(kind="hard") if reference_folder(folder, task) not in examples_)


def exported(assembly: Assembly, folder: Path) -> dict[str, Path]:
    """Write an assembly in the formats of simulators and return the main files."""
    writers: dict[str, Callable[[Assembly], Any]] = {"mjcf": write_mjcf, "urdf": write_urdf, "usd": write_usd}
    found = {}
    for kind, write in writers.items():
        bundle = write(assembly)
        bundle.write(folder / kind)
        found[kind] = folder / kind / bundle.main
    return found


def judges_of(assembly: Assembly, files: Mapping[str, Path]) -> dict[str, Callable[[], Said]]:
    """Return the judges of the exports of an assembly, by engine or checker and format."""
    opened = bool(assembly.mechanism.loop_joints)
    return {
        "MuJoCo mjcf": lambda: _verdict(held_to_kinematics(assembly, try_out("mujoco", files["mjcf"], drivers=driving(assembly)))),
        "MuJoCo urdf": lambda: _verdict(*simulate_file(files["urdf"], engines=("mujoco",)).outcomes),
        "PyBullet mjcf": lambda: _verdict(*simulate_file(files["mjcf"], engines=("pybullet",)).outcomes),
        "PyBullet urdf": lambda: _verdict(*simulate_file(files["urdf"], engines=("pybullet",)).outcomes),
        "Newton mjcf": lambda: SITES if opened else _verdict(held_to_kinematics(assembly, newton(assembly, files["mjcf"]))),
        "Newton urdf": lambda: _verdict((_as_it_is if opened else held_to_kinematics)(assembly, newton(assembly, files["urdf"]))),
        "Newton usd": lambda: _verdict(held_to_kinematics(assembly, newton(assembly, files["usd"]))),
        "Pinocchio urdf": lambda: _loads(files["urdf"]),
        "check_urdf urdf": lambda: check_urdf(files["urdf"]),
        "simcheck mjcf": lambda: simcheck(files["mjcf"]),
        "simcheck urdf": lambda: simcheck(files["urdf"], opened=opened),
        "USD validator usd": lambda: usd_validator(files["usd"]),
        "SimReady usd": lambda: simready(files["usd"]),
    }


def _as_it_is(assembly: Assembly, outcome: EngineOutcome) -> EngineOutcome:
    """Return the outcome: joints of open loops are not driven, so kinematics has nothing to say of their ranges."""
    del assembly
    return outcome


def _verdict(outcome: EngineOutcome) -> Said:
    """Return the words of a simulation: how far the joints come that are driven, what was left open, what is wrong."""
    findings = SimulationVerdict("", (outcome,)).findings
    reaches = outcome.judged
    least = 100 * min((reach.share for reach in reaches), default=1.0)
    words = f"{least:.4g} % of {len(reaches)}" if reaches else "stands"
    if outcome.loads is None:
        return Said(None, "not installed")
    if outcome.unread:
        return Said(None, f"{NOT_JUDGED}: PyBullet reads no inertia of {len(outcome.unread)} links")
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
    drivers = driving(assembly)
    if path.suffix == ".usda":  # NewtonMimicAPI couples joints of one kind only, which the export states as a loss
        lost = [tie for tie in ties if kinds[tie[0]] != kinds[tie[1]]]
        drivers += tuple(name for name, _, looped in lost if not looped)  # a screw's turn and travel are driven apart
        ties = [tie for tie in ties if tie not in lost]
    coupled = {name for name, _, _ in ties} | {leader for _, leader, looped in ties if looped}
    opened: set[str] = set()
    if path.suffix == ".urdf" and loops:  # a URDF leaves loops open, and what is coupled with their joints
        opened = following | coupled
    told = {
        "rest": {freedom.name: freedom.rest for freedom in freedoms},
        "drivers": None if opened else drivers,
        "freedoms": {
            joint.joint.name: [freedom.name for freedom in sorted(joint.freedoms, key=lambda freedom: freedom.kind != "slide")]
            for joint in joints
            if len(joint.freedoms) > 1
        },
        "opened": sorted(opened),
    }
    outcome = _newton_trials().ask(path, told)
    outcome.open_loops = len(assembly.mechanism.loop_joints) if opened else 0
    return outcome


class _NewtonTrials:
    """A process that tries one file after the other in Newton, whose import takes longer than many trials."""

    def __init__(self) -> None:
        self.process: subprocess.Popen[str] | None = None

    def ask(self, path: Path, told: Mapping[str, Any]) -> EngineOutcome:
        """Return the measurements of a file; a failed one if the process ends or takes too long."""
        if self.process is None or self.process.poll() is not None:
            command = [PYTHON, "-W", "ignore", str(Path(__file__).with_name("newton_trial.py"))]
            pipe = subprocess.PIPE
            self.process = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=subprocess.DEVNULL, text=True, env=_environment())
        process = self.process
        assert process.stdin is not None
        assert process.stdout is not None
        timer = threading.Timer(HANG_SECONDS, process.kill)
        timer.start()
        try:
            process.stdin.write(json.dumps([str(path), told]) + "\n")
            process.stdin.flush()
            line = next((line for line in process.stdout if line.startswith("{")), None)
        finally:
            timer.cancel()
        return (
            EngineOutcome("newton", loads=False, message="its process ended") if line is None else EngineOutcome.from_json(json.loads(line))
        )


_newton_trials: Final = cache(_NewtonTrials)


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
    if f"{module}._cli:Errors:" not in done.stdout + done.stderr:  # its summary
        return Said(passed=False, words=f"did not finish: {done.stderr[-200:]}")
    rows = [line for line in (done.stdout + done.stderr).splitlines() if line.startswith(("ERROR", "WARNING")) and module in line]
    names = [line.partition("[")[2].partition("]")[0] for line in rows]
    failed = [line for line, name in zip(rows, names, strict=True) if name not in ARGUED]
    argued = sorted({name for name in names if name in ARGUED})
    if failed:
        return Said(passed=False, words=f"{len(failed)} failures: {failed[0][:200]}")
    return Said(passed=True, words="0 failures" + (f" but {', '.join(argued)}" if argued else ""))


def simready(path: Path) -> Said:
    """Ask the requirements of SimReady Foundation for a prop in robotics."""
    if not SIMREADY:
        return Said(None, "not installed")
    program, (profile, version) = str(Path(SIMREADY).with_name("simready-validate")), PROFILE
    with tempfile.TemporaryDirectory() as folder:
        answer = Path(folder) / "answer.json"
        _run([program, "--profile", profile, "--version", version, "--output", str(answer), str(path)])
        (report,) = json.loads(answer.read_text()).values()
    features = report["features_summary"].values()
    required = {code for feature in features for code in _codes(feature.get("failing requirements"))}
    optional = {code for feature in features for code in _codes(feature.get("optional requirements"))}
    argued = required & ARGUED.keys()
    failed = sorted((required - argued) | (optional - required - {code for codes in OPTIONAL for code in codes.split(", ")}))
    if failed:
        return Said(passed=False, words=f"{len(failed)} failures: {', '.join(failed)}")
    passed = sum(feature["passed"] for feature in features)
    return Said(passed=True, words=f"0 failures but {', '.join(sorted(argued))}; {passed} features of {len(features)}")


def _codes(requirements: object) -> list[str]:
    """Return the codes of requirements, as in "SR.002" of "['com.nvidia.simready.SR.002']"."""
    return re.findall(r"com\.nvidia\.[a-z_]+\.([A-Z][\w.]*)", str(requirements))


_SOURCES: Final = {
    "MuJoCo": ("articad/simulation", "mujoco_trial strokes expected examine", "mujoco"),
    "PyBullet": ("articad/simulation", "bullet_trial strokes examine", "pybullet"),
    "Newton": ("articad/simulation", "strokes expected ../../tests/export/newton_trial", ""),
    "Pinocchio": ("articad/simulation", "loading", "pin"),
}
"""Folder, modules and package of the engines that run in programs of this project; `verdict` counts by its limits."""


@cache
def digest_of_judge(name: str) -> str:
    """Return a digest of a judge, "Newton usd": of its program without comments, and of its version."""
    engine = name.partition(" ")[0]
    found = hashlib.sha256(repr((SHARE, CALM, DRIFT, RESIDUAL, GROWTH) if engine in SIMULATORS else ()).encode())
    folder, modules, package = _SOURCES.get(engine, ("", "", ""))
    for module in modules.split():
        found.update(ast.dump(ast.parse((ROOT / folder / f"{module}.py").read_text())).encode())
    asked: dict[str, tuple[Callable[..., Any], ...]] = {
        "Newton": (newton,),
        "check_urdf": (check_urdf,),
        "simcheck": (simcheck,),
        "USD": (usd_validator,),
        "SimReady": (simready,),
    }
    for function in asked.get(engine, ()):
        found.update(ast.dump(ast.parse(inspect.getsource(function))).encode())
    if package:
        found.update(version(package).encode())
    elif engine != "check_urdf":  # of the system
        lock = "simready.lock" if engine == "SimReady" else "judges.lock"
        found.update(Path(__file__).with_name(lock).read_bytes())
    return found.hexdigest()[:16]


def _digest(path: Path) -> str:
    """Return a digest of a main file and everything beside it."""
    found = hashlib.sha256()
    for file in sorted(path.parent.rglob("*")):
        if file.is_file():
            found.update(f"{file.relative_to(path.parent)} {file.stat().st_size}\n".encode() + file.read_bytes())
    return found.hexdigest()[:16]


def _run(command: list[str]) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=SECONDS, env=_environment())


def _environment() -> dict[str, str]:
    return os.environ | {"PYTHONPATH": str(ROOT), "OPENBLAS_NUM_THREADS": "1"}


# ---------------------------------------------------------------------- the table

SIMULATORS: Final = ("MuJoCo", "PyBullet", "Newton")
OTHERS: Final = ("simcheck mjcf", "simcheck urdf", "check_urdf urdf", "Pinocchio urdf", "USD validator usd", "SimReady usd")

_HEAD = """# What simulators and validators say about exports

Written by `python -m tests.export.judges`, which exports the examples and the references of the benchmark's hard tasks with default settings
and runs the judges on the files. The references of four hard tasks are examples. Versions are those of `tests/export/judges.lock`, `tests/export/simready.lock` and `requirements.lock`.

"100 % of 4" means: 4 joints were driven, and the one that covered the smallest share of its range covered 100 %. The range of a follower in a loop is
the one that kinematics computes for it. `articad sim` requires 99 %.

- *loops open*: URDF has no closed loops, and PyBullet leaves out those of MJCF. "3 of open loops not driven" counts the joints whose motion
  such a loop would determine.
- Newton runs its MuJoCo solver on the processor. Its readers, mimics, loops and collision pairs are its own. The model first stands in steps of that solver,
  held by springs. Then the model that the solver compiled is held, driven and let go as an MJCF is in MuJoCo: with gravity, by the forces that joints need
  for the inertia that they feel through loops and couplings, at a pace that followers can keep, no stronger than is stable at the time step; and
  its energy may not grow. The judge chooses the time step: where energy grows at 2 ms, 0.5 and 0.125 ms decide, at which integration errs less. Newton 1.8 closes a loop correctly
  only if it is closed where all joints are zero. From USD it reads both frames of a loop joint, but its solver computes the anchor on the
  child from the poses at zero (newton-physics/newton, issue 2293 and pull request 4248). *Anchors of loops corrected* means: the judge
  restored the anchors that Newton had read; otherwise, the loop is a different mechanism. From MJCF, Newton's reader drops the position of
  the second site of a `connect`, so that file is not judged.
- steering_rack, jack_scissor and toggle_clamp in Newton from USD: NewtonMimicAPI couples joints of one kind only, so a wheel does not drive its rack there, and the
  turn of a screw does not drive its travel. Each is driven by itself. The export states this loss.
- landing_gear_side in Newton from USD: Newton's solver closes loops softly, with a time constant of 0.02 s where the MJCF states 0.004 s. Its jack of 0.0102 kg feels
  7.86 kg through the linkage and comes to 58.2 % of its range. From joints of UsdPhysics, Newton reads no stiffness. It reads `mjc:solref` from joints with
  MjcEqualityConnectAPI, which makes a point of a hinge. With that, the jack covers its range, but the model, whose USD states no damping, gains 61 % of its largest
  kinetic energy after release (16 % at a quarter of the time step). So the USD export states no stiffness of loops.
- An empty cell, or a model that is not listed, was not judged. *(earlier)*: by an earlier version of the judge's program, or on an earlier export.
- Drake and SAPIEN are not in the table: `pytest -m engines_all tests/export/test_elsewhere.py` loads URDFs of all kinds of joints in both, and MJCF and SDF in
  Drake, in an environment of their own, and compares the poses of all links.
- PyBullet does not collide parts of one body unless it is asked to, so its rows do not test collision shapes. It simulates the inertias and ranges that
  the file states. It has no couplings, so followers are driven with their leaders. From MJCF it leaves out bodies on ball joints, with what they carry.
"""


def page(record: Mapping[str, Mapping[str, Any]]) -> str:
    """Return the page for what judges said, by model and judge."""
    shown = [
        ("The examples", {name: said for name, said in sorted(record.items()) if name not in hard_names()}),
        ("References of the benchmark's hard tasks", {name: record[name] for name in hard_names() if name in record}),
    ]
    lines = [_HEAD]
    for title, rows in shown:
        lines += [f"## {title}", "", *_tables(rows), ""]
    lines += ["## Requirements that are not met, and why", ""]
    lines += [f"- `{name}`: {reason}." for name, reason in ARGUED.items()]
    lines.append(
        f"- Of the optional features of SimReady's profile {' '.join(PROFILE)}, the file has those that a prop with joints needs. It lacks:"
    )
    lines += [f"    - `{codes}`: {what}." for codes, what in OPTIONAL.items()]
    lines.append(
        "- simcheck's `engine.rest_contacts` on URDFs of closed loops: simcheck uses zero as the rest pose. A loop need not close where all "
        "joints are zero, and URDF has no other pose. The MJCF of the same model rests at its key `home`."
    )
    return "\n".join(lines) + "\n"


def summary(record: Mapping[str, Mapping[str, Any]]) -> str:
    """Return the part of README that says what was measured, by engine and file: a table between two comments."""
    lines = [
        MARKS[0],
        "| engine or checker | file | models judged | without objection | joints driven | smallest share of a range |",
        "|---" * 6 + "|",
    ]
    others = [name for name in OTHERS if name.split()[0] not in {"Pinocchio", "check_urdf"}]
    for judge in [f"{engine} {kind}" for engine in SIMULATORS for kind in ("mjcf", "urdf", "usd")] + others:
        said = {name: row[judge] for name, row in record.items() if judge in row and not row[judge]["words"].startswith(NOT_JUDGED)}
        if not said:
            continue
        wrong = sorted(name for name, one in said.items() if one["passed"] is False)
        driven = [(float(share), int(count)) for one in said.values() for share, count in re.findall(r"^([\d.]+) % of (\d+)", one["words"])]
        argued = sorted(name for name, one in said.items() if one["passed"] is None and re.match(r"[1-9]\d* errors", one["words"]))
        passed = f"{len(said) - len(wrong) - len(argued)}" + (f"; not {', '.join(wrong)}" if wrong else "")
        passed += f"; {', '.join(argued)} in the pose zero only, where the loops are open" if argued else ""
        reach = f"{sum(count for _, count in driven)} | {min(share for share, _ in driven):.4g} %" if driven else " | "
        lines.append(f"| {judge.rpartition(' ')[0]} | {judge.rpartition(' ')[2].upper()} | {len(said)} | {passed} | {reach} |")
    return "\n".join([*lines, MARKS[1]])


def readme(text: str, record: Mapping[str, Mapping[str, Any]]) -> str:
    """Return README with the present `summary`."""
    before, _, rest = text.partition(MARKS[0])
    return before + summary(record) + rest.partition(MARKS[1])[2]


def _tables(rows: Mapping[str, Mapping[str, Any]]) -> list[str]:
    lines = ["### Simulators", "", "| model | file | " + " | ".join(SIMULATORS) + " |", "|---" * (2 + len(SIMULATORS)) + "|"]
    for name, said in rows.items():
        for kind in ("mjcf", "urdf", "usd"):
            cells = [_cell(said.get(f"{engine} {kind}")) for engine in SIMULATORS]
            if any(cells):
                lines.append(f"| {name} | {kind} | " + " | ".join(cells) + " |")
    lines += ["", "### Checkers and validators", "", "| model | " + " | ".join(OTHERS) + " |", "|---" * (1 + len(OTHERS)) + "|"]
    return lines + [f"| {name} | " + " | ".join(_cell(said.get(judge)) for judge in OTHERS) + " |" for name, said in rows.items()]


def _cell(said: Mapping[str, Any] | None) -> str:
    if said is None:
        return ""
    mark = {True: "", None: "", False: "**fails**: "}[said["passed"]]
    return mark + str(said["words"]).replace("|", "/").replace("\n", " ") + ("" if "judge" in said else " (earlier)")


def main(words: list[str]) -> int:
    """Judge models, keep the record and write the page, or check the record."""
    options: dict[str, set[str]] = {
        option: {words[at + 1] for at, word in enumerate(words) if word == option} for option in ("--without", "--only")
    }
    names = [word for at, word in enumerate(words) if not word.startswith("--") and (at == 0 or words[at - 1] not in options)]
    old = 0
    for name in names or [*example_names(), *hard_names()]:
        with tempfile.TemporaryDirectory() as folder:
            assembly = read(folder_of(name))
            files = exported(assembly, Path(folder) / name)  # SimReady's NP.005: NAME/…/NAME.usda
            digests = {kind: _digest(path) for kind, path in files.items()}
            known = json.loads(RECORD.read_text()).get(name, {})
            for judge, ask in judges_of(assembly, files).items():
                now = {"files": digests[judge.split()[-1]], "judge": digest_of_judge(judge)}
                fresh = now.items() <= known.get(judge, {}).items()
                if "--check" in words:
                    old += not fresh
                    if not fresh:
                        print(f"{name}: {judge} {'is of an older export or judge' if judge in known else 'was not asked'}")  # noqa: T201
                    continue
                named = {judge, judge.split()[0]}
                if (
                    named & options["--without"]
                    or (options["--only"] and not named & options["--only"])
                    or (fresh and "--again" not in words)
                ):
                    continue
                said = ask()
                print(f"{name}: {judge}: {said.words}", flush=True)  # noqa: T201 - a command
                if said.words != "not installed":
                    _keep(name, judge, said._asdict() | now)
    if "--check" in words:
        print(f"{old} answers are missing or old.")  # noqa: T201
    return 1 if old else 0


def _keep(name: str, judge: str, row: Mapping[str, Any]) -> None:
    """Write an answer into the record, and what is made of the record; several runs may do so at a time."""
    with RECORD.open() as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        record: dict[str, Any] = json.loads(RECORD.read_text())
        record[name] = record.get(name, {}) | {judge: dict(row)}
        RECORD.write_text(json.dumps(record, indent=1, sort_keys=True) + "\n")
        PAGE.write_text(page(record))
        README.write_text(readme(README.read_text(), record))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
