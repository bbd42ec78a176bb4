"""What is installed is what was locked: by hashes, without bad releases, without code that runs at every start of Python."""

from __future__ import annotations

import re
import site
import tomllib
from importlib import metadata
from pathlib import Path

import pytest

from articad.commands import doctor

ROOT = Path(__file__).resolve().parents[2]
LOCK = (ROOT / "requirements.lock").read_text()
# Files that Python reads at every start; one that a release of litellm had was how it stole keys (MAL-2026-2144).
KNOWN_PTH = {"cmeel.pth", "distutils-precedence.pth", "a1_coverage.pth", "_virtualenv.pth"}


def entries() -> dict[str, str]:
    found = re.findall(r"^([A-Za-z0-9._-]+)==(\S+)[^\n]*\\\n((?:    --hash=sha256:[0-9a-f]{64}(?: \\)?\n)+)", LOCK, re.MULTILINE)
    return {name.lower(): version for name, version, _ in found}


def test_every_locked_package_has_hashes() -> None:
    pinned = {line.partition("==")[0].lower() for line in LOCK.splitlines() if re.match(r"[A-Za-z0-9._-]+==", line)}

    assert len(pinned) > 100
    assert pinned == set(entries())


def test_every_dependency_is_locked() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    named = {re.match(r"[A-Za-z0-9._-]+", line)[0].lower() for line in project["dependencies"]}  # type: ignore[index]

    assert named <= set(entries())


def test_bad_releases_are_excluded_locked_out_and_named_by_the_doctor() -> None:
    text = (ROOT / "pyproject.toml").read_text()
    for name, version in doctor._COMPROMISED:
        assert f"!={version}" in text
        assert entries()[name] != version


def test_the_lock_names_no_registry() -> None:
    assert "://" not in LOCK
    assert "index" not in LOCK.replace("index-", "")


def test_nothing_unknown_runs_when_python_starts() -> None:
    for folder in map(Path, site.getsitepackages()):
        for path in folder.glob("*.pth"):
            lines = [line for line in path.read_text().splitlines() if line.startswith(("import ", "import\t"))]
            ours = path.name.startswith(("_articad", "articad", "__editable__"))
            assert not lines or path.name in KNOWN_PTH or ours, f"{path.name} runs code at every start of Python"


def test_the_doctor_has_the_numbers_that_a_report_of_a_fault_needs() -> None:
    names = {item.name for item in doctor.examine()}

    assert {"articad", "python", "machine", "litellm", "build123d", "build123d starts", "FreeCAD", "sandbox", "renderer"} <= names


@pytest.mark.parametrize(("name", "version"), sorted(doctor._COMPROMISED))
def test_a_bad_release_that_is_installed_is_called_missing(name: str, version: str, monkeypatch: pytest.MonkeyPatch) -> None:
    real = metadata.version
    monkeypatch.setattr(metadata, "version", lambda asked: version if asked == name else real(asked))

    (item,) = [item for item in doctor._packages() if item.name == name]
    assert item.status == "missing"
    assert "change your keys" in item.remedy
