"""What is written where a stranger put a link, a pipe, a device or a folder first: nothing outside changes, and nothing blocks."""

from __future__ import annotations

import argparse
import ast
import os
import re
import resource
import shutil
import signal
import socket
import stat
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

import articad
import articad_bench
from articad.cli import CANNOT_GO_ON, main
from articad.commands.command import COMMANDS as REGISTERED
from articad.commands.command import Unnamed
from articad.errors import ReadError, RunError, WriteError
from articad.geometry.mesh_files import write_stl
from articad.geometry.shapes import tube
from articad.memory.experience import FILE, ExperienceStore
from articad.processes import scratch
from articad.runs.run import Run, RunRequest, UserImage, require_place

pytestmark = pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="Windows has no pipes in folders")
MINE = b"mine"

# ---------------------------------------------------------------------- who writes

WRITING = {"write_bytes", "write_text", "touch", "rename", "symlink_to", "hardlink_to", "symlink", "mkfifo", "mknod"}
WRITING |= {"extractall", "unpack_archive", "mkstemp", "NamedTemporaryFile", "TemporaryFile"}
WRITING |= {"savefig", "tofile", "saveAs", "exportBrep", "exportStep", "write_index", "imwrite", "mimsave", "savetxt"}
TO_STREAMS = {"save", "savez", "savez_compressed", "ZipFile"}  # harmless where the first argument is a stream in memory
STREAMS = ("stream", "buffer", "io.BytesIO(")
PRIVATE = "in a private folder of this process, under a name of its own"
ALLOWED = {
    "processes/scratch.py": "the one function",
    "runs/run.py": "the trace is appended to, through no link; a part is moved within a run; a file without a name tries the disk",
    "kernels/cache.py": "in a new folder, which is renamed to its digest when it is complete",
    "memory/experience.py": "the database of cases, which SQLite writes; only a regular file is opened",
    "plan/schema.py": "calls `plan.writing`, which calls the one function",
    "kernels/worker.py": "the null device",
    "cli.py": "the null device",
    "importers/mjcf_compiled.py": PRIVATE,
    "runs/drawing.py": PRIVATE,
    "runs/exporting.py": PRIVATE,
    "runs/record.py": PRIVATE,
    "simulation/loading.py": PRIVATE,
    "batches/items.py": PRIVATE,
    "export/convex.py": PRIVATE,
    "export/freecad.py": PRIVATE,
    "export/freecad_job.py": PRIVATE,
    "export/freecad_look.py": PRIVATE,
    "export/gaps.py": PRIVATE,
    "export/meshes.py": PRIVATE,
    "kernels/build123d.py": PRIVATE,
    "kernels/freecad.py": PRIVATE,
    "kernels/kernel.py": PRIVATE,
    "kernels/step_assembly.py": PRIVATE,
    "kernels/trees.py": PRIVATE,
    "kernels/views.py": PRIVATE,
    "kernels/inside_freecad/document.py": PRIVATE,
    "kernels/inside_freecad/drawings.py": PRIVATE,
    "kernels/inside_freecad/examine.py": PRIVATE,
    "kernels/inside_freecad/numbered.py": PRIVATE,
    "kernels/inside_freecad/part.py": PRIVATE,
    "kernels/inside_freecad/probe.py": PRIVATE,
    "kernels/inside_freecad/tree.py": PRIVATE,
    "memory/inside_freecad/catalogue.py": PRIVATE,
    "variants.py": PRIVATE,
}
"""Modules that write by themselves, and why no stranger can have put anything in the place of what they write."""


def writers_in(source: str) -> Iterator[str]:
    """Yield what a module has to write a file with."""
    for node in ast.walk(ast.parse(source)):
        if not isinstance(node, ast.Call):
            continue
        name = node.func.attr if isinstance(node.func, ast.Attribute) else node.func.id if isinstance(node.func, ast.Name) else ""
        owner = ast.unparse(node.func.value) if isinstance(node.func, ast.Attribute) else ""
        first = ast.unparse(node.args[0]) if node.args else ""
        if (
            name in WRITING
            or (name.startswith(("copy", "move")) and owner == "shutil")
            or (name == "connect" and owner == "sqlite3")
            or (name == "replace" and len(node.args) + len(node.keywords) == 1)
            or (name == "replace" and owner == "os")
            or (name == "open" and _opens_for_writing(node, owner))
            or (name in TO_STREAMS and node.args and not first.startswith(STREAMS))
        ):
            yield f"{owner}.{name}"


