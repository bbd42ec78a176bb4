"""A FreeCAD assembly as one file for each part: divides a document that articad wrote, and joins the files again.

Each `App::Part` goes into a file of its own, the VarSet of the parameters into another one. The assembly keeps an `App::Link` under the
name that the part had, so joints refer to the same paths as before. An expression that names an object of another file is written as
`file#object`, with the file in the `XLinks` of its property; FreeCAD 1.0 and 1.1 then follow it, and open the file with the assembly.
"""

from __future__ import annotations

import io
import re
import zipfile
from collections.abc import Iterator, Mapping
from copy import deepcopy
from pathlib import PurePosixPath
from typing import Any

from lxml import etree

from articad.errors import ExportError
from articad.export.freecad_content import Content, content_of
from articad.findings import Finding
from articad.kernels.archive import Archive, BadArchiveError
from articad.kernels.freecad_file import EPOCH, packed, xml_parser

FILES = "ArticadFiles"
"""The property of the assembly that lists the files of the parts, one a line, relative to the assembly's file."""

_REFERENCE = "ArticadReference"  # the property of a link that only shows what another file holds
_CONTAINING = ("Group", "Origin", "OriginFeatures")  # properties whose objects are in the same file
_OF_LINKS = ("Label", "Label2", "Visibility", "ExpressionEngine", "Placement")  # what the link in the assembly takes over from its part
_NAMED = re.compile(r"(?<![\w.#>])([A-Za-z_]\w*)(?=\.[A-Za-z_])")  # the objects that an expression names
_FILE_OF = re.compile(r"(?:<<[^<>]*>>|\b\w+)#")  # the file that it names before an object
_OURS = "written by articad"  # in the comment of each part's file
_ENTRIES, _DOCUMENT_BYTES = 20_000, 64 << 20  # of the file of a part that is in the way
_OWN = "Articad"  # beginning of the names of articad's own properties


def split(content: bytes, folder: str) -> dict[str, bytes]:
    """Return the files of an assembly document, one for each part; the assembly, which links to them, has the name "".

    Args:
        content: The document.
        folder: Name of the folder for the parts, beside the assembly's file.

    Raises:
        ExportError: If a part refers to another one in a way that cannot cross files.
    """
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        files = {name: archive.read(name) for name in archive.namelist() if name != "GuiDocument.xml"}
    divided = _Divided(etree.fromstring(files.pop("Document.xml"), xml_parser()), folder)
    found = {}
    for path, root in divided.roots():
        held = {element.get("file") for element in root.iter() if element.get("file") in files}
        document = etree.tostring(root, xml_declaration=True, encoding="utf-8", standalone=False)
        found[path] = packed({"Document.xml": document} | {name: data for name, data in files.items() if name in held})
    return found


def is_part_file(content: bytes) -> bool:
    """Return whether `split` wrote a file, so that another export may replace it."""
    try:  # it may be anybody's file: unpacked within bounds
        return _OURS.encode() in Archive(content, entries=_ENTRIES, unpacked=_DOCUMENT_BYTES).read("Document.xml")
    except BadArchiveError:
        return False


def content_of_files(files: Mapping[str, bytes]) -> Content:
    """Return the content of the document that `split` divided into these files."""
    roots = {}
    for path, content in files.items():
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            roots[path] = etree.fromstring(archive.read("Document.xml"), xml_parser())
    root = roots.pop("")
    for path, other in roots.items():
        join(root, other, PurePosixPath(path).stem)
    return content_of(root)


def listed(root: Any) -> list[str]:
    """Return the files of the parts that an assembly document lists; none if it is one file."""
    row = root.find(f"ObjectData/Object/Properties/Property[@name='{FILES}']/String")
    return [] if row is None else [file for file in row.get("value", "").split("\n") if file]


def join(root: Any, other: Any, name: str) -> None:
    """Add the objects of a part's document to the document of its assembly, so that both read like the one that `split` divided.

    Args:
        root: Root element of the assembly's Document.xml, which is changed.
        other: Root element of the part's.
        name: Of the part's file, for objects that have the name of another one.
    """
    rows, data = root.find("Objects"), root.find("ObjectData")
    for item in [item for item in data if _is_reference(item)]:
        _drop(rows, data, item.get("name"))
    taken = {item.get("name") for item in data}
    shown = {item.get("name") for item in other.iterfind("ObjectData/Object") if _is_reference(item)}
    for source, target in ((other.find("Objects"), rows), (other.find("ObjectData"), data)):
        for item in source.iterfind("Object"):
            if item.get("name") not in shown:
                added = deepcopy(item)
                added.set("name", f"{name}#{item.get('name')}" if item.get("name") in taken else item.get("name"))
                target.append(added)
    for row in root.iter("Expression"):
        row.set("expression", _FILE_OF.sub("", row.get("expression", "")))


