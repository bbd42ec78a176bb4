"""The XML of a FreeCAD file, and of the files that it links to: objects by name, with their properties.

Nothing outside the folder that the caller names is read. A link to a missing file is an error that names the file.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator, Sequence
from itertools import count
from pathlib import Path
from typing import Any, NamedTuple

from articad.connectors.se3 import SE3
from articad.errors import ArticadError, ReadError
from articad.export.freecad_split import join, listed
from articad.files import read_file
from articad.importers.reading import LARGEST_MM, MAX_ELEMENTS, MAX_LINKS, MAX_XML_BYTES, Folder, color_text, parse_xml, unreadable
from articad.kernels.archive import Archive, BadArchiveError

MAX_BYTES, MAX_UNPACKED, MAX_ENTRIES = 256 * 2**20, 384 * 2**20, 20_000
MAX_FILES = 200  # that one document may link to, directly or not
MAX_ALL_XML = 128 * 2**20  # bytes of Document.xml and GuiDocument.xml in a document and all that it links to
MAX_ALL_BYTES = 512 * 2**20  # of their files
MAX_DEPTH = 50  # of groups within groups and links to links
MAX_MEMBERS = 2 * MAX_LINKS  # of an assembly, a part or a folder, those of all groups in it, each counted as often as it is shown
MAX_LISTED = 300_000  # members of all groups together: a folder counts in each group that shows it
MAX_WALKED = 100_000  # groups and shapes of all parts together: what several parts show counts in each

IDENTITY = SE3.identity()
_GROUPS = ("App::Part", "App::DocumentObjectGroup", "Assembly::AssemblyObject", "Assembly::AssemblyLink")
_LINKS = ("App::Link", "Assembly::AssemblyLink")
_DATUMS = (  # objects in a body with frames of their own; beginnings of their types
    *("Sketcher::Sketch", "PartDesign::Point", "PartDesign::Line", "PartDesign::Plane", "PartDesign::CoordinateSystem"),
    *("Part::Datum", "Part::LocalCoordinateSystem", "App::Point", "App::Line", "App::Plane", "App::Origin", "App::LocalCoordinateSystem"),
)


class FreeCADDocument:
    """The XML of a FreeCAD file: objects by name, with their properties.

    Attributes:
        path: The file.
        types: Type by object.
        items: XML element by object.
        sizes: Bytes of the file, bytes and elements of its Document.xml and GuiDocument.xml.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            content = read_file(path, MAX_BYTES)
            self.archive = Archive(content, entries=MAX_ENTRIES, unpacked=MAX_UNPACKED)
            text = self.archive.read("Document.xml", MAX_XML_BYTES)
        except OSError as error:
            raise unreadable(path, "", f"It cannot be read: {error.strerror}.") from None
        except BadArchiveError as error:
            raise unreadable(path, "", f"It is not a FreeCAD file: {error}.") from None
        self.root = parse_xml(text, path)
        shown = self._shown_text()
        self._gui = None if shown is None else parse_xml(shown, path)
        elements = sum(1 for root in (self.root, self._gui) if root is not None for _ in root.iter())
        self.sizes = (len(content), len(text) + len(shown or b""), elements)
        self._files: dict[str, tuple[Archive, str]] = {}  # entries of other files
        self._painted: dict[str, str] = {}  # colours of the objects of other files
        self.index()

    def _shown_text(self) -> bytes | None:
        """Return what a window of FreeCAD stored, or None where there is nothing, or nothing that can be unpacked."""
        try:
            return self.archive.read("GuiDocument.xml", MAX_XML_BYTES)
        except BadArchiveError:
            return None

    def index(self) -> None:
        """Find the objects and their properties in the XML; again after documents were taken."""
        self.types = {item.get("name", ""): item.get("type", "") for item in self.root.iterfind("Objects/Object")}
        self.items = {item.get("name", ""): item for item in self.root.iterfind("ObjectData/Object")}
        self._links: dict[tuple[str, str], tuple[str, ...]] = {}  # once they were asked for
        self._properties = {
            name: {row.get("name"): row for row in item.iterfind("Properties/Property")} for name, item in self.items.items()
        }

    def take(self, other: FreeCADDocument) -> None:
        """Add the objects of a part's file, which articad divided from this one: both then read like one document, once `index` is called.

        Raises:
            ReadError: If the file is not like the one that was written.
        """
        if None in (root.find(tag) for root in (self.root, other.root) for tag in ("Objects", "ObjectData")):
            raise unreadable(other.path, "Document.xml", "It has no objects.")
        self._painted |= other.colors()
        for element in other.root.iter():
            if (name := element.get("file")) in other.archive.names:
                element.set("file", f"{other.path.stem}/{name}")
                self._files[f"{other.path.stem}/{name}"] = (other.archive, name)
        join(self.root, other.root, other.path.stem)

    def entry(self, name: str | None) -> bytes | None:
        """Return a file in the archive of this document, or of one that it took, or None.

        Raises:
            BadArchiveError: If it cannot be unpacked.
        """
        archive, own = self._files.get(name or "", (self.archive, name or ""))
        return archive.read(own) if own in archive.names else None

    def value(self, name: str, key: str, tag: str, attribute: str = "value") -> str | None:
        """Return an attribute of the first element of a tag in a property, or None."""
        row = self._properties.get(name, {}).get(key)
        found = None if row is None else row.find(f".//{tag}")
        return None if found is None else found.get(attribute)

    def row(self, name: str, key: str, tag: str) -> Any:
        """Return the first element of a tag in a property, or None."""
        row = self._properties.get(name, {}).get(key)
        return None if row is None else row.find(f".//{tag}")

    def keys(self, name: str) -> list[str]:
        """Return the names of an object's properties."""
        return list(self._properties.get(name, {}))

    def text(self, name: str, key: str) -> str:
        """Return a property of text, or an empty one."""
        return self.value(name, key, "String") or ""

    def has(self, name: str, key: str) -> bool:
        """Return whether an object has a property."""
        return key in self._properties.get(name, {})

    def truth(self, name: str, key: str, *, default: bool = False) -> bool:
        """Return a property that is true or false."""
        value = self.value(name, key, "Bool")
        return default if value is None else value == "true"

    def number(self, name: str, key: str) -> float:
        """Return a property that is a number, 0 where there is none.

        Raises:
            ReadError: If it is not a plausible number.
        """
        try:
            number = float(self.value(name, key, "Float") or 0.0)
        except ValueError:
            raise unreadable(self.path, f"{name}.{key}", "It is not a number.") from None
        if not abs(number) <= LARGEST_MM:  # also refuses NaN
            raise unreadable(self.path, f"{name}.{key}", "It is not a plausible number.")
        return number

    def choice(self, name: str, key: str) -> str:
        """Return the chosen word of an enumeration.

        Raises:
            ReadError: If the choice is not a whole number.
        """
        row = self._properties[name][key]
        found = row.find(".//Integer")
        try:
            index = -1 if found is None else int(found.get("value") or 0)
        except ValueError:
            raise unreadable(self.path, f"{name}.{key}", "It is not a whole number.") from None
        options = [option.get("value") for option in row.iterfind(".//Enum")]
        return str(options[index]) if 0 <= index < len(options) else ""

    def links(self, name: str, key: str) -> Sequence[str]:
        """Return the objects that a property links to."""
        if (name, key) not in self._links:
            row = self._properties.get(name, {}).get(key)
            found = () if row is None else (entry for entry in row.iter() if entry.tag in ("Link", "XLink"))
            self._links[name, key] = tuple(entry.get("value") or entry.get("name") or "" for entry in found)
        return self._links[name, key]

    def is_shape(self, name: str) -> bool:
        """Return whether an object is a body or a solid of the Part workbench, such as a box or a cut."""
        kind = self.types.get(name, "")
        return kind == "PartDesign::Body" or (kind.startswith("Part::") and not kind.startswith(("Part::Part2D", "Part::Datum")))

    def results(self, members: list[str]) -> list[str]:
        """Return the shapes among the members of a group from which no other member is made."""
        shapes = dict.fromkeys(name for name in members if self.is_shape(name))
        used = {link for name in shapes for key in self._properties[name] if key != "Group" for link in self.links(name, str(key))}
        held = [name for name in members if (name in shapes or self.types.get(name) in (*_GROUPS, *_LINKS)) and name not in used]
        shown = [name for name in held if self.truth(name, "Visibility", default=True)]
        return shown or held

    def placement(self, name: str, key: str = "Placement") -> SE3:
        """Return a placement, the identity where there is none.

        Raises:
            ReadError: If it is not a placement, or its position is not plausible.
        """
        row = self._properties.get(name, {}).get(key)
        found = None if row is None else row.find("PropertyPlacement")
        if found is None:
            return IDENTITY
        try:
            numbers = [float(found.get(axis)) for axis in ("Px", "Py", "Pz", "Q0", "Q1", "Q2", "Q3")]
            placed = SE3.from_quaternion(numbers[3:], numbers[:3])
        except (TypeError, ValueError, ArticadError):
            raise unreadable(self.path, f"{name}.{key}", "It is not a placement.") from None
        if max(map(abs, numbers[:3])) > LARGEST_MM:
            raise unreadable(self.path, f"{name}.{key}", "Its position is not plausible.")
        return placed

    def colors(self) -> dict[str, str]:
        """Return "#rrggbb" by object, for objects whose colour a window of FreeCAD stored."""
        found = dict(self._painted)
        for provider in () if self._gui is None else self._gui.iterfind("ViewProviderData/ViewProvider"):
            rows = {row.get("name"): row for row in provider.iterfind("Properties/Property")}
            kind = self.types.get(provider.get("name", ""), "")
            color = self._override(rows) if kind == "App::Link" else self._shown(rows)
            if color is not None:
                found[provider.get("name", "")] = color
        return found

    def _override(self, rows: dict[str, Any]) -> str | None:
        """Return the colour that a link shows in place of its object's."""
        switch, material = rows.get("OverrideMaterial"), rows.get("ShapeMaterial")
        if switch is None or material is None or switch.find("Bool") is None or switch.find("Bool").get("value") != "true":
            return None
        held = material.find("PropertyMaterial")
        return None if held is None else _packed_color(held.get("diffuseColor"))

    def _shown(self, rows: dict[str, Any]) -> str | None:
        """Return the colour of a shape: of FreeCAD 1.0's list of materials, else of the property of older ones."""
        listed = rows["ShapeAppearance"].find("MaterialList") if "ShapeAppearance" in rows else None
        file = None if listed is None else listed.get("file")
        if file and file in self.archive.names:
            try:
                content = self.archive.read(file, 2**20)
                count, _ambient, diffuse = struct.unpack_from("<III", content)
            except (BadArchiveError, struct.error):
                return None
            return _packed_color(str(diffuse)) if count else None
        color = rows["ShapeColor"].find("PropertyColor") if "ShapeColor" in rows else None
        return None if color is None else _packed_color(color.get("value"))


