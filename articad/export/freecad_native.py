"""A FreeCAD document written without FreeCAD: the file is a zip of XML and B-rep, in the form of FreeCAD 1.0.

It contains what FreeCAD itself would write for the same data, except trees of features, which only FreeCAD can copy. FreeCAD fills in
what is omitted when it opens the file. What is written is needed: a part of an assembly without its origin is invalid, and a joint must
be in two groups.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from lxml import etree
from lxml.etree import _Element as Element

from articad.aliases import Json
from articad.connectors.se3 import SE3
from articad.errors import ExportError
from articad.export.freecad_content import PROPERTY
from articad.export.freecad_file import Appearance
from articad.export.names import Names
from articad.findings import Finding
from articad.kernels.freecad_file import packed

FIRST_ID = 100_000  # of objects, the same as when FreeCAD writes them
_HALF = 0.7071067811865476
_ORIGIN = {  # the lines and planes of an origin: their types and orientations
    "X_Axis": ("App::Line", (0.0, 0.0, 0.0, 1.0)),
    "Y_Axis": ("App::Line", (0.5, 0.5, 0.5, 0.5)),
    "Z_Axis": ("App::Line", (0.5, -0.5, 0.5, 0.5)),
    "XY_Plane": ("App::Plane", (0.0, 0.0, 0.0, 1.0)),
    "XZ_Plane": ("App::Plane", (_HALF, 0.0, 0.0, _HALF)),
    "YZ_Plane": ("App::Plane", (0.5, 0.5, 0.5, 0.5)),
}
_KINDS = (
    "Fixed",
    "Revolute",
    "Cylindrical",
    "Slider",
    "Ball",
    "Distance",
    "Parallel",
    "Perpendicular",
    "Angle",
    "RackPinion",
    "Screw",
    "Gears",
    "Belt",
)
_UNIT_KINDS = {"mm": "Distance", "deg": "Angle", "1": "Float"}  # FreeCAD's properties for the units of parameters
_STAYS = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]
_NO_XML = re.compile(r"[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")  # characters that XML cannot contain
_READ_ONLY = str(1 << 21 | 1 << 2)  # a property of the object itself that the property editor shows but does not change
_NULL = "bnVsbA=="  # base64 of null: FreeCAD's state of a Python object without one


def document(job: Json, folder: Path, names: Names) -> tuple[bytes, Appearance]:
    """Return a document, and its appearance when it is opened.

    Args:
        job: Its content; see `freecad_job.Job`.
        folder: Folder with the files that the job names.
        names: Names of its objects.

    Raises:
        ExportError: If a B-rep is not text.
    """
    writer = _Writer(job, folder, names)
    writer.write()
    look = Appearance(writer.colors, tuple(writer.hidden), tuple(joint["object"] for joint in job["joints"]), "GroundedJoint")
    return packed({"Document.xml": writer.xml()} | writer.files), look


@dataclass
class _Object:
    """An object of the document: its type, its properties, and what FreeCAD calls its extension."""

    name: str
    kind: str
    properties: list[Element]
    extension: str = ""

    def data(self) -> Element:
        """Return the object with its properties, as Document.xml lists it."""
        inner = [_row("Properties", *self.properties, Count=len(self.properties), TransientCount=0)]
        if not self.extension:
            return _row("Object", *inner, name=self.name)
        extension = _row("Extension", type=f"App::{self.extension}", name=self.extension)
        return _row("Object", _row("Extensions", extension, Count=1), *inner, name=self.name, Extensions="True")


class _Writer:
    """Collects the objects of a document and its files."""

    def __init__(self, job: Json, folder: Path, names: Names) -> None:
        self.job, self.folder, self.names = job, folder, names
        self.objects: list[_Object] = []
        self.files: dict[str, bytes] = {}
        self.colors: dict[str, str] = {}
        self.hidden: list[str] = []
        self.containers: dict[str, str] = {}  # part -> its App::Part, or that of its source
        self.shapes: dict[str, str] = {}
        self.items = {part["name"]: part["object"] for part in job["parts"]}
        self.systems: dict[tuple[str, str], str] = {}
        self.labels: set[str] = {job["name"]}
        self.numbers: dict[str, int] = {}  # label -> the number that it gets next

    def write(self) -> None:
        if self.job["parameters"]:
            self._values("Parameters", self.job["parameters_label"], "p", "Parameters", self.job["parameters"])
        origin = self._origin()
        place = len(self.objects)
        for part in self.job["parts"]:
            self._part(part)
        joints = ["GroundedJoint", *(joint["object"] for joint in self.job["joints"])]
        self._add("Joints", "Assembly::JointGroup", _links("Group", joints), extension="GroupExtension")
        grounded = next(part for part in self.job["parts"] if part["name"] == self.job["ground"])
        self._add(
            "GroundedJoint",
            "App::FeaturePython",
            _link("ObjectToGround", grounded["object"], "Ground"),
            _placement("Placement", grounded["placement"], "Ground"),
            _proxy("GroundedJoint"),
        )
        for joint in self.job["joints"]:
            self._joint(joint)
        members = [*(part["object"] for part in self.job["parts"]), self._bill(), self.job["bill"]["object"]]
        self.labels.discard(self.job["name"])
        assembly = [
            _text("ArticadRecords", "\n".join(self.job["records"]), "articad", "articad's records, for the way back", attr=4),
            _text(PROPERTY, "", "articad", "The content of the document when articad wrote it", attr=4),
            _links("Group", [*members, "Joints", *joints]),
            _link("Origin", origin),
            _placement("Placement", _STAYS),
            _text("Type", "Assembly"),
        ]
        self._add("Assembly", "Assembly::AssemblyObject", *assembly, label=self.job["name"], extension="OriginGroupExtension", at=place)

    def xml(self) -> bytes:
        """Return Document.xml."""
        rows = [_row("Object", type=item.kind, name=item.name, id=FIRST_ID + number) for number, item in enumerate(self.objects)]
        # FreeCAD's own property names; freecad_file.normalised completes them like those of a file that FreeCAD wrote
        empty = [_text(name, "") for name in ("CreatedBy", "CreationDate", "LastModifiedBy", "LastModifiedDate")]
        about = [_text("Label", self.job["name"]), *empty, _property("Uid", "UUID", _row("Uuid", value=""))]
        root = _row(
            "Document",
            _row("Properties", *about, Count=len(about), TransientCount=0),
            _row("Objects", *rows, Count=len(rows)),
            _row("ObjectData", *(item.data() for item in self.objects), Count=len(self.objects)),
            SchemaVersion=4,
            ProgramVersion="1.0R",
            FileVersion=1,
        )
        etree.indent(root)
        return bytes(etree.tostring(root, xml_declaration=True, encoding="utf-8", standalone=False))

    def _add(
        self,
        name: str,
        kind: str,
        *properties: Element,
        label: str = "",
        extension: str = "",
        expressions: Mapping[str, str] | None = None,
        at: int | None = None,
    ) -> str:
        own = [
            _expressions(expressions or {}),
            _text("Label", self._label(label or name)),
            _property("Visibility", "Bool", _row("Bool", value="false")),
        ]
        self.objects.insert(len(self.objects) if at is None else at, _Object(name, kind, [*own, *properties], extension))
        return name

    def _label(self, wanted: str) -> str:
        """Return a label that no other object has, formed like FreeCAD's."""
        free, number = wanted, self.numbers.get(wanted, 1)
        while free in self.labels:
            free, number = f"{wanted}{number:03d}", number + 1
        self.numbers[wanted] = number
        self.labels.add(free)
        return free

    def _origin(self) -> str:
        """Add an origin with its lines and planes, and return its name."""
        features = []
        for role, (kind, turn) in _ORIGIN.items():
            name = self.names.claim(role)
            features.append(
                self._add(name, kind, _text("Role", role), _placement("Placement", [0.0, 0.0, 0.0, *turn]), label=role.replace("_", "-"))
            )
        return self._add(
            self.names.claim("Origin"),
            "App::Origin",
            _links("OriginFeatures", features),
            label="Origin",
            extension="GeoFeatureGroupExtension",
        )

    def _values(self, name: str, label: str, prefix: str, group: str, rows: Sequence[Json]) -> str:
        """Add a VarSet of numbers that may follow others."""
        numbers = []
        for row in rows:
            note = f"{row['description']} [{row['unit']}] {row['why']}".strip() if "unit" in row else ""
            fixed = not row.get("live", True)
            named, kind = f"Fixed {group.lower()}" if fixed else group, _UNIT_KINDS[row.get("unit", "1")]
            numbers.append(_number(f"{prefix}_{row['name']}", row["value"], named, note, fixed=fixed, kind=kind))
        followed = {f"{prefix}_{row['name']}": row["expression"] for row in rows if row["expression"]}
        return self._add(name, "App::VarSet", *numbers, label=label, expressions=followed)

    # ------------------------------------------------------------------ parts

    def _part(self, part: Json) -> None:
        name, item = part["name"], part["object"]
        placed = {"Placement": part["placed"]} if part["placed"] else {}
        told = [
            _text("Label2", part["description"]),
            _text("ArticadPart", name, "articad", "Name of the part"),
            _text("ArticadMaterial", part["material"] or "", "articad", "Name of its material"),
            _placement("Placement", part["placement"]),
        ]
        if part["kind"] == "link":
            source = part["source"]
            self.containers[name] = self.containers[source]
            self.shapes[name] = self.shapes[source]
            if part["recolored"]:
                self.colors[item] = part["color"]
            for connector in part["connectors"]:
                self.systems[name, connector["name"]] = self.systems[source, connector["name"]]
            target = [_target("LinkedObject", self.containers[source]), _placement("LinkPlacement", part["placement"])]
            mass, follows = self._mass(part)
            self._add(item, "App::Link", *target, *told, *mass, label=name, extension="LinkExtension", expressions=placed | follows)
            return
        origin = self._origin()
        place = len(self.objects)
        self.containers[name] = item
        members = []
        if part["dimensions"]:
            values = self.names.claim(f"Dimensions_{item}")
            rows = [row | {"live": False} for row in part["dimensions"]]
            members.append(self._values(values, f"{name} dimensions (frozen shape)", "d", "Dimensions", rows))
        members += self._shape(part)
        members += [self._connector(part, connector) for connector in part["connectors"]]
        mass, follows = self._mass(part)
        told, placed = [*told, *mass], placed | follows
        grouped = [_links("Group", members), _link("Origin", origin)]
        self._add(item, "App::Part", *grouped, *told, label=name, extension="OriginGroupExtension", expressions=placed, at=place)

    def _mass(self, part: Json) -> tuple[list[Element], dict[str, str]]:
        """Return the properties of a part's mass, and their expressions: the mass follows the volume of its shape."""
        mass = part["mass"]
        if mass is None:
            return [], {}
        if mass["density"] is None or part["kind"] in ("mesh", "empty"):
            note = "Mass when articad wrote the document; it does not follow the shape"
            return [_number("ArticadMass", mass["kg"], "articad", note, fixed=True, kind="Mass")], {}
        note = "Density of the material when articad wrote the document"
        density = _number("ArticadDensity", mass["density"] * 1e-9, "articad", note, fixed=True, kind="Density")  # kg/mm³
        row = _number("ArticadMass", mass["kg"], "articad", "Volume times density", fixed=True, kind="Mass")
        return [density, row], {"ArticadMass": f"{self.shapes[part['name']]}.Shape.Volume * 1 mm^3 * ArticadDensity"}

    def _bill(self) -> str:
        """Add FreeCAD's own bill of materials and return its group."""
        bill, copies = self.job["bill"], Counter(self.containers[part["name"]] for part in self.job["parts"])
        names = ("Index", "Name", "Quantity", *bill["columns"])
        columns = [_row("String", value=name) for name in names]
        listed = _property("columnsNames", "StringList", _row("StringList", *columns, count=len(columns)))
        flat = _property("detailParts", "Bool", _row("Bool", value="false"))
        rows = [[f"'{name}" for name in names]]
        for part in (part for part in self.job["parts"] if part["kind"] != "link"):
            shown = [f"={part['object']}.{key}" if key != "ArticadMass" or part["mass"] else "" for key in bill["columns"].values()]
            rows.append([f"'{len(rows)}", f"'{part['name']}", str(copies[part["object"]]), *shown])
        cells = [
            _row("Cell", address=f"{chr(ord('A') + place)}{number}", content=text)
            for number, row in enumerate(rows, start=1)
            for place, text in enumerate(row)
            if text
        ]
        sheet = _row("Cells", _row("XLinks", count=0), *cells, Count=len(cells), xlink=1)
        held = _property("cells", "", sheet, family="Spreadsheet::PropertySheet")
        self._add(bill["object"], "Assembly::BomObject", held, listed, flat, label="Bill of materials")
        return self._add(
            bill["group"], "Assembly::BomGroup", _links("Group", [bill["object"]]), label="Bills of materials", extension="GroupExtension"
        )

    def _shape(self, part: Json) -> list[str]:
        """Add the object that shows the part, and return it with its constituents."""
        body, kind = self.names.claim(f"{part['object']}_body"), part["kind"]
        self.shapes[part["name"]] = body
        self.colors[body] = part["color"]
        label = f"{part['name']} body (frozen)"  # only FreeCAD can copy features
        if kind == "mesh":
            self.files[f"{body}.bms"] = (self.folder / part["file"]).read_bytes()
            mesh = _property("Mesh", "Mesh", _row("Mesh", file=f"{body}.bms"), family="Mesh::PropertyMeshKernel")
            return [self._add(body, "Mesh::Feature", mesh, _placement("Placement", _STAYS), label=label)]
        if kind == "empty":
            return [self._add(body, "Part::Feature", _placement("Placement", _STAYS))]
        brep = (self.folder / part["file"]).read_bytes()
        self.files[f"{body}.Shape.brp"] = brep
        stored = _row("Part", ElementMap="0.4", file=f"{body}.Shape.brp")
        shape = [
            _property("Shape", "PartShape", stored, _row("ElementMap"), family="Part::PropertyPartShape"),
            _placement("Placement", _stands(brep)),
        ]
        if part["card"]:
            shape.append(_property("ShapeMaterial", "", _row("PropertyMaterial", uuid=part["card"]), family="Materials::PropertyMaterial"))
        if kind == "shape":
            return [self._add(body, "Part::Feature", *shape, label=label)]
        source = self.names.claim(f"{part['object']}_source")
        self.hidden.append(source)
        target = _target("LinkedObject", self.shapes[part["source"]])
        with_placement = _truth("LinkTransform", value=True)  # of the shape, which a link leaves out otherwise
        self._add(source, "App::Link", target, with_placement, extension="LinkExtension")
        plane = [_vector("Base", part["plane"]["point"], "Position"), _vector("Normal", part["plane"]["normal"], "Direction")]
        image = self._add(body, "Part::Mirroring", _link("Source", source), *plane, *shape, label=label, expressions=part["expressions"])
        return [source, image]

    def _connector(self, part: Json, connector: Json) -> str:
        expressions = dict(connector["expressions"])
        if part["kind"] == "mirror":
            names = {"source": self.systems[part["source"], connector["name"]], "image": self.shapes[part["name"]]}
            expressions |= {f"Placement.Base.{axis}": text.format(**names) for axis, text in zip("xyz", part["reflected"], strict=True)}
        self.systems[part["name"], connector["name"]] = connector["object"]
        return self._add(
            connector["object"],
            "PartDesign::CoordinateSystem",
            _text("ArticadConnector", connector["name"], "articad", "Name of the connector"),
            _text("ArticadLabel", connector["label"], "articad", "What it is on the part"),
            _placement("Placement", connector["placement"]),
            label=f"{part['name']}.{connector['name']}",
            expressions=expressions,
        )

    # ------------------------------------------------------------------ joints

    def _joint(self, joint: Json) -> None:
        properties = [
            _text("ArticadJoint", joint["name"], "articad", "Name of the joint or coupling"),
            _choice("JointType", _KINDS, joint["type"]),
            _truth("Activated", value=joint["active"]),
            _proxy("Joint"),
        ]
        for number, side in enumerate(("parent", "child"), start=1):
            part, connector = joint[side], joint[f"{side}_connector"]
            path, group = f"{self.items[part]}.{self.systems[part, connector]}.", f"Joint Connector {number}"
            subs = [_row("Sub", value=path), _row("Sub", value=path)]
            link = _row("XLink", *subs, file="", stamp="", name="Assembly", count=2)
            properties += [
                _property(f"Reference{number}", "XLinkSubHidden", link, group=group),
                _placement(f"Offset{number}", joint[f"offset_{number}"], group),
                _placement(f"Placement{number}", joint[f"offset_{number}"], group),  # in the frame of a coordinate system
                _truth(f"Detach{number}", value=False, group=group),
            ]
        properties += [_number(name, value, "Joint", "") for name, value in joint["distances"].items()]
        for name, value in joint["limits"].items():
            properties += [_truth(f"Enable{name}", value=True, group="Limits"), _limit(name, value, followed=name in joint["expressions"])]
        self._add(joint["object"], "App::FeaturePython", *properties, label=joint["label"], expressions=joint["expressions"])


