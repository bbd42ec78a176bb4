"""The one place that opens strangers' files: regular, bounded, through no link, and nothing waits."""

from __future__ import annotations

import ast
import os
import socket
from collections.abc import Callable
from pathlib import Path

import pytest

import articad
from articad import files
from articad.errors import ArticadError, ReadError
from articad.files import UnsafeFileError, is_file, read_file
from articad.geometry.mesh_files import read_mesh
from articad.importers.freecad import read_freecad
from articad.importers.mjcf import read_mjcf
from articad.importers.step import read_step
from articad.importers.urdf import read_urdf
from articad.plan.schema import AssemblyPlan
from articad.runs.run import Run, UserImage

SECRET = "the-first-word-of-a-secret"


def special(kind: str, path: Path) -> Path:
    """Make a file that is no file."""
    if kind == "pipe":
        os.mkfifo(path)
    elif kind == "socket":
        with socket.socket(socket.AF_UNIX) as made:
            made.bind(str(path))
    elif kind == "folder":
        path.mkdir()
    else:
        path.symlink_to(kind)
    return path


READERS: dict[str, Callable[[Path], object]] = {
    "plan.json": AssemblyPlan.load,
    "a.urdf": read_urdf,
    "a.xml": read_mjcf,
    "a.FCStd": read_freecad,
    "a.step": read_step,
    "a.stl": read_mesh,
    "a.png": UserImage.read,
}


@pytest.mark.parametrize("kind", ["pipe", "socket", "/dev/zero", "/dev/stdin"])
@pytest.mark.parametrize("name", READERS)
def test_no_reader_waits_for_or_drinks_from_what_is_no_file(name: str, kind: str, tmp_path: Path) -> None:
    with pytest.raises(ReadError, match=r"not a file|No such device"):
        READERS[name](special(kind, tmp_path / name))


@pytest.mark.parametrize("size", [0, 1, 99, 100, 101, 5_000_000])
def test_no_more_than_the_bound_is_read(size: int, tmp_path: Path) -> None:
    path = tmp_path / "x"
    path.write_bytes(b"y" * size)
    if size <= 100:
        assert read_file(path, 100) == b"y" * size
    else:
        with pytest.raises(UnsafeFileError, match="larger than 100"):
            read_file(path, 100)


def test_a_file_that_grows_is_read_to_the_bound(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path, read = tmp_path / "x", os.read
    path.write_bytes(b"y")

    def growing(file: int, count: int) -> bytes:
        with path.open("ab") as stream:
            stream.write(b"y" * 100)
        return read(file, count)

    monkeypatch.setattr(os, "read", growing)
    with pytest.raises(UnsafeFileError, match="larger than 1000"):
        read_file(path, 1000)


def outside(tmp_path: Path) -> tuple[Path, Path]:
    """Return a root, and a secret file beside it."""
    root, secret = tmp_path / "root", tmp_path / "elsewhere" / "secret"
    (root / "inner").mkdir(parents=True)
    secret.parent.mkdir()
    secret.write_text(SECRET)
    (root / "inner" / "file").write_text("fine")
    return root, secret


def test_below_a_root_no_component_may_be_a_link(tmp_path: Path) -> None:
    root, secret = outside(tmp_path)
    (root / "link").symlink_to(secret)
    (root / "folder").symlink_to(secret.parent)
    (root / "inside").symlink_to(root / "inner")
    (tmp_path / "way").symlink_to(root)

    assert read_file(root / "inner" / "file", 10, root=root) == b"fine"
    assert read_file(tmp_path / "way" / "inner" / "file", 10, root=tmp_path / "way") == b"fine"  # the root is the user's own
    for name in ("link", "folder/secret", "inside/file"):
        with pytest.raises(UnsafeFileError, match="a link leads to it"):
            read_file(root / name, 100, root=root)
        assert not is_file(root / name, root=root)
    for name in ("../elsewhere/secret", "inner/../../elsewhere/secret", "."):
        with pytest.raises(UnsafeFileError, match="outside"):
            read_file(root / name, 100, root=root)
    with pytest.raises(FileNotFoundError):
        read_file(root / "nothing", 100, root=root)


def test_a_root_of_the_whole_process_holds_for_every_reader(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    root, secret = outside(tmp_path)
    monkeypatch.setenv(files.ROOT_VARIABLE, str(root))
    for name, reader in READERS.items():
        (root / name).symlink_to(secret)
        for path in (root / name, secret):
            with pytest.raises(ArticadError) as caught:
                reader(path)
            assert SECRET not in str(caught.value)


@pytest.mark.parametrize("name", ["plan.json", "request.json", "requirements.json", "checks.json", "trace.jsonl", "parts/lid/part.json"])
def test_a_run_and_a_project_lead_nowhere_else(name: str, tmp_path: Path) -> None:
    root, secret = outside(tmp_path)
    link = root / name
    link.parent.mkdir(parents=True, exist_ok=True)
    link.symlink_to(secret)
    with pytest.raises(ArticadError) as caught:
        Run.view(root)
    assert SECRET not in str(caught.value)
    if name == "plan.json":
        with pytest.raises(ReadError, match="a link leads to it"):
            AssemblyPlan.load(root)


def test_readers_of_strangers_files_open_none_themselves() -> None:
    package = Path(articad.__file__).parent
    readers = [*package.glob("importers/*.py"), *package.glob("plan/*.py"), package / "geometry" / "mesh_files.py"]
    for path in readers:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            called = node.func if isinstance(node, ast.Call) else None
            name = called.attr if isinstance(called, ast.Attribute) else called.id if isinstance(called, ast.Name) else ""
            if path.name not in {"writing.py", "xacro.py", "mjcf_compiled.py"}:  # the latter two read and write in confined processes
                assert name not in {"read_bytes", "read_text", "open", "fdopen"}, f"{path} line {getattr(node, 'lineno', 0)}"