def _opens_for_writing(call: ast.Call, owner: str) -> bool:
    if owner == "os":
        return re.search("WRONLY|RDWR|CREAT|APPEND|TRUNC|flags|mode|writing", ast.unparse(call)) is not None
    of_path = bool(owner) and owner not in {"io", "gzip", "bz2", "lzma", "codecs", "builtins", "tarfile"}
    words = [*call.args[0 if of_path else 1 :], *(word.value for word in call.keywords if word.arg == "mode")]
    modes = [word.value for word in words if isinstance(word, ast.Constant) and isinstance(word.value, str)]
    return any(set(mode) <= set("rwxabt+") and set(mode) & set("wxa+") for mode in modes)


@pytest.mark.parametrize(
    "source",
    [
        "Path('x').write_text('')",
        "Path('x').open('w')",
        "Path('x').open(mode='ab')",
        "open('x', 'r+')",
        "io.open('x', 'wb')",
        "os.open('x', os.O_WRONLY)",
        "os.replace('x', 'y')",
        "Path('x').replace('y')",
        "shutil.copy('x', 'y')",
        "image.save('x.png')",
        "np.savez('x')",
        "zipfile.ZipFile('x', 'w')",
        "sqlite3.connect('x')",
    ],
)
def test_the_search_below_finds_every_way_to_write_a_file(source: str) -> None:
    assert list(writers_in(source))


def test_only_one_function_writes_files_where_others_can_have_put_something() -> None:
    packages = [Path(str(package.__file__)).parent for package in (articad, articad_bench)]
    files = [(file, package) for package in packages for file in sorted(package.rglob("*.py")) if file.parent.name != "parts"]
    found = {
        file.relative_to(package).as_posix(): names
        for file, package in files
        if (names := sorted(set(writers_in(file.read_text(encoding="utf-8")))))
    }
    assert {name: found.get(name) for name in found.keys() ^ ALLOWED.keys()} == {}


# ---------------------------------------------------------------------- the one function


def link(place: Path, outside: Path) -> None:
    place.symlink_to(outside / "mine")


def dangling(place: Path, outside: Path) -> None:
    place.symlink_to(outside / "new")


def device(place: Path, _outside: Path) -> None:
    place.symlink_to("/dev/zero")


def node(place: Path, _outside: Path) -> None:
    """Make a device of its own: who is root could replace those of the system, so no test touches them."""
    try:
        os.mknod(place, stat.S_IFCHR | 0o600, os.makedev(1, 3))
    except PermissionError:  # only root can
        os.mkfifo(place)


def pipe(place: Path, _outside: Path) -> None:
    os.mkfifo(place)


def folder(place: Path, _outside: Path) -> None:
    place.mkdir()


def plug(place: Path, _outside: Path) -> None:
    with socket.socket(socket.AF_UNIX) as made:
        before = Path.cwd()
        os.chdir(place.parent)  # the name of a socket is short
        try:
            made.bind(place.name)
        finally:
            os.chdir(before)


PLANTED = [link, dangling, device, node, pipe, folder, plug]


@pytest.fixture
def outside(tmp_path: Path) -> Path:
    place = tmp_path / "outside"
    place.mkdir()
    (place / "mine").write_bytes(MINE)
    return place


@contextmanager
def soon() -> Iterator[None]:
    """Interrupt what blocks, such as the opening of a pipe that nobody reads."""

    def interrupt(*_: object) -> None:
        raise AssertionError("it blocks")

    before = signal.signal(signal.SIGALRM, interrupt)
    signal.alarm(120)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def untouched(outside: Path) -> bool:
    return {file.name: file.read_bytes() for file in outside.iterdir()} == {"mine": MINE}