def _require_few(shown: Iterator[int], item: FreeCADObject) -> None:
    """Count one more object of an assembly or a part. Groups that show others twice can show 2⁵⁰ with fifty objects.

    Raises:
        ReadError: If there are too many.
    """
    if next(shown) > MAX_MEMBERS:
        raise unreadable(item.document.path, item.name, f"With all groups in it, more than {MAX_MEMBERS} objects are shown.")


def _packed_color(text: str | None) -> str | None:
    """Return "#rrggbb" of a colour in one number, red in the highest byte and alpha in the lowest."""
    try:
        number = int(text or "")
    except ValueError:
        return None
    return color_text((number >> shift & 0xFF) / 255 for shift in (24, 16, 8))


class FreeCADObject(NamedTuple):
    """An object of a document."""

    document: FreeCADDocument
    name: str

    @property
    def type(self) -> str:
        """Its FreeCAD type."""
        return str(self.document.types.get(self.name, ""))

    @property
    def placement(self) -> SE3:
        """Its pose in the object that contains it."""
        return self.document.placement(self.name)

    def text(self, key: str) -> str:
        """Return a property of text, or an empty one."""
        return self.document.text(self.name, key)

    @property
    def is_shape(self) -> bool:
        """True for a body or a solid of the Part workbench."""
        return self.document.is_shape(self.name)


