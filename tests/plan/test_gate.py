"""The gate: what `check` calls an error is built by no command and no call, and no part script of it runs."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any, cast

import pytest

from articad import cli, examples
from articad.assembly import Assembly
from articad.errors import ArticadError, PlanError
from articad.kernels.kernel import PartKernel
from articad.plan.check import admitted, check_plan
from articad.plan.schema import AssemblyPlan
from tests.plan.samples import Json
from tests.plan.test_check import CASES, Case
from tests.test_commands import write_chest


class NoKernel:
    """Fails the test as soon as anything of it is used."""

    name = "build123d"

    def __getattr__(self, name: str) -> Any:
        raise AssertionError(f"the kernel was asked for {name}")


@pytest.mark.parametrize("case", [case for case in CASES if case.code.startswith("E_")], ids=lambda case: f"{case.code}-{case.where}")
def test_no_script_of_a_plan_with_an_error_is_built(case: Case) -> None:
    try:
        plan = AssemblyPlan.from_json(case.plan)
    except PlanError:
        return  # refused at an earlier door: such a plan cannot be read
    wanted = {(finding.code, finding.where) for finding in check_plan(plan).errors}
    with pytest.raises(PlanError) as caught:
        Assembly.from_plan(plan, {}, kernel=cast("PartKernel", NoKernel()))
    assert {(finding.code, finding.where) for finding in caught.value.findings if finding.severity == "error"} == wanted
    assert (case.code, case.where) in wanted


@pytest.mark.parametrize("name", sorted(examples.names()))
def test_the_gate_lets_every_example_through_with_its_parameters_at_their_bounds(name: str) -> None:
    plan = AssemblyPlan.load(examples.folder(name))
    assert admitted(plan)[0].mechanism.mobility == plan.freedoms
    for parameter in plan.parameters:
        if parameter.max is not None and not any(f.where == f"parameters.{parameter.name}.max" for f in check_plan(plan)):
            admitted(plan, **{parameter.name: float(parameter.max)})


def lid_off(plan: Json) -> str:
    """Leave the lid 40 mm beside its hinge."""
    plan["parts"][1]["rest_pose"] = {"at": [0, 60, 0.2]}
    return "E_MATE_OFFSET"


def wrong_freedoms(plan: Json) -> str:
    plan["freedoms"] = 2
    return "E_DOF_MISMATCH"


def metres(plan: Json) -> str:
    """State every length in metres."""
    plan["parameters"] = [{"name": "width", "value": 0.06}]
    for part in plan["parts"]:
        part["envelope_mm"] = ["width", 0.04, 0.02]
        for connector in part["connectors"]:
            connector["o"] = [value / 1000 for value in connector["o"]]
    plan["parts"][1]["rest_pose"] = {"at": [0, 0.02, 0.0002]}
    return "E_SCALE"


def contradicting_limits(plan: Json) -> str:
    plan["joints"][0]["angle_deg"] = [10, -100]
    return "E_LIMITS_ORDER"


FAULTS: list[Callable[[Json], str]] = [lid_off, wrong_freedoms, metres, contradicting_limits]


@pytest.fixture
def chest(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A plan with its scripts, and an empty cache: what is built leaves something there."""
    monkeypatch.setenv("ARTICAD_CACHE", str(tmp_path / "cache"))
    return write_chest(tmp_path / "chest")


def spoilt(folder: Path, fault: Callable[[Json], str]) -> str:
    plan = json.loads((folder / "plan.json").read_text())
    code = fault(plan)
    (folder / "plan.json").write_text(json.dumps(plan))
    return code


def test_every_fault_here_is_what_check_calls_it(chest: Path, tmp_path: Path) -> None:
    for number, fault in enumerate(FAULTS):
        folder = shutil.copytree(chest, tmp_path / str(number))
        code = spoilt(folder, fault)
        assert code in {finding.code for finding in check_plan(AssemblyPlan.load(folder)).errors}


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.__name__)
@pytest.mark.parametrize("command", ["build", "convert", "batch", "from_plan"])
def test_no_command_builds_what_check_refuses(
    command: str, fault: Callable[[Json], str], chest: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code, out = spoilt(chest, fault), tmp_path / "out"
    if command == "from_plan":
        with pytest.raises(ArticadError) as caught:
            Assembly.from_plan(AssemblyPlan.load(chest), chest / "parts")
        assert code in {finding.code for finding in caught.value.findings}
    elif command == "batch":
        (tmp_path / "batch.json").write_text(json.dumps({"schema": "articad.batch/1", "items": [{"plan": "chest"}]}))
        assert cli.main(["batch", str(tmp_path / "batch.json"), "--out", str(out), "--jobs", "1", "--json"]) == 1
        assert f'"{code}": 1' in capsys.readouterr().out
        assert not list(out.rglob("*.urdf"))
    else:
        words = {"build": ["build", chest, "--out", out], "convert": ["convert", chest / "plan.json", out / "chest.urdf"]}[command]
        assert cli.main([*map(str, words), "--json"]) == 3
        assert f'"{code}"' in capsys.readouterr().out
        assert not out.exists() or not list(out.iterdir())
    assert not list((tmp_path / "cache").rglob("part.npz")), "a script ran"


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.__name__)
def test_nothing_leaves_a_run_whose_plan_was_spoilt(
    fault: Callable[[Json], str], chest: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run = tmp_path / "run"
    assert cli.main(["build", str(chest), "--out", str(run), "--no-pictures", "--json"]) == 0
    code = spoilt(run, fault)
    capsys.readouterr()
    for words in (["certify", run], ["export", run, "--to", "urdf", "--out", tmp_path / "away"]):
        assert cli.main([*map(str, words), "--json"]) == 3
        assert f'"{code}"' in capsys.readouterr().out
    assert not (run / "certificate.json").exists()
    assert not (tmp_path / "away").exists()


def test_a_build_shows_the_warnings_of_the_plan(chest: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def radians(plan: Json) -> str:
        plan["joints"][0]["angle_deg"] = [-1.57, 0]
        return "W_LIMITS_UNITS"

    code = spoilt(chest, radians)
    assert cli.main(["build", str(chest), "--out", str(tmp_path / "run"), "--no-pictures"]) == 0
    assert code in capsys.readouterr().out