@pytest.mark.parametrize("plant", PLANTED)
def test_nothing_but_a_regular_file_is_replaced(plant: Callable[[Path, Path], None], tmp_path: Path, outside: Path) -> None:
    place = tmp_path / "out" / "file"
    place.parent.mkdir()
    plant(place, outside)
    before = place.lstat()
    with soon(), pytest.raises(FileExistsError, match="is in the place of the file"):
        scratch.write(place, b"new")
    assert untouched(outside)
    assert (place.lstat().st_ino, place.lstat().st_mode) == (before.st_ino, before.st_mode)
    assert [file.name for file in place.parent.iterdir()] == ["file"]


def test_a_regular_file_is_replaced_whole_and_its_other_name_keeps_its_content(tmp_path: Path) -> None:
    (tmp_path / "a").write_bytes(MINE)
    os.link(tmp_path / "a", tmp_path / "b")
    scratch.write(tmp_path / "a", b"new")
    assert ((tmp_path / "a").read_bytes(), (tmp_path / "b").read_bytes()) == (b"new", MINE)


def test_an_error_of_a_full_disk_names_the_file_and_the_old_one_is_whole(tmp_path: Path) -> None:
    """The system names none when a file has become too large for its disk."""
    file = tmp_path / "file"
    scratch.write(file, MINE)
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (4096, before[1]))
    try:
        with pytest.raises(OSError, match="too large") as error:
            scratch.write(file, bytes(100_000))
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert error.value.filename == str(file)
    assert [entry.name for entry in tmp_path.iterdir()] == ["file"]
    assert file.read_bytes() == MINE


def test_files_are_on_the_disk_before_they_take_their_names_and_each_folder_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    synced, unsynced = [], []
    sync, replace = os.fsync, Path.replace

    def told_sync(handle: int) -> None:
        synced.append(Path(f"/proc/self/fd/{handle}").readlink())
        sync(handle)

    def told_replace(self: Path, target: Path) -> Path:
        if self not in synced:
            unsynced.append(target)
        return replace(self, target)

    monkeypatch.setattr(os, "fsync", told_sync)
    monkeypatch.setattr(Path, "replace", told_replace)
    files = {tmp_path / folder / str(number): bytes([number]) for folder in "ab" for number in range(100)}
    scratch.write_durably(files)
    assert {path: path.read_bytes() for path in files} == files
    assert unsynced == []
    assert [path for path in synced if path.is_dir()].count(tmp_path / "a") == 1
    assert len(synced) == len(files) + 2
    assert sorted(tmp_path.glob("*/*")) == sorted(files)


# ---------------------------------------------------------------------- every command that writes

ROBOT = """<robot name="r"><link name="a"><visual><geometry><box size=".1 .1 .1"/></geometry></visual>
<collision><geometry><mesh filename="tube.stl"/></geometry></collision></link>
<link name="b"><inertial><mass value="1"/><inertia ixx=".01" iyy=".01" izz=".01" ixy="0" ixz="0" iyz="0"/></inertial><visual><geometry><box size=".1 .1 .1"/></geometry></visual></link>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/><origin xyz="0 0 .2"/><axis xyz="0 0 1"/>
<limit lower="0" upper="1" effort="1" velocity="1"/></joint></robot>"""
COMMANDS = [
    "bom r.urdf --to csv,json,xlsx --cuts --out out",
    "manual r.urdf --to html --out out",
    "order r.urdf --out out/order.json",
    "audit r.urdf --no-engines --budget 0.1 --report out/page.html",
    "audit . --table --no-engines --budget 0.1 --report out/page.html",
    "audit r.urdf --no-engines --budget 0.1 --fix out --density 700 --collision pieces",
    "sim r.urdf --film out/film.png",
    "convert r.urdf out/r.xml",
    "convert r.urdf out/r.sdf",
    "convert r.urdf out/r.usda",
    "convert r.urdf out/r.glb",
    "convert r.urdf out/r.3mf",
    "convert r.urdf out/plan.json",
    "render r.urdf --size 64 --views iso,top --out out",
    "render r.urdf --size 64 --motion j --out out",
    "render r.urdf --size 64 --clean --transparent --out out",
    "show r.urdf --no-browser --out out/page.html",
    "memory export out/cases.jsonl",
    "skill install --dir out",
]


