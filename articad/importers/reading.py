"""Files of unknown origin: XML without entities, paths confined to their folder, limited sizes."""

from __future__ import annotations

import codecs
import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path
from typing import Any
from xml.parsers import expat

from lxml import etree

from articad.assembly import Kept
from articad.errors import ArticadError, ReadError
from articad.files import read_file
from articad.findings import Finding
from articad.geometry.mesh import TriMesh
from articad.geometry.mesh_files import read_mesh, states_colors
from articad.importers.packages import environment_folders, find_package

MAX_XML_BYTES = 64 << 20  # a robot of 10,000 links is 20 MB; more is a mistake or an attack
MAX_LINKS = 10_000
MAX_SHAPES = 2_000  # shapes of one link
MAX_ELEMENTS = 1_000_000  # of a file; a robot of 10,000 links has 200,000
MAX_ATTRIBUTES = 200  # of one element; the parser compares each with each
MAX_ATTRIBUTE = 16 << 20  # characters of one attribute: the vertices of a mesh in MJCF
MAX_URDF_ATTRIBUTE = 1 << 16  # characters; URDF has names and at most six numbers in one
MAX_DEPTH = 50_000  # nesting of elements: a chain of MAX_LINKS bodies, twice
MAX_NAME = 4000  # characters of a name: each object below it repeats it, and so do findings
MAX_FOLDERS = 32  # in the name of a file; each is looked up
_DECLARATION = 1000  # bytes in which an XML declaration ends
_SEVERAL_BYTES = frozenset({"gb18030", "gbk", "gb2312", "hz", "big5", "big5hkscs", "cp932", "cp949", "shift_jis", "euc_jp", "euc_kr"})
"""Encodings with characters of several bytes, which the parser that counts does not know; Python's names."""
MM_PER_M = 1000.0
ELSEWHERE = "Put the mesh where the file names it, or name a folder above both as the root (--root)."
_REMEDY = {
    "E_UNSAFE_PATH": "Keep the named file below the folder of the file that names it, or name a folder above both as the root (--root)."
}
LARGEST_MM = 1e12  # for the position of a frame: beyond it, doubles do not resolve a millimetre


def unreadable(path: Path | str, where: str, reason: str, code: str = "E_READ", hint: str = "") -> ReadError:
    """Return the error that says where a file is wrong, how, and what to do if more than to correct that place."""
    place = f"{path}: {where}" if where else str(path)
    finding = Finding(code=code, where=place, message=reason, hint=hint or _REMEDY.get(code, "Correct the file at the named place."))
    return ReadError(f"{place}: {reason} {hint}".rstrip(), path=str(path), where=where, findings=[finding])


def color_text(rgba: Iterable[float]) -> str:
    """Return "#rrggbb" for a colour's channels from 0 to 1; values outside are clamped."""
    channels = [float(channel) for channel in islice(rgba, 3)]
    return "#" + "".join(f"{round(255 * min(channel, 1.0)) if channel > 0 else 0:02x}" for channel in channels)  # NaN is not above 0


def read_xml(path: Path) -> Any:
    """Return the root element of an XML file, without comments.

    Raises:
        ReadError: If it is missing, too large, not XML, or declares entities.
    """
    try:
        content = read_file(path, MAX_XML_BYTES)
    except OSError as error:
        raise unreadable(path, "", f"It cannot be read: {error.strerror}.") from None
    return parse_xml(content, path)


def parse_xml(content: bytes, path: Path) -> Any:
    """Return the root element of XML text; external references are not loaded, and entities are not expanded."""
    # huge_tree removes the depth limit of 256, which a chain of bodies exceeds; without entities this is not a risk
    parser = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False, huge_tree=True, remove_comments=True, remove_pis=True)
    # widespread errors that other readers forgive: version 0.0, leading blank lines, a zero byte at the end
    content = _in_a_known_encoding(content.strip(b"\0\r\n\t "), path)
    _require_bounded(content, path)
    try:
        root = etree.fromstring(content, parser)
    except (etree.XMLSyntaxError, ValueError) as error:
        raise unreadable(path, f"line {getattr(error, 'lineno', 1)}", f"It is not XML: {error}.") from None
    if root is None:
        raise unreadable(path, "line 1", "It contains no element.")
    if root.getroottree().docinfo.internalDTD is not None and root.getroottree().docinfo.internalDTD.entities():
        raise unreadable(path, "line 1", "It declares entities, which are not expanded.")
    return _without_default_namespace(root)


def _without_default_namespace(root: Any) -> Any:
    """Return the tree without the default namespace of its root: old files state one, and other readers ignore it."""
    namespace = root.nsmap.get(None)
    if namespace is None:
        return root
    for element in root.iter(f"{{{namespace}}}*"):
        if element.prefix is None:
            element.tag = etree.QName(element).localname
    etree.cleanup_namespaces(root, keep_ns_prefixes=[prefix for prefix in root.nsmap if prefix])
    return root