class LinkedDocuments:
    """A document and the documents that it links to.

    Args:
        path: The document.
        root: No file outside it is read; by default the document's folder.

    Attributes:
        main: The document.
    """

    def __init__(self, path: Path, root: Path | None) -> None:
        self._root = root
        self._sizes = [0, 0, 0]
        self._members: dict[FreeCADObject, list[FreeCADObject]] = {}  # of groups, once they were asked for
        self._shown = 0  # members of them all
        self._walked = 0  # groups and shapes that were shown
        self.main = self._opened(path)
        self._read = {path.resolve(): self.main}
        here = path.resolve().parent
        for file in listed(self.main.root)[:MAX_FILES]:
            try:
                found = Folder((root or here).resolve(), here).find(file)
            except ReadError as error:
                if any(finding.code == "E_UNSAFE_PATH" for finding in error.findings):
                    raise
                continue  # whatever links to it is refused with its name
            if found not in self._read:
                self.main.take(self._opened(found))
                self._read[found] = self.main
        self.main.index()

    def _opened(self, path: Path) -> FreeCADDocument:
        """Read a document; refuse it if all documents together are too large to hold.

        Raises:
            ReadError: If they are, or it cannot be read.
        """
        document = FreeCADDocument(path)
        self._sizes = [before + more for before, more in zip(self._sizes, document.sizes, strict=True)]
        bounds = (MAX_ALL_BYTES, MAX_ALL_XML, MAX_ELEMENTS)
        for size, most, what in zip(self._sizes, bounds, ("bytes", "bytes of XML", "elements"), strict=True):
            if size > most:
                raise unreadable(path, "", f"With this file the documents have {size} {what}; the maximum is {most}.")
        return document

    def linked(self, item: FreeCADObject, key: str) -> FreeCADObject | None:
        """Return the object that a property links to, or None if it links to none.

        Raises:
            ReadError: If it is in a file that is missing, or outside the root.
        """
        link = item.document.row(item.name, key, "XLink")
        if link is None:
            name = next(iter(item.document.links(item.name, key)), "")
            return FreeCADObject(item.document, name) if name in item.document.items else None
        document = self._document(item, link.get("file") or "")
        name = link.get("name") or ""
        if name not in document.items:
            if not name and not link.get("file"):
                return None
            raise unreadable(
                document.path, name, f"{item.name} of {item.document.path.name} links to this object, which the file does not have."
            )
        return FreeCADObject(document, name)

    def container(self, item: FreeCADObject) -> FreeCADObject:
        """Return the object that a link shows, through links to links, or the object itself."""
        for _ in range(MAX_DEPTH):
            if item.type not in _LINKS:
                return item
            target = self.linked(item, "LinkedObject")
            if target is None:
                return item
            item = target
        raise unreadable(item.document.path, item.name, "Its links form a cycle.")

    def members(self, item: FreeCADObject) -> list[FreeCADObject]:
        """Return the members of a group, those of folders in it included.

        Raises:
            ReadError: If it has too many, or all groups together, which may show one folder each.
        """
        if item not in self._members:
            self._members[item] = self._listed(item)
            self._shown += len(self._members[item])
            if self._shown > MAX_LISTED:
                raise unreadable(item.document.path, item.name, f"All groups together have more than {MAX_LISTED} members.")
        return self._members[item]

    def _listed(self, item: FreeCADObject) -> list[FreeCADObject]:
        """Return the members of a group, found anew."""
        found, seen = [], 0
        waiting = [(name, 0) for name in reversed(item.document.links(item.name, "Group"))]
        while waiting:
            name, depth = waiting.pop()
            if item.document.types.get(name) == "App::DocumentObjectGroup" and depth < MAX_DEPTH:
                waiting += [(member, depth + 1) for member in reversed(item.document.links(name, "Group"))]
            else:
                found.append(FreeCADObject(item.document, name))
            seen += 1
            if seen + len(waiting) > MAX_MEMBERS:
                raise unreadable(item.document.path, item.name, f"It has more than {MAX_MEMBERS} members.")
        return found

    def components(
        self, item: FreeCADObject, T: SE3 = IDENTITY, depth: int = 0, shown: Iterator[int] | None = None
    ) -> Iterator[tuple[FreeCADObject, SE3]]:
        """Yield the members of an assembly, each with the pose of the group that contains it.

        FreeCAD's solver moves the members of a flexible sub-assembly one by one, so they are members of the assembly around it.

        Args:
            item: The assembly.
            T: Pose of the frame of `item`.
            depth: Number of assemblies around it.
            shown: Counts the members of the outermost assembly; a new one by default.

        Raises:
            ReadError: If assemblies are nested too deep, or show too many members.
        """
        if depth > MAX_DEPTH:
            raise unreadable(item.document.path, item.name, "Its assemblies are nested too deep.")
        shown = shown or count()
        for member in self.members(item):
            _require_few(shown, item)
            flexible = member.type == "Assembly::AssemblyLink" and not member.document.truth(member.name, "Rigid", default=True)
            if flexible and member.document.links(member.name, "Group"):
                yield from self.components(member, T @ member.placement, depth + 1, shown)
            else:
                yield member, T

    def shapes(
        self, item: FreeCADObject, T: SE3 = IDENTITY, depth: int = 0, shown: Iterator[int] | None = None
    ) -> Iterator[tuple[FreeCADObject, SE3]]:
        """Yield the bodies, solids and meshes of a part, each with the pose of its stored shape in the part's frame.

        Args:
            item: The part, or the object that it links to.
            T: Pose of the frame of `item`.
            depth: Number of groups around it.
            shown: Counts the groups and shapes of the outermost part; a new one by default.

        Raises:
            ReadError: If groups and links are nested too deep, or show too many shapes.
        """
        if depth > MAX_DEPTH:
            raise unreadable(item.document.path, item.name, "Its groups and links are nested too deep.")
        shown = shown or count()
        _require_few(shown, item)
        self._walked += 1
        if self._walked > MAX_WALKED:
            raise unreadable(item.document.path, item.name, f"All parts together show more than {MAX_WALKED} groups and shapes.")
        if item.is_shape or item.type == "Mesh::Feature":
            yield item, T @ item.placement.inverse() if item.is_shape else T  # B-rep is stored in the frame of the object's group
            return
        if item.type in _LINKS:
            target = self.container(item)
            if target != item:
                yield from self.shapes(target, T, depth + 1, shown)
            return
        members = [member.name for member in self.members(item)]
        meshes = [name for name in members if item.document.types.get(name) == "Mesh::Feature"]
        for name in [*item.document.results(members), *meshes]:
            member = FreeCADObject(item.document, name)
            yield from self.shapes(member, T @ member.placement, depth + 1, shown)

    def reference(self, item: FreeCADObject, key: str) -> list[FreeCADObject]:
        """Return the objects along a reference whose placements lead to its frame, starting at the one that states it.

        A reference to a face of a body goes on into the feature that made the face: `Body.Pad.Face5`. FreeCAD states the frame in the body
        (or the link to it), so the placement of the feature says nothing. Only sketches and datums of a body have a frame of their own.
        See `getObject` in FreeCAD's Mod/Assembly/UtilsAssembly.py.
        """
        link = item.document.row(item.name, key, "XLink")
        if link is None:
            return []
        sub = link.find("Sub")
        tail = (sub.get("value") if sub is not None else link.get("sub")) or ""
        document = self._document(item, link.get("file") or "")
        steps: list[FreeCADObject] = []
        if tail.count(".") > MAX_DEPTH:
            raise unreadable(item.document.path, item.name, f"A reference leads through more than {MAX_DEPTH} objects.")
        for name in (link.get("name") or "", *tail.split(".")[:-1]):
            if name not in document.items:
                continue
            step = FreeCADObject(document, name)
            if steps and self.container(steps[-1]).is_shape and not step.type.startswith(_DATUMS):
                break
            steps.append(step)
            inside = step.type == "Assembly::AssemblyLink" and step.document.links(step.name, "Group")
            document = step.document if inside else self.container(step).document  # a sub-assembly has links of its own to its parts
        return steps

    def element(self, item: FreeCADObject, key: str) -> str:
        """Return the face, edge or vertex that a reference names, such as `Face5`; an empty text for a whole object."""
        link = item.document.row(item.name, key, "XLink")
        sub = None if link is None else link.find("Sub")
        tail = "" if link is None else (sub.get("value") if sub is not None else link.get("sub")) or ""
        return str(tail.rpartition(".")[2])

    def _document(self, item: FreeCADObject, file: str) -> FreeCADDocument:
        """Return the document of a link: that of the object, or the file that it names."""
        if not file:
            return item.document
        here = item.document.path.resolve().parent
        folder = Folder((self._root or self.main.path.resolve().parent).resolve(), here)
        try:
            path = folder.find(file)
        except ArticadError as error:
            if any(finding.code == "E_UNSAFE_PATH" for finding in error.findings):
                raise
            raise unreadable(
                item.document.path, item.name, f"It links to {file[:200]!r}, which is not below {folder.root}. Put the file there."
            ) from None
        if path not in self._read:
            if len(self._read) >= MAX_FILES:
                raise unreadable(item.document.path, item.name, f"The documents link to more than {MAX_FILES} files.")
            self._read[path] = self._opened(path)
        return self._read[path]