def _stands(brep: bytes) -> list[float]:
    """Return the placement stored in a B-rep: that of its object must be the same.

    Raises:
        ExportError: If it is not text.
    """
    found = re.search(rb"^Locations (\d+)$(.*?)^Curve2ds ", brep, re.MULTILINE | re.DOTALL)
    last = brep.rstrip().rsplit(b"\n", 1)[-1].split()
    if found is None or len(last) != 2:
        finding = Finding(code="E_FREECAD", where="assembly", message="A B-rep is not in OCCT's text form.", hint="Build the parts again.")
        raise ExportError(str(finding), findings=[finding])
    words, held = iter(found[2].split()), [np.eye(4)]
    for _ in range(int(found[1])):
        if next(words) == b"1":
            held.append(np.vstack([np.array([float(next(words)) for _ in range(12)]).reshape(3, 4), [0.0, 0.0, 0.0, 1.0]]))
            continue
        T = np.eye(4)
        while (number := int(next(words))) != 0:
            T = T @ np.linalg.matrix_power(held[number], int(next(words)))
        held.append(T)
    T = held[int(last[1])]
    return _STAYS if np.array_equal(T, np.eye(4)) else [float(number) for number in SE3.from_matrix(T).data]


# ---------------------------------------------------------------------- XML


def _row(tag: str, *children: Element, **attributes: object) -> Element:
    element = etree.Element(tag, {name: _NO_XML.sub("\ufffd", str(value)) for name, value in attributes.items()})
    element.extend(children)
    return element