def _in_a_known_encoding(content: bytes, path: Path) -> bytes:
    """Return XML text in an encoding that both parsers know, so that one counts what the other builds; without a version 0.x.

    Raises:
        ReadError: If it is not in the encoding that it states.
    """
    declaration = content[: content.find(b"?>", 0, _DECLARATION) + 2] if content.startswith(b"<?xml") else b""
    stated = re.search(rb"encoding\s*=\s*[\"']([\w.-]+)[\"']", declaration)
    try:
        encoding = codecs.lookup(stated[1].decode()).name if stated else ""
    except LookupError:
        encoding = ""  # the parser that counts refuses it
    if encoding in _SEVERAL_BYTES or (encoding == "utf-8" and stated and stated[1].lower() != b"utf-8"):  # utf8 is a name of it, too
        try:
            return content[len(declaration) :].decode(encoding).encode()
        except UnicodeError as error:
            raise unreadable(path, "line 1", f"It is not XML: {error}.") from None
    return content[len(declaration) :] if re.search(rb"version\s*=\s*[\"']0\.\d[\"']", declaration) else content


def _require_bounded(content: bytes, path: Path) -> None:
    """Count elements, attributes and levels with a parser that builds nothing, before the text reaches the one that builds a tree.

    What the first does not read is not given to the second, which knows more encodings: a text could hide its size in them.

    Raises:
        ReadError: If there are too many, or it is not XML.
    """
    try:
        _Counter(path).count(content)
    except (expat.ExpatError, ValueError, LookupError) as error:  # the latter two: unknown encodings
        raise unreadable(path, f"line {getattr(error, 'lineno', 1)}", f"It is not XML: {error}.") from None


class _Counter:
    """Counts the elements of an XML text."""

    def __init__(self, path: Path) -> None:
        self._path, self._elements, self._depth, self._longest = path, 0, 0, MAX_ATTRIBUTE
        self._parser = expat.ParserCreate()
        self._parser.ordered_attributes = True
        self._parser.StartElementHandler = self._start
        self._parser.EndElementHandler = self._end
        self._parser.EntityDeclHandler = self._entity

    def count(self, content: bytes) -> None:
        self._parser.Parse(content, True)  # noqa: FBT003 - the parser takes no keywords

    def _start(self, name: str, attributes: list[str]) -> None:
        if not self._elements and name == "robot":
            self._longest = MAX_URDF_ATTRIBUTE
        self._elements += 1
        if attributes and (length := max(map(len, attributes))) > self._longest:
            self._refuse(f"An attribute has {length} characters; the maximum is {self._longest}.")
        if "name" in attributes and any(
            key == "name" and len(value) > MAX_NAME for key, value in zip(attributes[::2], attributes[1::2], strict=True)
        ):
            self._refuse(f"A name has more than {MAX_NAME} characters.")
        self._depth += 1
        if len(attributes) > 2 * MAX_ATTRIBUTES:
            self._refuse(f"An element has {len(attributes) // 2} attributes; the maximum is {MAX_ATTRIBUTES}.")
        if self._elements > MAX_ELEMENTS:
            self._refuse(f"It has more than {MAX_ELEMENTS} elements.")
        if self._depth > MAX_DEPTH:
            self._refuse(f"Its elements are nested deeper than {MAX_DEPTH}.")

    def _end(self, _name: str) -> None:
        self._depth -= 1

    def _entity(self, *_words: Any) -> None:
        raise unreadable(self._path, "line 1", "It declares entities, which are not expanded.")

    def _refuse(self, reason: str) -> None:
        raise unreadable(self._path, f"line {self._parser.CurrentLineNumber}", reason)


def is_file_name(name: str) -> bool:
    """Return whether a text may name a file: neither empty nor long, without a zero byte, in few folders."""
    return bool(name) and len(name) <= MAX_NAME and "\0" not in name and name.count("/") <= MAX_FOLDERS


