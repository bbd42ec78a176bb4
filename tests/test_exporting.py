"""Exports that a process writes beside the proof are those that are written without it, whatever becomes of the process."""

from __future__ import annotations

import errno
import json
import os
import signal
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from articad import cli, read
from articad.assembly import Assembly
from articad.certificates.certificate import Certificate
from articad.kernels.freecad_install import FreeCADLimits
from articad.kernels.kernel import BuildCache
from articad.processes import launcher
from articad.runs import exporting
from articad.runs.exporting import Exports
from articad.runs.record import record_assembly, record_certificate, record_checked, record_export
from articad.runs.run import Run, RunRequest
from tests.test_commands import write_chest

NAMES = ("urdf", "mjcf", "step", "glb", "3mf", "plan")


@pytest.fixture(scope="module")
def chest(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Assembly]:
    """A box with a hinged lid."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ARTICAD_CACHE", str(tmp_path_factory.mktemp("cache")))
        yield read(write_chest(tmp_path_factory.mktemp("plan") / "chest"))


@pytest.fixture
def run(chest: Assembly, tmp_path: Path) -> Iterator[Run]:
    """A run with the chest, open for writing."""
    assert chest.resolved is not None
    with Run.create(RunRequest(prompt="chest", options={"task": "build", "kernel": "build123d"}), out=tmp_path / "run") as made:
        made.save_plan(chest.to_plan().dumps(), 0)
        record_assembly(made, chest)
        yield made


def files_of(run: Run) -> dict[str, bytes]:
    """Return the content of each exported file."""
    return {str(file.relative_to(run.path)): file.read_bytes() for file in sorted((run.path / "export").rglob("*")) if file.is_file()}


def notes_of(run: Run) -> list[str]:
    """Return what the trace says of the process."""
    return [event["message"] for event in run.events() if event["event"] == "note" and event["where"] == "export"]


def test_what_the_process_writes_is_what_is_written_without_it(
    run: Run, chest: Assembly, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    parts = BuildCache()
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("ARTICAD_CACHE", "kept")  # of shapes that the exports make
    with pytest.MonkeyPatch.context() as patch, Exports(run, chest, NAMES, beside=True, cache=parts) as exports:
        patch.setattr(exporting, "record_export", lambda *_: pytest.fail("written here"))
        reports = [exports.record(name) for name in NAMES]
    assert list((tmp_path / "kept").glob("*/seal.json")), "in the working folder of this process"
    assert notes_of(run) == []
    beside = files_of(run)
    assert [report["main"] for report in reports] == [record_export(run, chest, name)["main"] for name in NAMES]
    assert files_of(run) == beside


@pytest.mark.parametrize("at", [0, 2])
def test_what_a_killed_process_did_not_write_is_written_here(at: int, run: Run, chest: Assembly) -> None:
    for name in NAMES:
        record_export(run, chest, name)
    alone = files_of(run)
    with Exports(run, chest, NAMES, beside=True, cache=BuildCache()) as exports:
        for index, name in enumerate(NAMES):
            if index == at:
                assert exports._process is not None
                exports._process.kill()
            exports.record(name)
    assert files_of(run) == alone


@pytest.mark.skipif(not hasattr(signal, "SIGSTOP"), reason="Windows stops no process")
def test_a_process_that_does_not_go_on_is_ended(run: Run, chest: Assembly, monkeypatch: pytest.MonkeyPatch) -> None:
    record_export(run, chest, "plan")
    alone = files_of(run)
    monkeypatch.setattr(exporting, "_SECONDS", 0.2)
    with Exports(run, chest, ["plan"], beside=True, cache=BuildCache()) as exports:
        process = exports._process
        assert process is not None
        os.kill(process.pid, signal.SIGSTOP)
        exports.record("plan")
        assert process.ended()
    assert files_of(run) == alone
    assert notes_of(run) == ["the process that writes exports was ended, because plan took longer than 0.2 s: it said nothing"]


def test_exports_are_written_here_where_no_process_starts(run: Run, chest: Assembly, monkeypatch: pytest.MonkeyPatch) -> None:
    given: list[launcher.Limits] = []

    def refuse(*_: object, limits: launcher.Limits, **__: object) -> None:
        given.append(limits)
        raise BlockingIOError(errno.EAGAIN, "no more processes")

    monkeypatch.setattr(launcher, "start", refuse)
    with Exports(run, chest, ["plan"], beside=True, cache=BuildCache()) as exports:
        assert exports.record("plan")["ok"]
    assert notes_of(run) == [f"the process that writes exports did not start: [Errno {errno.EAGAIN}] no more processes"]
    (limits,) = given
    least = FreeCADLimits()  # FreeCAD inherits the limits: it refuses to start where they are less than its own
    assert limits.resources()["CPU"] > least.seconds
    assert limits.resources()["DATA"] >= least.memory
    assert limits.resources()["FSIZE"] >= least.file_size


def test_what_the_process_says_is_kept_in_the_trace(run: Run, chest: Assembly, monkeypatch: pytest.MonkeyPatch) -> None:
    start = launcher.start
    code = r"import os; os.write(1, b'a library says \xff\n'); os.write(2, b'the crash\n'); os._exit(3)"
    monkeypatch.setattr(launcher, "start", lambda _, **more: start([sys.executable, "-c", code], **more | {"module": None}))
    with Exports(run, chest, ["plan"], beside=True, cache=BuildCache()) as exports:
        assert exports.record("plan")["ok"]
    assert notes_of(run) == ["the process that writes exports ended before plan, with exit code 3: a library says \ufffd\nthe crash"]


def test_a_process_is_started_only_where_it_pays(run: Run, chest: Assembly, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(launcher, "start", lambda *_, **__: pytest.fail("started"))
    with Exports(run, chest, NAMES, beside=False, cache=BuildCache()) as exports:
        assert exports.record("glb")["ok"]


def test_a_refuted_certificate_is_saved_as_refuted(run: Run, chest: Assembly) -> None:
    certificate = chest.certify(check=False)
    assert record_checked(run, certificate) == {"ok": True, "checked": True, "faults": []}
    assert json.loads((run.path / "certificate.json").read_bytes())["ok"]

    class Forged(Certificate):
        """Files of another proof: the lid is smaller."""

        def mesh_files(self) -> dict[str, bytes]:
            files = certificate.mesh_files()
            return files | {"lid.npz": files["box.npz"]}

    fields: dict[str, Any] = {name: getattr(certificate, name) for name in certificate.__dataclass_fields__}
    verified = record_checked(run, Forged(**fields))
    assert verified == {"ok": False, "checked": True, "faults": ["mesh of lid is missing or different"]}
    saved = json.loads((run.path / "certificate.json").read_bytes())
    assert not saved["ok"]
    assert [finding["code"] for finding in saved["findings"] if finding["severity"] == "error"] == ["E_CERTIFICATE_REFUTED"]


@pytest.mark.parametrize("asks", [True, False], ids=["build", "certify"])
def test_a_proof_too_large_for_the_checker_is_not_called_refuted(
    run: Run, chest: Assembly, asks: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Neither by a build nor by `certify`, which does not ask the checker to read files; both say that it is not checked."""
    certificate = chest.certify(check=False)
    size = len(certificate.mesh_files()["_proof.npz"])
    monkeypatch.setattr("articad.runs.record.BYTES", size - 1)
    reason = f"_proof.npz has {size} bytes, more than the {size - 1} that it reads"
    if asks:
        assert record_checked(run, certificate) == {"ok": False, "checked": False, "faults": [reason]}
    else:
        assert not record_certificate(run, certificate)["ok"]
    saved = json.loads((run.path / "certificate.json").read_bytes())
    assert not saved["ok"]
    (finding,) = [finding for finding in saved["findings"] if finding["severity"] == "error"]
    assert (finding["code"], finding["message"]) == ("E_NOT_CHECKED", f"The certificate checker does not read the proof: {reason}.")
    assert "articad certify RUN --joints" in finding["hint"]


def test_a_file_too_large_for_the_checker_is_not_called_refuted(
    run: Run, chest: Assembly, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    record_certificate(run, chest.certify(check=False))
    assert cli.main(["verify-certificate", str(run.path)]) == 0
    monkeypatch.setattr("articad.certificates.verifier_files.TEXT", 1000)
    assert cli.main(["verify-certificate", str(run.path)]) == 1
    said = capsys.readouterr().out
    assert "certificate.json: not checked." in said
    assert "refuted" not in said


def test_a_complete_build_says_that_a_refuted_proof_is_refuted(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("articad.runs.record.verify_file", lambda *_: ["claim 0 does not hold"])
    monkeypatch.setattr("articad.commands.building.FORMATS", ("plan",))
    assert cli.main(["build", str(write_chest(tmp_path / "chest")), "--out", str(tmp_path / "run"), "--complete"]) == 1
    said = capsys.readouterr().out
    assert "refuted by its checker: claim 0 does not hold" in said
    assert "E_CERTIFICATE_REFUTED" in said