def _property(name: str, kind: str, *children: Element, group: str = "", doc: str = "", attr: int = 0, family: str = "") -> Element:
    """Return a property; one with a group belongs to the object itself, not to its type."""
    own: dict[str, object] = {"group": group, "doc": doc, "attr": attr, "ro": 0, "hide": 0} if group else {}
    return _row("Property", *children, name=name, type=family or f"App::Property{kind}", **own)


def _text(name: str, value: str, group: str = "", doc: str = "", *, attr: int = 0) -> Element:
    return _property(name, "String", _row("String", value=value), group=group, doc=doc, attr=attr)


def _number(name: str, value: float, group: str, doc: str, *, fixed: bool = False, kind: str = "Float") -> Element:
    row = _property(name, kind, _row("Float", value=repr(float(value))), group=group, doc=doc)
    if fixed:
        row.set("status", _READ_ONLY)
    return row


def _limit(name: str, value: float, *, followed: bool) -> Element:
    """Return a limit; one with an expression has its unit, because FreeCAD 1.1 drops the expressions of plain numbers."""
    kind = ("Angle" if name.startswith("Angle") else "Distance") if followed else "Float"
    return _property(name, kind, _row("Float", value=repr(float(value))), group="Limits")


def _truth(name: str, *, value: bool, group: str = "Joint") -> Element:
    return _property(name, "Bool", _row("Bool", value="true" if value else "false"), group=group)