@dataclass
class Folder:
    """The folder from which a file may take other files, and findings about those that could not be read.

    Attributes:
        root: Nothing above it is read.
        here: Folder of the file; relative names start there.
        findings: Meshes that were left out, and why.
        kept: What mesh files state and an assembly does not hold.
    """

    root: Path
    here: Path
    findings: list[Finding] = field(default_factory=list)
    _meshes: dict[tuple[Path, float], TriMesh | ArticadError] = field(default_factory=dict)
    _roots: dict[Path, Path] = field(default_factory=dict)
    kept: list[Kept] = field(default_factory=list)
    _colored: dict[Path, bool] = field(default_factory=dict)

    @classmethod
    def of(cls, path: Path, root: Path | None) -> Folder:
        """Return the folder of a file; its own folder is the root unless another is given."""
        here = path.resolve().parent
        return cls((root or here).resolve(), here)

    def find(self, name: str) -> Path:
        """Return the file for a name: relative to the file or the root, `file://`, `package://name/...` or `model://name/...`.

        A `package://` package is looked for in the folders from the file up to the root, in the root alone if it is not above the file, then
        in the folders of `ROS_PACKAGE_PATH` and `AMENT_PREFIX_PATH`; the file has to lie in the root, or in the package that the environment
        names.

        Raises:
            ReadError: E_UNSAFE_PATH if it leads out; E_READ if there is no such file.
        """
        for candidate, root in self._candidates(name):
            try:
                target = candidate.resolve()
                found = target.is_file()
            except (OSError, RuntimeError, ValueError):  # too long, a link to itself, a zero byte
                raise unreadable(repr(name[:200]), "", "This is not a file name.") from None
            if not target.is_relative_to(root):
                raise unreadable(name, "", f"This name leads out of {root}.", "E_UNSAFE_PATH")
            if found:
                self._roots[target] = root
                return target
        elsewhere = ", nor in ROS_PACKAGE_PATH or AMENT_PREFIX_PATH" if name.startswith("package://") else ""
        raise unreadable(name, "", f"There is no such file below {self.root}{elsewhere}.")

    def root_of(self, target: Path) -> Path:
        """Return the folder that confines a file which `find` returned."""
        return self._roots.get(target, self.root)

    def _candidates(self, name: str) -> list[tuple[Path, Path]]:
        """Return the places where a named file may be, and the folder that confines each."""
        if not is_file_name(name):
            raise unreadable(repr(name[:200]), "", "This is not a file name.")
        scheme, _, path = name.partition("://")
        if scheme in {"package", "model"}:
            package, _, rest = path.partition("/")
            above = [folder for folder in (self.here, *self.here.parents) if folder.is_relative_to(self.root)] or [self.root]
            stated = find_package(package, above) if scheme == "package" else None
            inside = [folder / rest for folder in above if folder.name == package]
            inside += [] if stated is None else [stated / rest]
            inside += [*(folder / package / rest for folder in above), *(folder / rest for folder in above)]
            outside = find_package(package, (), environment_folders()) if scheme == "package" else None
            return [*((place, self.root) for place in inside), *([] if outside is None else [(outside / rest, outside)])]
        plain = Path(name.removeprefix("file://"))
        return [(plain, self.root)] if plain.is_absolute() else [(self.here / plain, self.root), (self.root / plain, self.root)]

    def mesh(self, name: str, scale: tuple[float, float, float], where: str) -> TriMesh | None:
        """Return a mesh in mm, or None and a finding.

        Args:
            name: The name in the file.
            scale: Millimetres per unit of the mesh file, along its axes.
            where: The object that uses it.
        """
        try:
            path = self.find(name)
            uniform = scale[0] if scale[0] == scale[1] == scale[2] > 0 else 1.0
            key = (path, uniform)
            if key not in self._meshes:
                self._meshes[key] = self._read(path, uniform)
            mesh = self._meshes[key]
            if isinstance(mesh, ArticadError):
                raise mesh
        except ArticadError as error:
            if any(finding.code == "E_UNSAFE_PATH" for finding in error.findings):
                raise
            message = f"Mesh {name!r} is left out: {error.message}"
            self.findings.append(Finding(code="W_IMPORT_MESH", where=where, message=message, hint=ELSEWHERE))
            return None
        if uniform == 1.0 and scale != (1.0, 1.0, 1.0):
            stretched = TriMesh(mesh.vertices * scale, mesh.triangles)
            return stretched if scale[0] * scale[1] * scale[2] > 0 else stretched.flipped()
        return mesh

    def unscaled(self, name: str) -> TriMesh | None:
        """Return a mesh in the unit of its file, None if it cannot be read.

        Raises:
            ReadError: E_UNSAFE_PATH if its name leads out.
        """
        count = len(self.findings)
        mesh = self.mesh(name, (1.0, 1.0, 1.0), "")
        del self.findings[count:]
        return mesh

    def keep_colors(self, name: str, where: str) -> None:
        """Record that the colours of a mesh file are lost, if it states any: an assembly has one colour for a shape."""
        path = self.find(name)
        if path not in self._colored:
            self._colored[path] = states_colors(path, self.root_of(path))
        if self._colored[path]:
            self.kept.append(Kept("file", where, f"colours of mesh {name!r}"))

    def _read(self, path: Path, scale: float) -> TriMesh | ArticadError:
        """Return a mesh, or why it cannot be read: every user of the mesh gets the reason."""
        try:
            return read_mesh(path, scale=scale, root=self.root_of(path))
        except ArticadError as error:
            return error
