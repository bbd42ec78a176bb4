"""What is built of the sources is the same bytes each time, and what is installed of it works without them."""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
import sysconfig
import zipfile
from collections.abc import Iterator
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow
ROOT = Path(__file__).resolve().parents[2]
CORE = (
    "tests/plan/test_expressions.py",
    "tests/plan/test_schema.py",
    "tests/agents/test_prompts.py",
)
# What looks at the checkout itself (its documents, scripts and lock) has no meaning away from it.
AWAY = ("tests/supply", "tests/docs", "tests/test_architecture.py")
ALL = (
    "-m",
    "not crash and not fuzz and not corpus and not engines_all and not freecad_next and not slow",
    *(f"--ignore={name}" for name in AWAY),
    "tests",
)
UNNEEDED = {"babel", "material", "mypy", "mypyc", "pip", "pybullet_data", "pybullet_envs"}


def sources(folder: Path) -> Path:
    """Copy what is under version control or about to be, with times of their own."""
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT, capture_output=True, check=False
    )
    if listed.returncode != 0:
        pytest.skip("not a checkout")
    for name in filter(None, listed.stdout.decode().split("\0")):
        if (ROOT / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(ROOT / name, folder / name)
    return folder


def built(folder: Path, out: Path) -> dict[str, str]:
    done = subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-t", "sdist", "-d", str(out)],
        cwd=folder,
        env=os.environ | {"SOURCE_DATE_EPOCH": "1700000000"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr[-2000:]
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in out.iterdir()}


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("dist")
    built(sources(tmp_path_factory.mktemp("sources")), out)
    (path,) = out.glob("*.whl")
    return path


@pytest.fixture(scope="module")
def python(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """The interpreter of an environment that has the wheel and this one's packages, but not the checkout.

    The packages are the same files under a second name: a sandbox hides what lies outside the environment, so links and .pth
    files that lead there would not do.
    """
    home = tmp_path_factory.mktemp("environment")
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", str(home)], check=True)
    (site,) = home.glob("lib/python*/site-packages")
    packages = Path(sysconfig.get_path("purelib"))
    shutil.copytree(packages, site, copy_function=second_name, ignore=left_out, dirs_exist_ok=True)
    zipfile.ZipFile(wheel).extractall(site)
    yield home / "bin" / "python"
    shutil.rmtree(home, ignore_errors=True)


def second_name(source: str, target: str) -> str:
    try:
        os.link(source, target)
    except OSError:  # another file system
        shutil.copy2(source, target)
    return target


def left_out(folder: str, names: list[str]) -> set[str]:
    """What an editable installation of the checkout left; and half of all files, which no test needs, for they take a minute."""
    return {name for name in names if "articad" in name or name in UNNEEDED or (name == "include" and folder.endswith("cmeel.prefix"))}


def test_the_same_sources_give_the_same_bytes(tmp_path: Path) -> None:
    one = sources(tmp_path / "a")
    first = built(one, tmp_path / "dist-a")
    second = built(shutil.copytree(one, tmp_path / "elsewhere" / "b", copy_function=shutil.copyfile), tmp_path / "dist-b")

    assert len(first) == 2
    assert first == second


def test_the_wheel_holds_every_file_that_the_code_opens_and_no_test(wheel: Path) -> None:
    held = set(zipfile.ZipFile(wheel).namelist())
    listed = subprocess.run(["git", "ls-files", "articad"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.split()

    assert {name for name in listed if (ROOT / name).is_file()} <= held
    assert not [name for name in held if name.startswith(("tests/", "docs/", "benchmarks/"))]
    assert not [name for name in held if name.endswith((".pth", ".pyc"))]


@pytest.mark.parametrize("which", [CORE, pytest.param(ALL, marks=pytest.mark.supply)], ids=["core", "all"])
def test_the_installed_wheel_passes_the_tests(which: tuple[str, ...], python: Path, tmp_path: Path) -> None:
    shutil.rmtree(sources(tmp_path) / "articad")
    quiet = {name: value for name, value in os.environ.items() if name not in {"PYTHONPATH", "PYTEST_ADDOPTS"}}
    where = subprocess.run(
        [python, "-c", "import articad; print(articad.__file__)"], cwd=tmp_path, env=quiet, capture_output=True, text=True, check=True
    )
    assert where.stdout.startswith(str(python.parents[1]))

    command = [str(python), "-m", "pytest", "-q", "-p", "no:xdist", "--hypothesis-profile=ci", *which]
    done = subprocess.run(command, cwd=tmp_path, env=quiet, capture_output=True, text=True, check=False)

    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-1000:]


def test_the_installed_wheel_builds_an_assembly_in_its_sandbox(python: Path, tmp_path: Path) -> None:
    shutil.copytree(ROOT / "tests" / "fixtures" / "five_joints", tmp_path / "plan")
    quiet = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    command = [str(python), "-m", "articad.cli", "build", "plan", "--out", "run", "--export", "urdf"]
    done = subprocess.run(
        command, cwd=tmp_path, env=quiet | {"ARTICAD_CACHE": str(tmp_path / "cache")}, capture_output=True, text=True, check=False
    )

    assert (tmp_path / "run" / "export" / "urdf").is_dir(), done.stdout[-2000:] + done.stderr[-2000:]