def _choice(name: str, options: Sequence[str], chosen: str) -> Element:
    listed = _row("CustomEnumList", *(_row("Enum", value=option) for option in options), count=len(options))
    return _property(name, "Enumeration", _row("Integer", value=options.index(chosen), CustomEnum="true"), listed, group="Joint")


def _placement(name: str, numbers: Sequence[float], group: str = "") -> Element:
    keys = ("Px", "Py", "Pz", "Q0", "Q1", "Q2", "Q3")
    row = _row("PropertyPlacement", **{key: repr(float(number)) for key, number in zip(keys, numbers, strict=True)})
    return _property(name, "Placement", row, group=group)


def _vector(name: str, numbers: Sequence[float], kind: str) -> Element:
    row = _row("PropertyVector", **{f"value{axis}": repr(float(number)) for axis, number in zip("XYZ", numbers, strict=True)})
    return _property(name, kind, row)


def _link(name: str, target: str, group: str = "") -> Element:
    return _property(name, "Link", _row("Link", value=target), group=group)


def _target(name: str, target: str) -> Element:
    return _property(name, "XLink", _row("XLink", file="", stamp="", name=target))


def _links(name: str, targets: Iterable[str]) -> Element:
    rows = [_row("Link", value=target) for target in targets]
    return _property(name, "LinkList", _row("LinkList", *rows, count=len(rows)))


def _expressions(held: Mapping[str, str]) -> Element:
    rows = [_row("Expression", path=f".{path}" if "." in path else path, expression=text) for path, text in sorted(held.items())]
    return _property("ExpressionEngine", "ExpressionEngine", _row("ExpressionEngine", *rows, count=len(rows)))


def _proxy(name: str) -> Element:
    row = etree.Element("Python", {"value": _NULL, "encoded": "yes", "module": "JointObject", "class": name})
    return _property("Proxy", "PythonObject", row)
