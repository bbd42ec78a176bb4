"""`articad install freecad`: the installer's lines as they come, its failures with the reason."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from articad import cli
from articad.kernels import freecad_install


def installer(folder: Path, text: str) -> Path:
    path = folder / "installer.sh"
    path.write_text(text)
    return path


def test_the_reason_of_a_refused_installation_is_in_the_error(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = "echo 'Retrieving: 50 packages' >&2; echo 'bubblewrap is refused here' >&2; exit 3"
    monkeypatch.setattr(freecad_install, "INSTALLER", installer(tmp_path, words))
    assert cli.main(["install", "freecad"]) != 0
    said = capsys.readouterr()
    assert "Retrieving: 50 packages" in said.out
    assert "bubblewrap is refused here" in said.err


def test_an_installation_that_cannot_start_is_no_success(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(freecad_install, "INSTALLER", installer(tmp_path, "echo done"))
    monkeypatch.setattr(freecad_install, "installed", tuple)
    assert cli.main(["--json", "install", "freecad"]) != 0
    assert "does not start" in json.dumps(json.loads(capsys.readouterr().out))


def test_the_installer_of_the_package_removes_its_trees(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    (tmp_path / "articad" / "freecad" / "usr").mkdir(parents=True)
    assert cli.main(["install", "freecad", "--remove"]) == 0
    assert not (tmp_path / "articad" / "freecad").exists()
    assert f"removed {tmp_path}/articad/freecad" in capsys.readouterr().out
