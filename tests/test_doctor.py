"""Missing shared libraries are named with the line that installs them, before anything that is linked against them is imported."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from articad.agents.llm import Reply, Scripted
from articad.commands import doctor
from articad.errors import KernelUnavailableError

COMMANDS = (["doctor"], ["build", "nowhere"], ["check", "nowhere"], ["export", "nowhere", "--to", "urdf"], ["replay", "nowhere"])


def without(*sonames: str) -> doctor.Loader:
    """Return a loader for a machine that lacks these libraries."""

    def load(soname: str) -> object:
        if soname in sonames:
            raise OSError(f"{soname}: cannot open shared object file: No such file or directory")
        return object()

    return load


@pytest.fixture
def machine_without_libraries(tmp_path: Path) -> dict[str, str]:
    """An environment in which the dynamic loader finds files of these names that are not libraries, and gives up."""
    for soname in ("libGL.so.1", "libgomp.so.1"):
        (tmp_path / soname).touch()
    return os.environ | {"LD_LIBRARY_PATH": str(tmp_path)}


def articad(*arguments: str, env: dict[str, str]) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "articad.cli", *arguments], env=env, capture_output=True, text=True, check=False, timeout=120
    )


def test_nothing_is_missing_where_every_library_loads() -> None:
    assert doctor.missing_libraries(without()) == ()
    doctor.require_libraries(without())


def test_the_missing_libraries_are_those_that_do_not_load() -> None:
    missing = doctor.missing_libraries(without("libGL.so.1", "libgomp.so.1"))
    assert [library.soname for library in missing] == ["libGL.so.1", "libgomp.so.1"]
    assert doctor.install_line(missing) == "apt-get update && apt-get install --no-install-recommends libgl1 libgomp1"


def test_the_error_names_library_user_and_remedy() -> None:
    with pytest.raises(KernelUnavailableError, match=r"libgomp\.so\.1") as caught:
        doctor.require_libraries(without("libgomp.so.1"))
    (finding,) = caught.value.findings
    assert finding.code == "E_KERNEL_UNAVAILABLE"
    assert "Pinocchio" in finding.message
    assert "apt-get install --no-install-recommends libgomp1" in finding.hint


@pytest.mark.parametrize("command", COMMANDS, ids=lambda words: words[0])
def test_every_command_says_what_to_install_and_ends_with_3(command: list[str], machine_without_libraries: dict[str, str]) -> None:
    done = articad(*command, env=machine_without_libraries)
    told = done.stdout + done.stderr
    assert done.returncode == 3, told
    assert "libGL.so.1" in told
    assert "libgomp.so.1" in told
    assert "apt-get install --no-install-recommends libgl1 libgomp1" in told
    assert "Traceback" not in told


@pytest.mark.parametrize("command", COMMANDS, ids=lambda words: words[0])
def test_as_json_the_same_is_one_report(command: list[str], machine_without_libraries: dict[str, str]) -> None:
    done = articad(*command, "--json", env=machine_without_libraries)
    report = json.loads(done.stdout)
    assert (done.returncode, report["ok"]) == (3, False)
    assert [finding["code"] for finding in report["findings"]] == ["E_KERNEL_UNAVAILABLE"]


def test_help_and_version_work_on_any_machine(machine_without_libraries: dict[str, str]) -> None:
    assert articad("--help", env=machine_without_libraries).returncode == 0
    assert articad("--version", env=machine_without_libraries).returncode == 0


def test_the_report_lists_libraries_packages_and_sandbox() -> None:
    items = doctor.examine(without("libGL.so.1"))  # the kernel is not started where a library is missing
    status = {item.name: item.status for item in items}
    assert status["libGL.so.1"] == "missing"
    assert status["build123d starts"] == "missing"
    assert status["numpy"] == "ok"
    assert "sandbox" in status
    assert doctor.report(items)["ok"] is False


def test_keys_are_reported_by_name_only(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OPENAI_API_KEY", "sk-do-not-show-this")
    told = str(doctor.examine(without("libGL.so.1")))
    assert "OPENAI_API_KEY is set" in told
    assert "do-not-show" not in told


@pytest.mark.parametrize(
    ("answer", "what", "status", "words"),
    [
        ('{"color": "red"}', "model's forms", "ok", "returns the requested form"),
        ('{"color": "red"}', "model's sight", "ok", "sees"),
        ('{"color": "red"}', "model's price", "optional", "unknown"),
        ('{"color": "blue"}', "model's sight", "optional", "does not see well"),
        ("It is red.", "model's forms", "missing", "not in the requested form"),
        ('["red"]', "model's forms", "missing", "not in the requested form"),
    ],
)
def test_a_model_is_judged_by_one_question(answer: str, what: str, status: str, words: str) -> None:
    llm = Scripted({"doctor": answer})
    item = next(item for item in doctor.ask_once(llm) if item.name == what)
    assert item.status == status
    assert words in item.detail
    assert llm.steps == ["doctor"]


def test_a_known_price_is_told() -> None:
    items = doctor.ask_once(Scripted({"doctor": Reply('{"color": "red"}', "m", cost=0.0001)}))
    assert {item.status for item in items} == {"ok"}
    assert "$0.000100" in items[-1].detail


def test_a_model_whose_key_is_missing_is_told_by_the_variable(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("GEMINI_API_KEY", raising=False)
    (item,) = doctor.examine_model("gemini/gemini-3-flash-preview")
    assert item.status == "missing"
    assert "GEMINI_API_KEY" in item.detail
    assert "GEMINI_API_KEY" in item.remedy
