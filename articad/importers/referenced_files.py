"""The files that a URDF or MJCF file makes an engine open: all of them must lie inside one folder.

MuJoCo opens whatever a file names: meshes, textures, height fields, included files and whole models, each of which may name more. The
walk below follows includes and models. It refuses a name that leads outside, or to a pipe or device, before an engine reads the file.
Folders that any of these files sets for meshes or textures apply to the names in all of them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import product
from pathlib import Path
from typing import Any

from articad.errors import ReadError
from articad.files import read_file
from articad.geometry.mesh_files import MAX_FILE_BYTES
from articad.importers.reading import MAX_ELEMENTS, MAX_LINKS, Folder, is_file_name, read_xml, unreadable

MAX_FILES = 100  # largest number of files that include each other
MAX_COPIES = 1000  # largest number of copies by <replicate>, <composite> and the like, nested ones multiplied
MAX_COPIED = 200_000  # elements of all copies
MAX_POINTS = 1 << 24  # of textures and height fields that an engine makes: 4096 x 4096
MAX_RESERVED = 1 << 20  # keyframes and user numbers that <size> reserves
MAX_ALL_BYTES = 512 << 20  # of all files that an engine opens for a model
MAX_GROUPS = 10_000  # groups and changes of material in one OBJ; engines make a shape of each
MAX_NAMES = 100_000  # largest number of places in which named files may lie
_IGNORED_SIZES = frozenset({"njmax", "nconmax", "nstack"})  # old names of memory, which the simulation bounds
_FOLDERS = ("meshdir", "texturedir", "assetdir")

Named = list[tuple[str, Path, int]]  # the name, the file that contains it, and the line


def require_closed(path: Path, root: Path | None = None) -> None:
    """Refuse a URDF or MJCF file that names files outside a folder.

    Args:
        path: The file.
        root: The folder; the file's own by default.

    Raises:
        ReadError: E_UNSAFE_PATH if a name leads out; E_READ if one of the files cannot be read, includes form a circle, or counts are
            too large, or the files are.
    """
    _Closure(Folder.of(path, root)).follow(path.resolve())


def package_of(path: Path) -> Path:
    """Return the folder from which a file may take meshes: the nearest ROS package above it, else its own folder."""
    here = path.resolve().parent
    for folder in (here, *here.parents):
        if (folder / "package.xml").is_file():
            return folder
    return here


class _Closure:
    """The files of a model, where they are XML, and the names in them."""

    def __init__(self, folder: Folder) -> None:
        self._folder = folder
        self._seen: list[Path] = []
        self._copied = 0  # elements, counted once per copy
        self._named: set[Path] = set()
        self._bytes = 0  # of the named files
        self._elements = 0  # of all files
        self._points = 0.0  # of textures and height fields without a file

    def follow(self, path: Path) -> None:
        """Read a model with everything that it includes, check its names, then do the same for the models that it names."""
        named: Named = []
        folders: dict[str, None] = {"": None}
        models: Named = []
        self._collect(path, path.parent, named, folders, models, 1)
        if len(named) * len(folders) > MAX_NAMES:
            raise unreadable(
                path, "", f"It names {len(named)} files that may be in {len(folders)} folders: more than {MAX_NAMES} places to look."
            )
        for (name, file, line), base in product(named, folders):
            self._checked(path.parent / base, name, file, line)
        for (name, file, line), base in product(models, folders):
            target = self._checked(path.parent / base, name, file, line)
            if target.is_file() and target not in self._seen:
                self.follow(target)

    def _collect(self, path: Path, here: Path, named: Named, folders: dict[str, None], models: Named, times: int) -> None:
        """Collect the names in a file and its includes; `here` is the folder of the including model, `times` their number of copies."""
        if len(self._seen) >= MAX_FILES:
            raise unreadable(path, "", f"More than {MAX_FILES} files include each other.")
        self._seen.append(path)
        document = self._document(path)
        copies = _copies(document, path, times)
        self._copied += sum(copies.values())
        if self._copied > MAX_COPIED:
            raise unreadable(path, "", f"With all copies it has {self._copied} elements; the maximum is {MAX_COPIED}.")
        self._points += sum(_points(element) for element in document.iter("texture", "hfield"))
        if self._points > MAX_POINTS:
            raise unreadable(
                path, "", f"Its textures and height fields have {self._points:g} points without a file; the maximum is {MAX_POINTS}."
            )
        for element in document.iter("size"):
            _require_few(element, path)
        for element in _read_by_engines(document):
            names = [(value, path, element.sourceline) for name, value in element.attrib.items() if name.startswith("file") and value]
            named += names
            if element.tag == "compiler":
                folders |= dict.fromkeys(element.get(name, "") for name in _FOLDERS)
            elif element.tag == "model":
                models += names
        for element in document.iter("include"):
            self._include(element, path, here, named, folders, models, copies.get(element, times))

    def _document(self, path: Path) -> Any:
        """Return the root element of a file, whose elements and bodies are few."""
        document = read_xml(path)
        self._elements += sum(1 for _ in document.iter())
        if self._elements > MAX_ELEMENTS:
            raise unreadable(path, "", f"With this file the model has {self._elements} elements; the maximum is {MAX_ELEMENTS}.")
        if (bodies := sum(1 for _ in document.iter("body"))) > MAX_LINKS:
            raise unreadable(path, "", f"It has {bodies} bodies; the maximum is {MAX_LINKS}.")
        return document

    def _include(self, element: Any, path: Path, here: Path, named: Named, folders: dict[str, None], models: Named, times: int) -> None:
        """Follow an include; engines resolve its name relative to the file or to the model, so both are followed."""
        name = element.get("file", "")
        places = dict.fromkeys(self._checked(base, name, path, element.sourceline) for base in (path.parent, here))
        for number, target in enumerate(place for place in places if place.is_file()):
            if target not in self._seen:
                self._collect(target, here, named, folders, models, times)
            elif number == 0:
                raise unreadable(path, f"line {element.sourceline}", f"{name!r} is included again; includes must not form a cycle.")

    def _checked(self, base: Path, name: str, file: Path, line: int) -> Path:
        """Return the file for a name, which lies inside the root."""
        where = f"line {line}"
        if name and not is_file_name(name):
            raise unreadable(file, where, f"{name[:200]!r} is not a file name.")
        if name.startswith("package://"):
            try:
                target = self._folder.find(name)
            except ReadError as error:
                if "E_UNSAFE_PATH" in error.findings.codes:
                    raise
                return base / "package:"  # there is no such file: engines report that themselves
            self._require_small(target, name, file, where)
            return target
        try:
            target = (base / name.removeprefix("file://")).resolve()
            is_other = target.exists() and not target.is_file() and not target.is_dir()
        except (OSError, RuntimeError, ValueError):  # too long, a link to itself, a zero byte
            raise unreadable(file, where, f"{name[:200]!r} is not a file name.") from None
        if not target.is_relative_to(self._folder.root):
            raise unreadable(file, where, f"{name!r} leads out of {self._folder.root}.", "E_UNSAFE_PATH")
        if is_other:
            raise unreadable(file, where, f"{name!r} is neither a file nor a folder but a pipe, a socket or a device.", "E_UNSAFE_PATH")
        self._require_small(target, name, file, where)
        return target

    def _require_small(self, target: Path, name: str, file: Path, where: str) -> None:
        """Refuse a file that is too large for an engine, or too large together with those before it."""
        if target in self._named or not target.is_file():
            return
        size = target.stat().st_size
        self._named.add(target)
        self._bytes += size
        if size > MAX_FILE_BYTES:
            raise unreadable(file, where, f"{name!r} has {size} bytes; the maximum is {MAX_FILE_BYTES}.")
        if target.suffix.lower() == ".obj":
            content = read_file(target, MAX_FILE_BYTES)
            if (groups := sum(content.count(word) for word in (b"\ng ", b"\no ", b"\nusemtl "))) > MAX_GROUPS:
                raise unreadable(file, where, f"{name!r} has {groups} groups and changes of material; the maximum is {MAX_GROUPS}.")
        if self._bytes > MAX_ALL_BYTES:
            raise unreadable(file, where, f"The files named up to here have {self._bytes} bytes; the maximum is {MAX_ALL_BYTES}.")


def _read_by_engines(document: Any) -> Iterator[Any]:
    """Yield the elements in which engines look for files; in URDF not those of Gazebo, ros2_control and others."""
    if document.tag != "robot":
        yield from document.iter()
        return
    yield from document.iter("mesh", "texture")
    for block in document.iter("mujoco"):
        yield from block.iter()


def _copies(document: Any, path: Path, times: int) -> dict[Any, int]:
    """Return how often each element that engines read is copied, by the counts of the elements around it; `times` for the file itself.

    Raises:
        ReadError: If a count is not a number, or the product of nested counts is too large.
    """
    if document.tag == "robot" and document.find("mujoco") is None:
        return {}
    copies: dict[Any, int] = {}
    for element in document.iter():  # parents come before their children
        above = copies.get(element.getparent(), times)
        copies[element] = count = above * (_count(element, path) if "count" in element.attrib else 1)
        if count > MAX_COPIES:
            raise unreadable(path, f"line {element.sourceline}", f"It requests {count} copies; the maximum is {MAX_COPIES}.")
    return copies


def _require_few(element: Any, path: Path) -> None:
    """Refuse a size element that makes an engine reserve too much.

    Raises:
        ReadError: If one of its counts is too large; what is not a number is left to the engine to refuse.
    """
    for name, text in element.attrib.items():
        if name.startswith("n") and name not in _IGNORED_SIZES:
            try:
                count = float(text)
            except ValueError:
                continue
            if not count <= MAX_RESERVED:
                raise unreadable(path, f"line {element.sourceline}", f"{name} is {text[:40]}; the maximum is {MAX_RESERVED}.")


def _points(element: Any) -> float:
    """Return how many points an engine makes for a texture or a height field that no file states."""
    sides = ("width", "height") if element.tag == "texture" else ("nrow", "ncol")
    try:
        return math.prod(max(float(element.get(side, "1")), 1.0) for side in sides) * (6 if element.get("type") == "cube" else 1)
    except ValueError:
        return 0.0  # the engine refuses it


def _count(element: Any, path: Path) -> int:
    """Return the product of the numbers of a count; a non-number that engines may accept counts as one."""
    try:
        numbers = [float(word) for word in element.get("count").split()]
        return math.prod(max(math.ceil(number), 1) for number in numbers)
    except (ValueError, OverflowError):
        text = element.get("count")[:40]
        raise unreadable(path, f"line {element.sourceline}", f"{text!r} is not a valid number of copies.") from None