def _is_reference(item: Any) -> bool:
    return item.find(f"Properties/Property[@name='{_REFERENCE}']") is not None


def _drop(rows: Any, data: Any, name: str) -> None:
    for group in (rows, data):
        for item in group.findall(f"Object[@name='{name}']"):
            group.remove(item)


class _Divided:
    """The objects of a document, by the file in which each one is."""

    def __init__(self, root: Any, folder: str) -> None:
        self.root, self.folder = root, folder
        self.kinds = {item.get("name"): item.get("type") for item in root.iterfind("Objects/Object")}
        self.items = {item.get("name"): item for item in root.iterfind("ObjectData/Object")}
        self.assembly = next(name for name, kind in self.kinds.items() if kind == "Assembly::AssemblyObject")
        self.parts = [name for name in self._linked(self.assembly, ("Group",)) if self.kinds.get(name) == "App::Part"]
        self.inside = {name: f"{name}__part" for name in self.parts}  # part -> name of its App::Part in its own file
        self.home: dict[str, str] = {}  # object -> part in whose file it is, or "Parameters"
        if self.kinds.get("Parameters") == "App::VarSet":
            self.home["Parameters"] = "Parameters"
        contained = {name for item in self.items for name in self._linked(item, _CONTAINING)}
        for part in self.parts:
            self._take(part, contained)

    def roots(self) -> Iterator[tuple[str, Any]]:
        """Yield the path of each file, and the root element of its Document.xml."""
        names = [*(["Parameters"] if "Parameters" in self.home else []), *self.parts]
        yield "", self._document("", {name for name in self.items if name not in self.home} | {*self.parts, *names})
        for name in names:
            yield f"{self.folder}/{name}.FCStd", self._document(name, {item for item, home in self.home.items() if home == name})

    def _linked(self, name: str, keys: tuple[str, ...] | None = None) -> list[str]:
        """Return the objects of this document to which an object links, by some properties or by all."""
        rows = self.items[name].iterfind("Properties/Property")
        links = [link for row in rows if keys is None or row.get("name") in keys for link in row.iter("Link", "LinkSub", "XLink")]
        return [found for link in links if (found := link.get("value") or link.get("name") or link.get("obj")) in self.items]

    def _take(self, part: str, contained: set[str]) -> None:
        """Put a part with all that it contains into its file; also what it needs and no object contains."""
        waiting = [part]
        while waiting:
            name = waiting.pop()
            if name in self.home or (name in self.parts and name != part):
                continue
            self.home[name] = part
            waiting += self._linked(name, _CONTAINING)
            waiting += [other for other in self._linked(name) if other not in contained and other not in (self.assembly, "Parameters")]

    def _document(self, here: str, names: set[str]) -> Any:
        """Return a document with some of the objects. `here` is the part, or "" for the assembly."""
        root = deepcopy(self.root)
        rows, data = root.find("Objects"), root.find("ObjectData")
        rows.attrib.pop("Dependencies", None)  # with these, FreeCAD would load the file in part and not save it
        for needs in rows.findall("ObjectDeps"):
            rows.remove(needs)
        for group in (rows, data):
            for item in [item for item in group.findall("Object") if item.get("name") not in names]:
                group.remove(item)
            group.set("Count", str(len(names)))
        for item in list(data):
            self._settle(item, here)
        for row in rows.findall("Object"):
            name = row.get("name")
            if not here and self.home.get(name):
                row.set("type", "App::Link")
            elif name in self.inside:
                row.set("name", self.inside[name])
        if here:
            self._describe(root.find("Properties"), here)
        return root

    def _describe(self, about: Any, part: str) -> None:
        """Give a part's document its label, and a comment that says where it belongs."""
        about.find("Property[@name='Label']/String").set("value", self._label(part))
        for row in about.findall("Property[@name='Comment']"):
            about.remove(row)
        text = f"Of {self._label(self.assembly)}, {_OURS}"
        _add(about, _property("Comment", "String", etree.Element("String", {"value": text})))

    def _label(self, name: str) -> str:
        return str(self.items[name].find("Properties/Property[@name='Label']/String").get("value"))

    def _settle(self, item: Any, here: str) -> None:
        """Make an object one of its file: a link in the assembly, or a part with links and expressions that name other files."""
        name = item.get("name")
        if not here and self.home.get(name):
            self._become_link(item, name)
        elif name == here and name in self.inside:
            item.set("name", self.inside[name])
            self._become_part(item.find("Properties"))
        elif not here and name == self.assembly:
            text = "\n".join(f"{self.folder}/{file}.FCStd" for file in dict.fromkeys(self.home.values()))
            _add(
                item.find("Properties"), _property(FILES, "String", etree.Element("String", {"value": text}), own="The files of the parts")
            )
        for row in item.iter("XLink"):
            self._point(row, here, name)
        for row in item.iter("Link", "LinkSub"):
            target = row.get("value") or row.get("obj")
            if (here or target not in self.inside) and self.home.get(target, here) != here:
                raise _refused(self._label(here) if here else self.assembly, name, str(target))
        for row in item.iter("ExpressionEngine"):
            self._name_files(row, here)

    def _become_part(self, properties: Any) -> None:
        """Leave the name and the placement to the link in the assembly."""
        for row in properties.findall("Property[@name='ArticadPart']"):
            properties.remove(row)
        for row in properties.iterfind("Property[@name='Placement']/PropertyPlacement"):
            row.attrib.update(dict.fromkeys(("Px", "Py", "Pz", "Q0", "Q1", "Q2"), "0") | {"Q3": "1"})
        for entry in properties.findall("Property[@name='ExpressionEngine']/ExpressionEngine/Expression[@path='Placement']"):
            entry.getparent().remove(entry)
        _add(properties)

    def _become_link(self, item: Any, name: str) -> None:
        for child in list(item):
            item.remove(child)
        item.set("Extensions", "True")
        extensions = etree.SubElement(item, "Extensions", {"Count": "1"})
        etree.SubElement(extensions, "Extension", {"type": "App::LinkExtension", "name": "LinkExtension"})
        rows = self.items[name].iterfind("Properties/Property")
        kept = [deepcopy(row) for row in rows if row.get("name") in _OF_LINKS or row.get("name").startswith(_OWN)]
        if name == "Parameters":
            kept = [row for row in kept if row.get("name") in ("Label", "Visibility")]
            kept.append(_property(_REFERENCE, "String", etree.Element("String", {"value": name}), own="Shows the parameters"))
        placed = next((row for row in kept if row.get("name") == "Placement"), None)
        if placed is not None:
            kept.append(moved := deepcopy(placed))
            moved.set("name", "LinkPlacement")
        target = etree.Element("XLink", {"file": "", "stamp": "", "name": name})
        kept.append(_property("LinkedObject", "XLink", target))
        properties = etree.SubElement(item, "Properties", {"Count": str(len(kept)), "TransientCount": "0"})
        for row in kept:
            if not row.get("name").startswith(_OWN):
                row.attrib.pop("status", None)  # of a property of App::Part
            properties.append(row)

    def _point(self, row: Any, here: str, owner: str) -> None:
        """Name the file of what a link shows; a joint refers to the links in the assembly instead."""
        target = row.get("name")
        home = self.home.get(target)
        shows = row.getparent().get("name") == "LinkedObject"
        if home is None or home == here or (not here and not shows and target in self.inside):
            return
        if not shows:
            raise _refused(self._label(here) if here else self.assembly, owner, target)
        row.attrib.update({"file": self._path(home, here), "stamp": EPOCH, "name": self.inside.get(target, target)})

    def _path(self, home: str, here: str) -> str:
        return f"{home}.FCStd" if here else f"{self.folder}/{home}.FCStd"

    def _name_files(self, engine: Any, here: str) -> None:
        """Write `file#object` for each object of another file that an expression names."""
        used: dict[str, str] = {}  # object -> its file

        def named(match: re.Match[str]) -> str:
            name = match[1]
            home = self.home.get(name, here)
            if home == here or (not here and name in self.inside):
                return name
            used[name] = home
            return f"{home}#{name}"

        for row in engine.iter("Expression"):
            row.set("expression", _NAMED.sub(named, row.get("expression", "")))
        engine.set("count", str(len(engine.findall("Expression"))))
        if not used:
            return
        engine.set("xlink", "1")
        objects, homes = sorted(used), sorted(set(used.values()))
        links = etree.Element("XLinks", {"count": str(len(objects)), "docs": str(len(homes))})
        for home in homes:
            index = next(place for place, name in enumerate(objects) if used[name] == home)
            etree.SubElement(links, "DocMap", {"name": home, "label": self._label(home), "index": str(index)})
        for name in objects:
            etree.SubElement(links, "XLink", {"file": self._path(used[name], here), "stamp": EPOCH, "name": name})
        engine.insert(0, links)


def _add(properties: Any, *rows: Any) -> None:
    """Add properties, and count them all: those that FreeCAD does not keep have a count of their own."""
    properties.extend(rows)
    properties.set("Count", str(len(properties.findall("Property"))))


def _property(name: str, kind: str, value: Any, *, own: str = "") -> Any:
    given = {"group": "articad", "doc": own, "attr": "4", "ro": "0", "hide": "0"} if own else {}
    row = etree.Element("Property", {"name": name, "type": f"App::Property{kind}"} | given)
    row.append(value)
    return row


def _refused(part: str, owner: str, target: str) -> ExportError:
    message = f"{owner} in part {part!r} refers to {target}, which is in the file of another part."
    finding = Finding(code="E_FREECAD", where=f"parts.{part}", message=message, hint="Export the assembly as one file.", stage="export")
    return ExportError(f"{message} Export the assembly as one file.", findings=[finding])
