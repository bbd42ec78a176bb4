"""`articad install freecad`: the installer's lines as they come, its failures with the reason."""

from __future__ import annotations

import json
import os
import shutil
from pathlib import Path

import pytest

from articad import cli
from articad.errors import KernelUnavailableError
from articad.kernels import cache, freecad_install
from articad.memory import experience


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


@pytest.mark.parametrize("name", ["freecad.partial", "freecad.packages", "install-freecad.log"])
def test_a_planted_link_is_not_followed(
    name: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The installer runs as root: through a link to a file or folder of others it would overwrite that."""
    (tmp_path / "articad").mkdir()
    (tmp_path / "mine").write_text("kept")
    (tmp_path / "articad" / name).symlink_to(tmp_path / "mine")
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("PATH", f"{without_apt(tmp_path)}")
    assert cli.main(["install", "freecad"]) != 0
    assert f"{tmp_path}/articad/{name} is a link" in capsys.readouterr().err
    assert (tmp_path / "mine").read_text() == "kept"


@pytest.mark.skipif(os.getuid() != 0, reason="makes a folder of another user")
def test_a_folder_of_another_user_is_not_used(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "articad").mkdir()
    os.chown(tmp_path / "articad", 65534, 65534)
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("PATH", f"{without_apt(tmp_path)}")
    assert cli.main(["install", "freecad"]) != 0
    assert f"{tmp_path}/articad belongs to another user" in capsys.readouterr().err


def test_a_relative_data_folder_is_ignored(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """It would name a folder of whoever made the working folder: a program planted there was taken for FreeCAD."""
    planted = tmp_path / "share" / "articad" / "freecad" / "usr" / "bin"
    planted.mkdir(parents=True)
    for name in ("freecadcmd", "FreeCADCmd"):
        (planted / name).write_text("#!/bin/sh\ntouch ran\n")
        (planted / name).chmod(0o755)
    monkeypatch.chdir(tmp_path)
    for variable in ("XDG_DATA_HOME", "XDG_CACHE_HOME"):
        monkeypatch.setenv(variable, "share")
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.delenv("ARTICAD_CACHE", raising=False)
    monkeypatch.delenv("ARTICAD_MEMORY", raising=False)
    monkeypatch.setenv("PATH", "/nowhere")
    for folder in (freecad_install.tree(), cache.default_root(), experience.default_folder()):
        assert folder.is_relative_to(tmp_path / "home")
    with pytest.raises(KernelUnavailableError):
        freecad_install.find()
    assert not (tmp_path / "ran").exists()


def without_apt(folder: Path) -> Path:
    """Return a folder with the programs of the installer, but no apt-get: an installer that goes on ends there."""
    programs = folder / "programs"
    programs.mkdir()
    for name in ("bash", "stat", "sed", "mount", "grep", "rm", "sort", "head"):
        found = shutil.which(name)
        assert found is not None
        (programs / name).symlink_to(found)
    return programs
