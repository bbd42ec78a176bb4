"""Exports that a process writes beside the proof are those that are written without it, whatever becomes of the process."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from articad import cli, read
from articad.assembly import Assembly
from articad.certificates.certificate import Certificate
from articad.kernels.kernel import BuildCache
from articad.processes import launcher
from articad.runs import exporting
from articad.runs.exporting import Exports
from articad.runs.record import record_assembly, record_checked, record_export
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


def test_what_the_process_writes_is_what_is_written_without_it(run: Run, chest: Assembly) -> None:
    with pytest.MonkeyPatch.context() as patch, Exports(run, chest, NAMES, beside=True, cache=BuildCache()) as exports:
        patch.setattr(exporting, "record_export", lambda *_: pytest.fail("written here"))
        reports = [exports.record(name) for name in NAMES]
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


def test_a_process_is_started_only_where_it_pays(run: Run, chest: Assembly, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(launcher, "start", lambda *_, **__: pytest.fail("started"))
    with Exports(run, chest, NAMES, beside=False, cache=BuildCache()) as exports:
        assert exports.record("glb")["ok"]


def test_a_refuted_certificate_is_saved_as_refuted(run: Run, chest: Assembly) -> None:
    certificate = chest.certify(check=False)
    assert record_checked(run, certificate) == []
    assert json.loads((run.path / "certificate.json").read_bytes())["ok"]

    class Forged(Certificate):
        """Files of another proof: the lid is smaller."""

        def mesh_files(self) -> dict[str, bytes]:
            files = certificate.mesh_files()
            return files | {"lid.npz": files["box.npz"]}

    fields: dict[str, Any] = {name: getattr(certificate, name) for name in certificate.__dataclass_fields__}
    faults = record_checked(run, Forged(**fields))
    assert faults == ["mesh of lid is missing or different"]
    saved = json.loads((run.path / "certificate.json").read_bytes())
    assert not saved["ok"]
    assert [finding["code"] for finding in saved["findings"] if finding["severity"] == "error"] == ["E_CERTIFICATE_REFUTED"]


def test_a_complete_build_says_that_a_refuted_proof_is_refuted(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("articad.runs.record.verify_file", lambda *_: ["claim 0 does not hold"])
    monkeypatch.setattr("articad.commands.building.FORMATS", ("plan",))
    assert cli.main(["build", str(write_chest(tmp_path / "chest")), "--out", str(tmp_path / "run"), "--complete"]) == 1
    said = capsys.readouterr().out
    assert "refuted by its checker: claim 0 does not hold" in said
    assert "E_CERTIFICATE_REFUTED" in said