def run(line: str) -> int:
    return main([*line.split(), "--json"])


@pytest.fixture
def work(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    place = tmp_path / "work"
    place.mkdir()
    (place / "r.urdf").write_text(ROBOT)
    (place / "tube.stl").write_bytes(write_stl(tube(0.02, 0.05, 0.1, 8)))
    monkeypatch.chdir(place)
    return place


@pytest.mark.slow
@pytest.mark.parametrize("line", COMMANDS)
def test_no_command_writes_through_what_is_in_the_place_of_a_file(
    line: str, work: Path, outside: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Each kind of file that the command makes is tried with each kind of thing in its place."""
    assert run(line) in {0, 1}, capsys.readouterr()
    made = {file.suffix: file for file in sorted((work / "out").rglob("*")) if file.is_file()}
    assert made
    for file in made.values():
        for plant in (link, dangling, pipe, folder):
            shutil.rmtree(work / "out")
            file.parent.mkdir(parents=True)
            plant(file, outside)
            before = file.lstat()
            with soon():
                assert run(line) == CANNOT_GO_ON, (file, plant)
            told = capsys.readouterr()
            assert file.name in told.out + told.err
            assert "defect" not in told.out + told.err
            assert untouched(outside)
            assert (file.lstat().st_ino, file.lstat().st_mode) == (before.st_ino, before.st_mode)


DEFAULTS = {
    "bom r.urdf": "papers",
    "manual r.urdf --to html": "papers",
    "render r.urdf --size 64 --views iso": "pictures",
    "batch items.jsonl": "batch",
    "skill install": ".claude",
    "build plan": "runs",
}


@pytest.mark.parametrize("line", DEFAULTS)
def test_no_command_writes_by_default_where_a_link_leads(line: str, work: Path, outside: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A user who names the link means it; a default that is a link is somebody else's."""
    (work / "items.jsonl").write_text("{}\n")
    shutil.copytree(Path(articad.__file__).parent / "starter", work / "plan")
    (work / DEFAULTS[line]).symlink_to(outside, target_is_directory=True)

    assert run(line) == CANNOT_GO_ON
    told = capsys.readouterr()
    assert DEFAULTS[line] in told.out + told.err
    assert "link" in told.out + told.err
    assert untouched(outside)


def test_every_folder_that_is_written_to_by_default_is_one_that_may_be_refused() -> None:
    for name, held in REGISTERED.items():
        parser = argparse.ArgumentParser()
        held.arguments(parser)
        for action in parser._actions:
            if action.metavar == "DIR" and isinstance(action.default, str) and action.default != ".":
                assert isinstance(action.default, Unnamed), (name, action.option_strings)


@pytest.mark.parametrize("beside", ["", "-wal", "-journal"])
@pytest.mark.parametrize("plant", PLANTED)
def test_no_case_is_stored_through_what_is_in_the_place_of_the_memory(
    plant: Callable[[Path, Path], None], beside: str, tmp_path: Path, outside: Path
) -> None:
    plant(tmp_path / f"{FILE}{beside}", outside)
    with soon(), pytest.raises((ReadError, WriteError), match="not a file"):
        ExperienceStore(tmp_path).remove("x")
    assert untouched(outside)


def test_no_run_is_made_where_its_pictures_would_leave_it(tmp_path: Path, outside: Path) -> None:
    place = tmp_path / "run"
    place.mkdir()
    (place / "images").symlink_to(outside)
    with pytest.raises(RunError):
        Run.create(RunRequest(prompt="x", images=(UserImage.read(b"\x89PNG\r\n\x1a\n"),)), out=place)
    assert untouched(outside)


def test_trying_whether_a_run_can_be_written_writes_through_no_link(tmp_path: Path, outside: Path) -> None:
    place = tmp_path / "run"
    place.mkdir()
    (place / f"{scratch.BESIDE}probe").symlink_to(outside / "new")
    require_place(RunRequest(prompt="x"), place)
    assert untouched(outside)
