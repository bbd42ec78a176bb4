"""The one place that opens strangers' files: regular, bounded, through no link, and nothing waits."""

from __future__ import annotations

import ast
import io
import os
import socket
import tracemalloc
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

import articad
from articad import files
from articad.errors import ArticadError, ExportError, ReadError
from articad.export.freecad_split import is_part_file
from articad.files import UnsafeFileError, differs, is_file, read_file
from articad.formats import NAMED, write
from articad.geometry.mesh_files import read_mesh
from articad.importers.freecad import read_freecad
from articad.importers.mjcf import read_mjcf
from articad.importers.step import read_step
from articad.importers.urdf import read_urdf
from articad.plan.schema import AssemblyPlan
from articad.runs.run import Run, UserImage
from tests.chains import chain

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


OPENING = frozenset(
    {"open", "fdopen", "read_bytes", "read_text", "copyfile", "copy2", "copytree", "fromfile", "memmap", "genfromtxt", "connect", "TarFile"}
)
OWN = {
    "agents/pictures.py": "what the renderer of articad wrote into a private folder",
    "agents/prompts/__init__.py": "the package's own texts",
    "agents/provider.py": "/proc of its own process",
    "batches/items.py": "hashes of what it has just written",
    "batches/worker.py": "its own output",
    "certificates/verifier_files.py": "a part of a program for itself, which opens files with the same checks",
    "cli.py": "/dev/null",
    "commands/remembering.py": "the package's own examples",
    "commands/showing.py": "the package's own examples; the browser",
    "export/convex.py": "its own cache",
    "export/freecad_job.py": "built parts in the cache, and a private folder",
    "export/freecad_native.py": "a private folder",
    "export/gaps.py": "its own cache",
    "export/meshes.py": "its own cache",
    "export/step.py": "built parts in the cache",
    "files.py": "the one place",
    "importers/mjcf_compiled.py": "in a confined process",
    "kernels/archive.py": "an entry of an archive in memory",
    "kernels/build123d.py": "files that it has made for a confined process, which holds them open",
    "kernels/cache.py": "its own cache",
    "kernels/freecad.py": "files that it has made for a confined process, which holds them open",
    "kernels/inside_freecad/document.py": "in a confined process",
    "kernels/inside_freecad/drawings.py": "in a confined process",
    "kernels/inside_freecad/examine.py": "in a confined process",
    "kernels/inside_freecad/part.py": "in a confined process",
    "kernels/inside_freecad/probe.py": "in a confined process",
    "kernels/inside_freecad/tree.py": "in a confined process",
    "kernels/kernel.py": "built parts in the cache",
    "kernels/landlock.py": "places for the kernel's rules, not read",
    "kernels/trees.py": "its own cache; what a confined process has written",
    "kernels/worker.py": "/dev/null, and /proc of its own process",
    "mcp/server.py": "pictures that a command of articad wrote into a private folder",
    "mcp/skill.py": "the package's own texts",
    "memory/documentation.py": "the package's own texts, its own cache, and what a confined process wrote into a private folder",
    "memory/experience.py": "a database",
    "processes/child.py": "/proc of its own process",
    "processes/launcher.py": "/proc of a process that it has started",
    "processes/scratch.py": "its own folders",
    "report/page.py": "the package's own texts",
    "runs/drawing.py": "pictures that a process of articad wrote into a private folder",
    "runs/exporting.py": "what a process of articad wrote into a private folder",
    "runs/run.py": "files of the kernel; descriptors that are not followed through links",
    "simulation/bullet_trial.py": "a simulator, in a process of its own",
    "simulation/loading.py": "a simulator, in a process of its own",
}
"""Modules that open files by themselves, and which: none of them a path that a stranger chose."""


def test_strangers_files_are_opened_in_one_place() -> None:
    """Whoever opens a file by itself is on the list above, with a reason; a class's own `open` opens none."""
    package = Path(articad.__file__).parent
    found: dict[str, list[str]] = {}
    for path in package.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            called = node.func if isinstance(node, ast.Call) else None
            name = called.attr if isinstance(called, ast.Attribute) else called.id if isinstance(called, ast.Name) else ""
            if name in OPENING and ast.unparse(called) not in {"Run.open", "read_bytes"}:  # type: ignore[arg-type]
                found.setdefault(path.relative_to(package).as_posix(), []).append(f"line {node.lineno}")  # type: ignore[attr-defined]
    assert {name: lines for name, lines in found.items() if name not in OWN} == {}
    assert set(OWN) - set(found) == set()


def test_what_is_no_plain_file_differs(tmp_path: Path) -> None:
    place = tmp_path / "a"
    assert not differs(place, b"x")
    place.write_bytes(b"x")
    assert not differs(place, b"x")
    assert differs(place, b"y")
    assert differs(place, b"")
    for kind in ("pipe", "folder", "/dev/zero"):
        if place.is_dir():
            place.rmdir()
        else:
            place.unlink()
        special(kind, place)
        assert differs(place, b"x")


@pytest.mark.parametrize("kind", ["pipe", "/dev/zero"])
def test_a_mesh_in_the_way_of_an_export_that_is_no_file_is_not_replaced(kind: str, tmp_path: Path) -> None:
    bundle = NAMED["urdf"].write(chain(2))
    name = next(name for name in bundle.files if name != bundle.main)
    (tmp_path / name).parent.mkdir(exist_ok=True)
    special(kind, tmp_path / name)
    with pytest.raises(ExportError, match="which articad did not write"):
        write(chain(2), tmp_path / bundle.main)


@pytest.mark.parametrize("kind", ["bomb", "damaged", "encrypted"])
def test_a_document_in_the_way_of_an_export_is_unpacked_within_bounds(kind: str) -> None:
    """A part's document of somebody else: 1 GiB of zeros in 1 MB, damaged data, an entry that needs a password."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive, archive.open("Document.xml", "w") as stream:
        for _ in range(1 << 10 if kind == "bomb" else 1):
            stream.write(bytes(1 << 20))
    content = bytearray(packed.getvalue())
    if kind == "damaged":
        content[60:90] = bytes(30)
    elif kind == "encrypted":
        content[6] |= 1
        content[content.index(b"PK\1\2") + 8] |= 1
    tracemalloc.start()
    try:
        assert not is_part_file(bytes(content))
        assert tracemalloc.get_traced_memory()[1] < 200 << 20
    finally:
        tracemalloc.stop()
