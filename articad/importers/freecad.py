"""Reads a FreeCAD assembly document, written by articad or made by hand; FreeCAD need not be installed.

The file is a zip of XML and B-rep; the B-rep is read in the kernels' confined worker. Parts, shapes, connectors, joints, limits, labels and
colours come from the document as it is now, so edits in FreeCAD are kept, and masses are computed from the shapes. What FreeCAD cannot
represent (cones, leads, drivers, linear couplings, fits) comes from articad's records in the document. Each edit is a finding; an edit that
is not adopted is a warning that names it.
"""

from __future__ import annotations

import math
import re
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property
from pathlib import Path
from typing import Any

import numpy as np

from articad.assembly import Assembly
from articad.connectors.connector import Connector
from articad.connectors.mate import FLIP, Mate
from articad.connectors.se3 import SE3
from articad.errors import ArticadError, LoopError
from articad.export.freecad_content import PROPERTY, Content, content_of, unpacked_content
from articad.findings import Finding, Findings
from articad.geometry.mass import MassProperties
from articad.geometry.part import DEFAULT_COLOR, Part, Shape, Solid
from articad.importers.driving import driven
from articad.importers.freecad_constraints import CONSTRAINTS, Constraint, merged, planar_faces
from articad.importers.freecad_couplings import COUPLINGS, PartMotions, Stated, coupling_of, threaded
from articad.importers.freecad_document import IDENTITY, FreeCADObject, LinkedDocuments
from articad.importers.freecad_edits import Edit, edits
from articad.importers.freecad_materials import DENSITIES
from articad.importers.freecad_mesh import read_mesh_kernel
from articad.importers.freecad_standing import deviations, sizes
from articad.importers.reading import MAX_NAME, Folder, unreadable
from articad.importers.records import assembly_of, read_records
from articad.kernels.archive import BadArchiveError
from articad.kernels.freecad import BrepReader
from articad.kinematics.joints import Coupling, Joint, JointLimits, JointType
from articad.kinematics.mechanism import Mechanism
from articad.processes import scratch

SAME_MM, SAME_RAD = 1e-9, 1e-12  # a frame this close to its record is replaced by the record
SAME_MESH = 1e-5  # the same of a mesh in single precision
SAME_SHAPE = 1e-9  # a volume, relative, and a centre, relative to the part's size: below, the recorded mass holds
MAX_CONNECTORS = 200_000  # of all parts, those of copies included
_SAID = 10  # findings about a shape that are repeated for each of its copies
STANDS_MM, STANDS_RAD = 1e-4, 1e-5  # by which a part may stand elsewhere than its joints put it, before a finding says so
_TYPES = {
    "Fixed": JointType.FIXED,
    "Revolute": JointType.REVOLUTE,
    "Slider": JointType.SLIDER,
    "Cylindrical": JointType.CYLINDRICAL,
    "Ball": JointType.BALL,
}
_WRITTEN = {kind: word for word, kind in _TYPES.items()} | {
    JointType.SCREW: "Cylindrical",
    JointType.PLANAR: "Distance",
    JointType.UNIVERSAL: "Ball",
}  # how articad writes joints: other words are edits
_CONTAINING = ("Group", "Origin", "_Body", "OriginFeatures")  # links to members, which need not shape what holds them
_NAMED = re.compile(r"(?<![\w ])(?:(?![A-Za-z_])[\w ])*+([A-Za-z_][\w ]*+)(?=\.)")  # the objects that an expression names, in linear time
_CONTAINERS = ("App::Part", "App::Link", "Mesh::Feature", "Assembly::AssemblyLink", "Assembly::AssemblyObject")
_LIMITS = {
    JointType.REVOLUTE: ("Angle",),
    JointType.SLIDER: ("Length",),
    JointType.CYLINDRICAL: ("Length", "Angle"),
    JointType.SCREW: ("Angle",),
}


def read_freecad(path: str | Path, *, root: str | Path | None = None, metadata: bool = True, deflection: float = 0.01) -> Assembly:
    """Read the assembly of a FreeCAD file.

    Args:
        path: The file, `.FCStd`.
        root: Folder that linked documents may be read from; the file's own by default.
        metadata: Use the records that articad left in its own files, for what FreeCAD cannot represent.
        deflection: Largest distance of the meshes from the solids [mm].

    Returns:
        The assembly as it is in the document. If articad wrote the document, its findings name each edit: `I_FREECAD_EDIT` is taken over,
        `W_FREECAD_EDIT` is not.

    Raises:
        ReadError: If it is not a FreeCAD file, contains no assembly with a grounded part, links to a file that is missing or outside the
            root, or has a joint of a type that articad does not support.
    """
    path = Path(path)
    library = LinkedDocuments(path, None if root is None else Path(root))
    model = _Model(library, deflection, metadata=metadata)
    if model.records:
        recorded = assembly_of(read_records(model.records.split("\n"), path), Folder.of(path, None), path)
        return _updated(model, recorded)
    return model.assemble()


@dataclass(frozen=True)
class EditedDocument:
    """The content of a document that articad wrote, for callers that put its edits into a plan.

    Attributes:
        edits: The differences since articad wrote it; None if it does not carry its written content.
        written: The content as it was written.
        now: The content as it is now.
        parts: Name of each part in the plan, by its object in FreeCAD.
        joints: Name of each joint and coupling in the plan, likewise.
        colors: "#rrggbb" of each part whose colour was changed in a window of FreeCAD, by its name in the plan.
    """

    edits: tuple[Edit, ...] | None
    written: Content
    now: Content
    parts: Mapping[str, str]
    joints: Mapping[str, str]
    colors: Mapping[str, str]


def read_document(path: str | Path) -> EditedDocument:
    """Return the content of a FreeCAD document, and its edits since articad wrote it.

    Raises:
        ReadError: If it is not a FreeCAD file with an assembly.
    """
    model = _Model(LinkedDocuments(Path(path), None), 0.01, metadata=True)
    parts = {item.name: given for item in model.members if (given := item.text("ArticadPart"))}
    joints = {item.name: given for item in model.joint_items() if (given := item.text("ArticadJoint"))}
    before = {record["name"]: record.get("color") for record in _records(model) if record["kind"] == "part"}
    now = {given: model.color(name) for given, name in model.recorded.items()} if model.records else {}
    colors = {name: color for name, color in now.items() if color is not None and color != before.get(name)}
    return EditedDocument(None if model.written is None else model.edits, model.written or {}, model.now, parts, joints, colors)


@cache
def _kept() -> tempfile.TemporaryDirectory[str]:
    """Return the folder for the B-rep files that were read; they can be written again until this process ends."""
    return scratch.folder("read")


class _Model:
    """Parts, connectors and joints of a document, as it contains them."""

    def __init__(self, library: LinkedDocuments, deflection: float, *, metadata: bool) -> None:
        self.library, self.document, self.deflection = library, library.main, deflection
        self.path = self.document.path
        self.assembly = self._top()
        self.records = self.assembly.text("ArticadRecords") if metadata else ""
        stored = self.document.text(self.assembly.name, PROPERTY) if self.records else ""
        self.written = unpacked_content(stored) if stored else None
        self.now = content_of(self.document.root)
        self.edits = () if self.written is None else tuple(edits(self.written, self.now))
        self.findings: list[Finding] = []
        self._held = dict(library.components(self.assembly))  # every member, with the pose of the group that contains it
        self.members = [item for item in self._held if self._is_part(item)]
        self.parts: dict[str, FreeCADObject] = {}  # by the name that the part has now
        self.recorded: dict[str, str] = {}  # name in the records -> name now
        self._numbers: dict[str, int] = {}  # by label, below which all numbers are taken
        for item in self.members:
            self._take(item)
        self._known = frozenset(self.recorded.values())
        self.names = {item: name for name, item in self.parts.items()}
        self.grounded = self._grounded()
        self.ground = self.grounded[0]
        self.poses = {name: self._held[item] @ item.placement for name, item in self.parts.items()}
        self.colors = {self.document.path: self.document.colors()}
        self._frames: dict[FreeCADObject, dict[str, SE3]] = {}  # of the connectors in each container
        self._shapes: dict[FreeCADObject, list[tuple[FreeCADObject, SE3]]] = {}
        self._painted: dict[FreeCADObject, str | None] = {}  # the colour of each container's shapes
        self._planes: dict[FreeCADObject, dict[str, tuple[Any, Any]]] = {}  # point and normal of each planar face of a container's solid
        self._shown = 0  # connectors of all parts, those of copies included
        self._solids: dict[FreeCADObject, tuple[Solid | None, tuple[Shape, ...]]] = {}
        self._masses: dict[FreeCADObject, list[MassProperties | None]] = {}
        self._wrong: dict[FreeCADObject, list[Finding]] = {}  # what was said of a shape when it was read
        self._asked: set[str] = set()  # parts of which it was said
        self._said: set[str] = set()  # parts with a finding about their shape
        self._reader = BrepReader()

    def _top(self) -> FreeCADObject:
        """Return the assembly that is not a part of another one."""
        document = self.document
        assemblies = [name for name, kind in document.types.items() if kind == "Assembly::AssemblyObject"]
        if not assemblies:
            raise unreadable(self.path, "Document.xml", "It contains no assembly.")
        held = {member for name in assemblies for member in document.links(name, "Group")}
        return FreeCADObject(document, next((name for name in assemblies if name not in held), assemblies[0]))

    def _is_part(self, item: FreeCADObject) -> bool:
        return (item.type in _CONTAINERS or item.is_shape) and not item.document.has(item.name, "JointType")

    def _take(self, item: FreeCADObject) -> None:
        """Name a part: a part that articad wrote keeps its name unless its label was changed; other parts are named by their labels."""
        given, label = item.text("ArticadPart") if self.records else "", item.text("Label") or item.name
        known = given and given not in self.recorded and (self.written is None or item.name in self.written)
        renamed = known and self.written is not None and self.written[item.name]["label"] != label
        name = _free(given if known and not renamed else _plain(label), self.parts, self._numbers)
        self.parts[name] = item
        if known:
            self.recorded[given] = name

    def _grounded(self) -> tuple[str, ...]:
        """Return the parts that are grounded, at least one; the first is the ground, and the others do not move against it."""
        joints = [item for item in self.joint_items() if self.document.has(item.name, "ObjectToGround")]
        linked = [FreeCADObject(self.document, name) for item in joints for name in self.document.links(item.name, "ObjectToGround")[:1]]
        if found := tuple(self.names[item] for item in linked if item in self.names):
            return found
        raise unreadable(self.path, self.assembly.name, "No part of the assembly is grounded.", hint="Ground one of its parts in FreeCAD.")

    def joint_items(self) -> list[FreeCADObject]:
        """Return the joints of the assembly and of flexible assemblies in it, not those of rigid ones."""
        inside = [joint for item in self._held if item.type == "Assembly::JointGroup" for joint in self.library.members(item)]
        return list(dict.fromkeys([*inside, *(item for item in self._held if self._is_joint(item))]))

    def _is_joint(self, item: FreeCADObject) -> bool:
        return any(item.document.has(item.name, key) for key in ("JointType", "ObjectToGround"))

    # ------------------------------------------------------------------ parts

    def connectors(self, name: str) -> dict[str, SE3]:
        """Return the coordinate systems that articad made in a part."""
        container = self.library.container(self.parts[name])
        if container not in self._frames:
            members = self.library.members(container)
            self._frames[container] = {text: item.placement for item in members if (text := item.text("ArticadConnector"))}
        self._shown += len(self._frames[container])
        if self._shown > MAX_CONNECTORS:
            raise unreadable(self.path, self.assembly.name, f"Its parts show more than {MAX_CONNECTORS} connectors, copies included.")
        return self._frames[container]

    def shapes(self, name: str) -> list[tuple[FreeCADObject, SE3]]:
        """Return the bodies, solids and meshes of a part, each with the pose of its stored shape in the part's frame."""
        return self._shapes_of(self.library.container(self.parts[name]))

    def _shapes_of(self, container: FreeCADObject) -> list[tuple[FreeCADObject, SE3]]:
        if container not in self._shapes:
            self._shapes[container] = list(self.library.shapes(container))
        return self._shapes[container]

    def solid(self, name: str) -> Solid | None:
        """Return a part's one solid in the part's own frame, measured by the confined worker; None where it is not one solid."""
        return self._measured(name)[0]

    def meshes(self, name: str) -> tuple[Shape, ...]:
        """Return the meshes of a part that is not one solid, in the part's own frame."""
        return self._measured(name)[1]

    def color(self, name: str) -> str | None:
        """Return the colour that a window of FreeCAD stored of a part, or None."""
        item = self.parts[name]
        own, container = self._color(item), self.library.container(item)
        if own is None and container not in self._painted:
            found = (color for shape, _ in self.shapes(name) if (color := self._color(shape)) is not None)
            self._painted[container] = next(found, None)
        return self._painted[container] if own is None else own

    def _color(self, shown: FreeCADObject) -> str | None:
        """Return the colour that a window of FreeCAD stored of an object."""
        path = shown.document.path
        if path not in self.colors:
            self.colors[path] = shown.document.colors()
        return self.colors[path].get(shown.name)

    def _measured(self, name: str) -> tuple[Solid | None, tuple[Shape, ...]]:
        container = self.library.container(self.parts[name])
        if container not in self._solids:
            start = len(self.findings)
            self._solids[container] = self._read(container, name)
            self._wrong[container] = self.findings[start:]
        elif name not in self._asked:
            for finding in self._wrong[container][:_SAID]:  # each copy lacks what its source lacks
                self._misshapen(name, finding.message.replace(repr(finding.parts[0]), repr(name)), finding.hint)
        self._asked.add(name)
        return self._solids[container]

    def _read(self, container: FreeCADObject, name: str) -> tuple[Solid | None, tuple[Shape, ...]]:
        solids, shapes, wrong = [], [], len(self.findings)
        masses = self._masses.setdefault(container, [])
        for item, T in self.shapes(name):
            if item.type == "Mesh::Feature":
                shapes += self._mesh(item, T, name)
                masses.append(None)
            else:
                found = self._brep(item, T, name)
                density = DENSITIES.get(item.document.value(item.name, "ShapeMaterial", "PropertyMaterial", "uuid") or "")
                masses += [None if density is None else solid.mass(density) for solid in found]
                masses += [None] if not found else []
                solids += found
        if len(solids) == 1 and not shapes:
            return solids[0], ()
        if not solids and not shapes and len(self.findings) == wrong and not (self.records and name in self._known):
            self._misshapen(name, f"Part {name!r} has no shape in the document.", "Give it a body or a solid, or delete it.")
        return None, (*(Shape(solid.mesh, name=f"{name}_{place}") for place, solid in enumerate(solids)), *shapes)

    def _brep(self, item: FreeCADObject, T: SE3, name: str) -> list[Solid]:
        """Return the solid of one object in a list, or none and a finding."""
        file = item.document.value(item.name, "Shape", "Part", "file")
        if item.document.number(item.name, "ElementCount") > 0:
            self._misshapen(name, f"{item.name} is an array of links, which is not read.", "Make the links one by one.")
            return []
        try:
            content = item.document.entry(file)
            if content is None:
                return []
            folder = Path(tempfile.mkdtemp(dir=_kept().name))
            solids, loose = self._reader.read_breps(content, name=name, T=T, deflection=self.deflection, folder=folder)
        except (ArticadError, BadArchiveError) as error:
            if "it holds no shape" in str(error):  # a body without features
                return []
            late = "seconds" in str(error) or "ran out of time" in str(error)
            why = (
                f"The shape of {item.name} {'could not be measured in time' if late else 'is not made of valid solids'}: {str(error)[:200]}"
            )
            self._misshapen(name, why, "Simplify it, or read the file on a faster machine." if late else "Repair it in FreeCAD.")
            return []
        if loose:
            why = f"The shape of {item.name} has {loose} loose faces or edges beside its solids; they are left out."
            self._misshapen(name, why, "Make a solid of them, or delete them.")
        return solids

    def _mesh(self, item: FreeCADObject, T: SE3, name: str) -> list[Shape]:
        file = item.document.value(item.name, "Mesh", "Mesh", "file")
        try:
            content = item.document.entry(file)
            return [] if content is None else [Shape(read_mesh_kernel(content), T)]
        except (ArticadError, BadArchiveError) as error:
            self._misshapen(name, f"The mesh of {item.name} is left out: {str(error)[:200]}", "Repair it in FreeCAD.")
        return []

    def missing(self, name: str, meshes: int) -> None:
        """Report that a part that was one solid no longer is."""
        if name not in self._said:
            now = f"{meshes} shapes" if meshes else "no shape"
            self._misshapen(name, f"Part {name!r} was one solid; in the document it has {now}, so it has no mass.", "Give it one solid.")

    def reshaped(self, name: str) -> None:
        """Report that a part's shape has changed, unless an edit of what shapes it is reported already."""
        if self.written is None:
            return
        if not self._regrouped and self._edited.isdisjoint(shape.name for shape, _ in self.shapes(name) if shape.document is self.document):
            self.findings.append(
                Finding(
                    code="I_FREECAD_EDIT",
                    where=f"parts.{name}",
                    parts=(name,),
                    message=f"The shape of part {name!r} is not the one that articad wrote.",
                    hint="The assembly that was read has the new shape.",
                )
            )

    @cached_property
    def _regrouped(self) -> bool:
        """Whether objects were added, deleted or put into another group."""
        return any(edit.kind in ("added", "deleted", "group") for edit in self.edits)

    @cached_property
    def _edited(self) -> set[str]:
        """The objects with an edit, and those that depend on them."""
        users: dict[str, list[str]] = {}
        for name, needed in self._needs.items():
            for link in needed:
                users.setdefault(link, []).append(name)
        return _closure([edit.object for edit in self.edits], users)

    @cached_property
    def _needs(self) -> dict[str, set[str]]:
        """The objects of the document on which each depends, by links and expressions."""
        document, labels = self.document, {held["label"]: name for name, held in self.now.items()}
        found: dict[str, set[str]] = {}
        for name in document.items:
            found[name] = {link for key in document.keys(name) if key not in _CONTAINING for link in document.links(name, key)}
            for text in self.now.get(name, {"expressions": {}})["expressions"].values():
                named = _NAMED.findall(text.replace("<<", "").replace(">>", ""))
                found[name].update(label if label in document.items else labels.get(label, "") for label in named)
        return found

    def used(self) -> set[str]:
        """Return the parts, their shapes and connectors, the joints, and the objects of the document on which these depend."""
        start = [*self.members, *self.joint_items()]
        for container in dict.fromkeys(self.library.container(item) for item in self.members):
            start += [shape for shape, _ in self._shapes_of(container)]
            start += [member for member in self.library.members(container) if member.text("ArticadConnector")]
        names = [item.name for item in start if item.document is self.document]
        return {name for name in _closure(names, self._needs) if name in self.document.items}

    def words(self, used: set[str]) -> set[str]:
        """Return the words of the expressions of objects in use."""
        texts = (text for name in used for text in self.now.get(name, {"expressions": {}})["expressions"].values())
        return {word for text in texts for word in re.findall(r"\w+", text)}

    def _misshapen(self, name: str, message: str, hint: str) -> None:
        self._said.add(name)
        self.findings.append(Finding(code="W_FREECAD_SHAPE", where=f"parts.{name}", parts=(name,), message=message, hint=hint))

    # ------------------------------------------------------------------ joints

    def joints(self) -> Iterator[tuple[FreeCADObject, str, Joint | None]]:
        """Yield each active joint between two parts: its object, FreeCAD's type, and the joint where articad has the type.

        Raises:
            ReadError: If one has a side that is not a part of the assembly.
        """
        for item in self.joint_items():
            document = item.document
            if not document.has(item.name, "JointType") or self.is_off(item):
                continue
            kind = document.choice(item.name, "JointType")
            sides = [self.side(item, number) for number in (1, 2)]
            if None in sides:
                label = item.text("Label") or item.name
                message = (
                    f"Joint {label!r} ({kind}) has a side that is not a part of the assembly. Attach both sides, or suppress it in FreeCAD."
                )
                raise unreadable(self.path, item.name, message)
            parent, child = (side for side in sides if side is not None)
            yield item, kind, self._joint(item, _TYPES[kind], parent, child) if kind in _TYPES else None

    def is_off(self, item: FreeCADObject) -> bool:
        """Return whether a joint is switched off: `Activated` in FreeCAD 1.0, `Suppressed` in 1.1."""
        return not item.document.truth(item.name, "Activated", default=True) or item.document.truth(item.name, "Suppressed")

    def joint_name(self, item: FreeCADObject) -> str:
        """Return the name of a joint: as it was written, unless its label was changed."""
        given, label = item.text("ArticadJoint") if self.records else "", item.text("Label") or item.name
        renamed = self.written is not None and item.name in self.written and self.written[item.name]["label"] != label
        return given if given and not renamed else _plain(label)

    def side(self, item: FreeCADObject, number: int) -> tuple[str, str, SE3] | None:
        """Return the part, the connector's name and its frame in the part of one side of a joint."""
        steps = self.library.reference(item, f"Reference{number}")
        places = [place for place, step in enumerate(steps) if step in self.names]
        if not places:
            return None
        frame, part = IDENTITY, steps[places[0]]
        for step in steps[places[0] + 1 :]:
            frame = frame @ step.placement
        connector = steps[-1].text("ArticadConnector")
        named = connector or _plain(f"{item.text('Label') or item.name}_{number}")
        offset = item.document.placement(item.name, f"Placement{number}")
        if connector and not offset.allclose(IDENTITY, mm=SAME_MM, rad=SAME_RAD) and not (self.records and item.text("ArticadJoint")):
            named = _plain(f"{item.text('Label') or item.name}_{number}")
        return self.names[part], named, frame @ offset

    def _joint(self, item: FreeCADObject, kind: JointType, parent: tuple[str, str, SE3], child: tuple[str, str, SE3]) -> Joint:
        D = (self.poses[parent[0]] @ parent[2]).inverse() @ self.poses[child[0]] @ child[2]
        mate = Mate.ALIGNED if D.rotation[2, 2] >= 0 else Mate.OPPOSED
        ends, seat = self._ends(item, kind), child[2]
        turned = D @ (FLIP if mate is Mate.OPPOSED else IDENTITY)
        if kind is JointType.FIXED and turned.rotation[0, 0] < 0.0:  # FreeCAD's solver also holds fixed frames half a turn apart about z
            seat = seat @ SE3.from_quaternion([0.0, 0.0, 1.0, 0.0])
        rest = _coordinates(turned, kind)
        if ends:
            rest = tuple(_wound(value, *end) if axis == "Angle" else value for value, (axis, end) in zip(rest, ends, strict=True))
        return Joint(
            name=self.joint_name(item),
            type=kind,
            parent=parent[0],
            child=child[0],
            parent_connector=parent[1],
            child_connector=child[1],
            T_parent_connector=parent[2],
            T_child_connector=seat,
            limits=_limits(ends, rest),
            rest=rest,
            mate=mate,
        )

    def _ends(self, item: FreeCADObject, kind: JointType) -> list[tuple[str, tuple[float, float]]]:
        """Return the names of FreeCAD's limits of a joint, and their values [mm, rad]."""
        ends = []
        for axis in _LIMITS.get(kind, ()):
            scale = math.radians(1.0) if axis == "Angle" else 1.0
            low, high = (
                item.document.number(item.name, f"{axis}{end}") * scale if item.document.truth(item.name, f"Enable{axis}{end}") else endless
                for end, endless in (("Min", -math.inf), ("Max", math.inf))
            )
            ends.append((axis, (low, high)))
        return ends

    def ends(self, item: FreeCADObject, kind: JointType) -> JointLimits:
        """Return a joint's limits as FreeCAD has them [mm, rad]."""
        pairs = [bounds for _, bounds in self._ends(item, kind)]
        return JointLimits(tuple(low for low, _ in pairs), tuple(high for _, high in pairs))

    def stated(self, item: FreeCADObject, kind: str) -> Stated:
        """Return the values of a joint that couples two other joints: gears, a rack, a screw or a belt."""
        sides = [side for number in (1, 2) if (side := self.side(item, number)) is not None]
        frames = tuple(self.poses[part] @ frame for part, _, frame in sides)
        return Stated(
            self.joint_name(item),
            kind,
            (sides[0][0], sides[1][0]),
            (frames[0], frames[1]),
            item.document.number(item.name, "Distance"),
            item.document.number(item.name, "Distance2"),
        )

    def refused(self, item: FreeCADObject, kind: str, why: str = "has a type that articad does not support") -> ArticadError:
        """Return the error that names a joint which cannot be read."""
        label = item.text("Label") or item.name
        hint = (
            "Use Fixed, Revolute, Slider, Cylindrical, Ball, Gears, Belt, RackPinion or Screw, "
            "or one of these beside it between the same two parts, or suppress the joint in FreeCAD."
        )
        return unreadable(self.path, item.name, f"Joint {label!r} ({kind}) {why}.", "E_FREECAD_JOINT", hint)

    def constraint(self, item: FreeCADObject, kind: str) -> Constraint:
        """Return the values of a joint that restricts: Distance, Parallel, Perpendicular or Angle.

        Raises:
            ReadError: If it is a distance that is not one of two planes, or of two points that coincide.
        """
        sides = [side for number in (1, 2) if (side := self.side(item, number)) is not None]
        document = item.document
        value, points = document.number(item.name, "Angle" if kind == "Angle" and document.has(item.name, "Angle") else "Distance"), False
        if kind == "Distance":
            elements = [self.library.element(item, f"Reference{number}") for number in (1, 2)]
            points = all(element.startswith("Vertex") for element in elements)
            planes = [self._is_plane(element, part, frame) for element, (part, _, frame) in zip(elements, sides, strict=True)]
            if (points and abs(value) > SAME_MM) or not (points or all(planes)):
                where = " and ".join(element or "a coordinate system" for element in elements)
                raise self.refused(item, kind, f"is a distance between {where}, which is neither one of two planes nor zero of two points")
        return Constraint(
            self.joint_name(item),
            kind,
            (sides[0][0], sides[1][0]),
            (sides[0][1], sides[1][1]),
            (sides[0][2], sides[1][2]),
            math.radians(value) if kind == "Angle" else value,
            points,
        )

    def _is_plane(self, element: str, part: str, frame: SE3) -> bool:
        """Return whether a side of a joint is the xy plane of its frame: a coordinate system, or a planar face with this frame."""
        if not element.startswith("Face"):
            return not element.startswith(("Edge", "Vertex"))
        solid = self.solid(part)
        if solid is None or solid.mesh.face is None:
            return False
        container = self.library.container(self.parts[part])
        if container not in self._planes:
            faces = planar_faces(solid.mesh.vertices, solid.mesh.triangles, solid.mesh.face)
            self._planes[container] = {f"Face{number}": (point, normal) for number, point, normal in faces}
        if element not in self._planes[container]:
            return False
        point, normal = self._planes[container][element]
        off = float(np.dot(point - frame.translation, normal))
        return abs(off) < STANDS_MM and float(np.linalg.norm(np.cross(normal, frame.rotation[:, 2]))) < STANDS_RAD

    def restricted(self, joints: list[Joint], rows: list[tuple[FreeCADObject, str]]) -> list[Joint]:
        """Return the joints, restricted by FreeCAD's joints that restrict others.

        Raises:
            ReadError: With the name of one that leaves motions which no joint of articad has.
        """
        constraints: dict[str, tuple[Constraint, FreeCADObject, str]] = {}
        taken, numbers = {joint.name for joint in joints}, dict[str, int]()
        for item, kind in rows:
            made = self.constraint(item, kind)
            made = replace(made, name=_free(made.name, taken, numbers))
            taken.add(made.name)
            constraints[made.name] = (made, item, kind)
        found = merged(joints, [made for made, _, _ in constraints.values()], self.poses)
        if isinstance(found, tuple):
            constraint, why = found
            _, item, kind = constraints[constraint.name]
            raise self.refused(item, kind, why)
        return found

    # ------------------------------------------------------------------ an assembly made by hand

    def assemble(self) -> Assembly:
        """Return the assembly of a document that articad did not write."""
        joints, couplings = self.joined([], self.joints())
        joints += self.loose(joints)
        of = _joints_by_part(joints)
        parts = [self.part(name, of.get(name, ())) for name in self.parts]
        title = self.assembly.text("Label") or self.path.stem
        try:
            made = Assembly.from_parts(
                _plain(title),
                parts=parts,
                joints=joints,
                couplings=couplings,
                ground=self.ground,
                T_ground=self.assembly.placement @ self.poses[self.ground],
            )
            mechanism = driven(made.mechanism)
        except ArticadError as error:
            raise unreadable(self.path, self.assembly.name, f"It is not a valid mechanism: {error.message}") from error
        return replace(made, mechanism=mechanism, findings=Findings([*self.findings, *self.apart(joints)]), foreign=True)

    def joined(self, joints: list[Joint], rows: Iterable[tuple[FreeCADObject, str, Joint | None]]) -> tuple[list[Joint], list[Coupling]]:
        """Return joints together with more joints of the document, as `joints` yields them, and the couplings among these.

        Raises:
            ReadError: With the name of a joint that cannot be read.
        """
        made, stated, restricting = list(joints), [], []
        names, numbers = {joint.name for joint in made}, dict[str, int]()
        for item, kind, joint in rows:
            if joint is not None:
                made.append(replace(joint, name=_free(joint.name, names, numbers)))
                names.add(made[-1].name)
            elif kind in COUPLINGS:
                stated.append((item, self.stated(item, kind)))
            elif kind in CONSTRAINTS:
                restricting.append((item, kind))
            else:
                raise self.refused(item, kind)
        made = self.restricted(made, restricting)
        made, runs = threaded(made, [told for _, told in stated], self.poses)
        motions = PartMotions(made, self.poses)
        return made, [self.coupled(item, told, motions) for (item, told), on_joint in zip(stated, runs, strict=True) if not on_joint]

    def coupled(self, item: FreeCADObject, told: Stated, motions: PartMotions) -> Coupling:
        """Return the coupling that a joint of FreeCAD's means, or refuse the joint by its name."""
        coupling = coupling_of(told, motions)
        if isinstance(coupling, str):
            raise self.refused(item, told.kind, coupling)
        return coupling

    def apart(self, joints: Iterable[Joint]) -> Iterator[Finding]:
        """Yield the joints whose two frames stand otherwise in the document than their type allows.

        FreeCAD keeps the placements of the last solve, and its solver drops constraints that it takes for redundant: a slider and a hinge
        of one loop may both be a degree askew in a document that it calls solved.
        """
        joints = list(joints)
        for joint, far, turned in zip(joints, *map(np.ndarray.tolist, deviations(joints, self.poses)), strict=True):
            if far <= STANDS_MM and turned <= STANDS_RAD:
                continue
            sizes = [f"{far:.4g} mm apart"] if far > STANDS_MM else []
            sizes += [f"{math.degrees(turned):.3f}° askew"] if turned > STANDS_RAD else []
            yield Finding(
                code="W_FREECAD_APART",
                where=f"joints.{joint.name}",
                parts=(joint.parent, joint.child),
                message=f"Joint {joint.name!r} ({joint.type}) does not hold in the document: its sides on {joint.parent!r} and {joint.child!r} "
                f"are {' and '.join(sizes)}. FreeCAD may call this solved.",
                hint="articad places the parts where joints hold. Correct the faces that the joint refers to, and solve the assembly in FreeCAD.",
                value=far if far > STANDS_MM else math.degrees(turned),
                limit=STANDS_MM if far > STANDS_MM else math.degrees(STANDS_RAD),
                unit="mm" if far > STANDS_MM else "deg",
            )

    def part(self, name: str, joints: Sequence[Joint]) -> Part:
        """Return a part with the connectors that its joints use, as the document has it."""
        frames = dict(self.connectors(name))
        for joint in joints:
            if joint.parent == name:
                frames[joint.parent_connector] = joint.T_parent_connector
            if joint.child == name:
                frames[joint.child_connector] = joint.T_child_connector
        connectors = {key: Connector(key, frame) for key, frame in frames.items()}
        solid, color = self.solid(name), self.color(name) or DEFAULT_COLOR
        if solid is not None:
            return replace(Part.from_solid(name, solid, connectors=connectors, color=color), mass=self.mass(name))
        shapes = self.meshes(name)
        return Part(name, connectors, shapes, shapes, mass=self.mass(name), color=color)

    def mass(self, name: str) -> MassProperties | None:
        """Return the mass of a part, if each of its shapes is made of solids whose material in FreeCAD's library has a density."""
        self._measured(name)
        masses = self._masses[self.library.container(self.parts[name])]
        return MassProperties.combined(mass for mass in masses if mass is not None) if masses and None not in masses else None

    def loose(self, joints: list[Joint]) -> list[Joint]:
        """Return joints to the ground for parts that no joint connects to it: fixed ones for grounded parts, free ones and a finding for others."""
        near, grounded = _neighbours(joints), set(self.grounded)
        reached, made = _closure([self.ground], near), []
        taken = {joint.name for joint in joints}
        for name in self.parts:
            if name in reached:
                continue
            held = name in grounded
            joint_name = _free(f"{name}_{'grounded' if held else 'loose'}", taken)
            taken.add(joint_name)
            T = self.poses[self.ground].inverse() @ self.poses[name]
            ends = (f"{joint_name}_1", f"{joint_name}_2")
            made.append(
                Joint(
                    name=joint_name,
                    type=JointType.FIXED if held else JointType.FREE,
                    parent=self.ground,
                    child=name,
                    parent_connector=ends[0],
                    child_connector=ends[1],
                    T_parent_connector=T if held else IDENTITY,
                    T_child_connector=IDENTITY,
                    limits=JointLimits((), ()),
                    rest=() if held else tuple(map(float, T.data)),
                )
            )
            reached |= _closure([name], near)
            if held:
                continue
            message = f"No joint connects part {name!r} to the grounded part. It is loose and has a free joint."
            hint = "Connect it with a joint in FreeCAD, or ground it there."
            self.findings.append(Finding(code="W_FREECAD_LOOSE", where=f"parts.{name}", parts=(name,), message=message, hint=hint))
        return made


# ---------------------------------------------------------------------- a document that articad wrote, as it is now


def _updated(model: _Model, recorded: Assembly) -> Assembly:
    """Return the recorded assembly with the content that the document has now."""
    densities = {record.name: record.density for record in recorded.materials.values()}
    records = _records(model)
    sizes, meshes = _recorded(records, "solid"), _recorded(records, "drawn")
    names = model.recorded
    primary: dict[str, tuple[FreeCADObject, str, Joint | None]] = {}
    extra: list[tuple[FreeCADObject, str, Joint | None]] = []
    ours = {joint.name for joint in recorded.joints} | {coupling.name for coupling in recorded.mechanism.couplings}
    for row in model.joints():
        given = row[0].text("ArticadJoint")
        if given in ours and (model.written is None or row[0].name in model.written):
            primary.setdefault(given, row)  # the second object of a universal or a screw says nothing more
        else:
            extra.append(row)

    joints: list[Joint] = []
    renamed: dict[str, str] = {}  # joint as recorded -> as it is called now
    for joint in recorded.joints:
        now = _joint_now(joint, primary.get(joint.name), model)
        if now is not None:
            renamed[joint.name] = now.name
            joints.append(now)
    joints, added = model.joined(joints, extra)
    tied = [*_couplings_now(model, recorded, joints, renamed), *added]
    joints += model.loose(joints)
    known = {now: name for name, now in names.items()}
    order = [*(names[name] for name in recorded.parts if name in names), *(name for name in model.parts if name not in known)]
    of = _joints_by_part(joints)
    parts = {
        name: _part_now(recorded.parts[known[name]], name, model, of.get(name, ()), densities, sizes, meshes)
        if name in known
        else model.part(name, of.get(name, ()))
        for name in order
    }
    T_ground = model.poses[model.ground]
    if model.ground == names.get(recorded.ground):
        T_ground = _near(T_ground, recorded.mechanism.T_ground)
    try:
        mechanism = Mechanism(order, model.ground, joints, tied, T_ground=T_ground)
    except ArticadError as error:
        raise unreadable(model.path, model.assembly.name, f"After the edits it is not a valid mechanism: {error.message}") from error
    waivers = tuple(
        replace(waiver, parts=(names[waiver.parts[0]], names[waiver.parts[1]]))
        for waiver in recorded.waivers
        if set(waiver.parts) <= set(names)
    )
    made = replace(
        recorded,
        name=recorded.name,
        mechanism=mechanism,
        parts=parts,
        fits={renamed[joint]: fit for joint, fit in recorded.fits.items() if renamed.get(joint) in {made.name for made in joints}},
        waivers=waivers,
    )
    return replace(made, findings=Findings([*model.findings, *_edit_findings(model), *_elsewhere(model, made)]))


def _joint_now(joint: Joint, row: tuple[FreeCADObject, str, Joint | None] | None, model: _Model) -> Joint | None:
    """Return a recorded joint as the document has it; None where it was deleted or switched off."""
    names = model.recorded
    if joint.type is JointType.FREE:
        return None if {joint.parent, joint.child} - set(names) else replace(joint, parent=names[joint.parent], child=names[joint.child])
    if row is None:
        return None
    item, kind, found = row
    if kind != _WRITTEN[joint.type]:
        if found is None:
            raise model.refused(item, kind)
        return found  # its type was changed: what articad knew of the old one does not hold
    name, sides = model.joint_name(item), [side for number in (1, 2) if (side := model.side(item, number)) is not None]
    flip = FLIP if joint.mate is Mate.OPPOSED else IDENTITY  # the writer turns the child's frame, so that z axes agree
    near, far = sides[0][2], sides[1][2] @ flip.inverse()
    C_p, C_c = _near(near, joint.T_parent_connector), _near(far, joint.T_child_connector)
    now = replace(
        joint,
        name=name,
        parent=sides[0][0],
        child=sides[1][0],
        parent_connector=sides[0][1],
        child_connector=sides[1][1],
        T_parent_connector=C_p,
        T_child_connector=C_c,
    )
    D = (model.poses[now.parent] @ C_p).inverse() @ model.poses[now.child] @ C_c @ flip
    now = replace(now, rest=_rest_now(now, D))
    if joint.type not in _LIMITS:
        return now
    limits = model.ends(item, joint.type)
    kept = tuple(
        tuple(old if math.isclose(new, old, rel_tol=1e-12, abs_tol=1e-12) else new for new, old in zip(new_row, old_row, strict=True))
        for new_row, old_row in ((limits.lower, joint.limits.lower), (limits.upper, joint.limits.upper))
    )
    turned = tuple(
        _wound(value, low, high) if unit == "rad" and not low <= value <= high else value
        for value, low, high, unit in zip(now.rest, *kept, joint.type.units, strict=True)
    )
    lower = tuple(min(low, value) for low, value in zip(kept[0], turned, strict=True))
    upper = tuple(max(high, value) for high, value in zip(kept[1], turned, strict=True))
    return replace(now, rest=turned, limits=replace(joint.limits, lower=lower, upper=upper))


def _rest_now(joint: Joint, D: SE3) -> tuple[float, ...]:
    """Return the coordinates of a joint whose connectors differ by `D`; those of its record where they are the same pose."""
    found = _coordinates(D, joint.type)
    if not found:
        return joint.rest
    if joint.type is JointType.BALL:
        return joint.rest if _turned(found, joint.rest) < SAME_MM else found
    values = []
    for value, old, unit in zip(found, joint.rest, joint.type.units, strict=True):
        near = value + round((old - value) / math.tau) * math.tau if unit == "rad" else value
        values.append(old if abs(near - old) < SAME_MM else near)
    return tuple(values)


def _turned(a: tuple[float, ...], b: tuple[float, ...]) -> float:
    """Return the angle between two quaternions [rad]."""
    one, other = (SE3.from_quaternion(quaternion, (0.0, 0.0, 0.0)) for quaternion in (a, b))
    return float(np.linalg.norm((one.inverse() @ other).log()[3:]))


def _coordinates(D: SE3, kind: JointType) -> tuple[float, ...]:
    """Return the coordinates at which a joint of this kind puts its connectors apart by `D`, as near as it can."""
    R, along = D.rotation, float(D.translation[2])
    turn = math.atan2(R[1, 0] - R[0, 1], R[0, 0] + R[1, 1])
    return {
        JointType.REVOLUTE: (turn,),
        JointType.SCREW: (turn,),
        JointType.SLIDER: (along,),
        JointType.CYLINDRICAL: (along, turn),
        JointType.BALL: tuple(float(number) for number in D.quaternion),
    }.get(kind, ())


def _couplings_now(model: _Model, recorded: Assembly, joints: list[Joint], renamed: Mapping[str, str]) -> Iterator[Coupling]:
    """Yield the recorded couplings whose joints are there, with the ratios that the document has."""
    types = {joint.name: joint.type for joint in joints}
    before = {joint.name: joint.type for joint in recorded.joints}
    items = {item.text("ArticadJoint"): item for item in model.joint_items() if item.text("ArticadJoint")}
    for coupling in recorded.mechanism.couplings:
        item = items.get(coupling.name)
        if item is None and coupling.kind != "linear" and model.written is not None:
            continue  # deleted: an edit says so
        ends = [column.partition(".") for column in (coupling.a, coupling.b)]
        if any(joint not in renamed or types.get(renamed[joint]) is not before[joint] for joint, _, _ in ends):
            message = f"Coupling {coupling.name!r} is left out: a joint that it couples is gone, or of another type."
            hint = "Restore the joint, or remove the coupling."
            model.findings.append(Finding(code="W_FREECAD_EDIT", where=f"couplings.{coupling.name}", message=message, hint=hint))
            continue
        a, b = (f"{renamed[joint]}{dot}{coordinate}" for joint, dot, coordinate in ends)
        ratio = coupling.ratio * _rescaled(model, item)
        yield replace(coupling, name=coupling.name if item is None else model.joint_name(item), a=a, b=b, ratio=ratio)


def _rescaled(model: _Model, item: FreeCADObject | None) -> float:
    """Return by which factor the ratio of a coupling was changed in the document: gears and belts have two radii, others one."""
    held = None if item is None or model.written is None else model.written.get(item.name)
    if item is None or held is None:
        return 1.0
    factor = 1.0
    for key, power in (("Distance", 1), ("Distance2", -1)):
        before, now = held["values"].get(key), item.document.number(item.name, key)
        if (
            key in held["values"]
            and before
            and now
            and item.document.choice(item.name, "JointType") in ("Gears", "Belt", "RackPinion", "Screw")
        ):
            two = item.document.choice(item.name, "JointType") in ("Gears", "Belt")
            factor *= (now / before) ** power if two or key == "Distance" else 1.0
    return 1.0 if math.isclose(factor, 1.0, rel_tol=1e-12) else factor


def _records(model: _Model) -> list[dict[str, Any]]:
    """Return articad's records in a document; none of one made by hand.

    Raises:
        ReadError: If one of a part has no name, or its size is not what articad writes.
    """
    records = read_records(model.records.split("\n"), model.path) if model.records else []
    for record in records:
        sized = [(record[what], what) for what in ("solid", "drawn") if isinstance(record.get(what), dict)]
        if record["kind"] == "part" and not (isinstance(record.get("name"), str) and all(_is_size(*size) for size in sized)):
            raise unreadable(model.path, "articad metadata", "The record of a part has no name, or numbers that are none.")
    return records


def _is_size(size: Mapping[str, Any], what: str) -> bool:
    """Return whether a record has a volume and a centre, and of a solid its moments."""
    try:
        volume, com = float(size["volume"]), np.asarray(size["com"], dtype=np.float64)
        inertia = np.asarray(size["inertia"] if what == "solid" else np.eye(3), dtype=np.float64)
    except (KeyError, TypeError, ValueError, OverflowError):
        return False
    return (
        (volume > 0 or what == "drawn")
        and com.shape == (3,)
        and inertia.shape == (3, 3)
        and bool(np.isfinite([volume, *com, *inertia.flat]).all())
    )


def _recorded(records: list[dict[str, Any]], what: str) -> dict[str, dict[str, Any]]:
    """Return what articad recorded of parts: "solid" of exact shapes, "drawn" of meshes; volume and centre, of solids inertia too."""
    return {record["name"]: record[what] for record in records if record["kind"] == "part" and isinstance(record.get(what), dict)}


def _part_now(
    part: Part,
    name: str,
    model: _Model,
    joints: Sequence[Joint],
    densities: Mapping[str, float],
    sizes: Mapping[str, dict[str, Any]],
    meshes: Mapping[str, dict[str, Any]],
) -> Part:
    """Return a recorded part with the shape, connectors and colour that the document has, and the mass of that shape."""
    frames = model.connectors(name)
    connectors = {
        key: replace(connector, frame=_near(frames[key], connector.frame)) for key, connector in part.connectors.items() if key in frames
    }
    for joint in joints:
        for side, connector, frame in (
            (joint.parent, joint.parent_connector, joint.T_parent_connector),
            (joint.child, joint.child_connector, joint.T_child_connector),
        ):
            if side == name and connector not in connectors:
                connectors[connector] = part.connectors[connector] if connector in part.connectors else Connector(connector, frame)
    item = model.parts[name]
    material = item.text("ArticadMaterial") or part.material
    solid, color = model.solid(name), model.color(name) or part.color
    size, drawn = sizes.get(part.name), meshes.get(part.name)
    if solid is None:
        shapes = model.meshes(name)
        held = size is None if drawn is None else _same_mesh(shapes, drawn)
        mass = part.mass if held else None
        if not held and size is not None:
            model.missing(name, len(shapes))
        elif not held:
            model.reshaped(name)
        return replace(part, name=name, connectors=connectors, visuals=shapes, collisions=shapes, color=color, material=material, mass=mass)
    shown = Part.from_solid(name, solid, connectors=connectors, color=color, material=material)
    same = size is None or _same_shape(solid, size)
    if not same:
        model.reshaped(name)
    return replace(shown, mass=part.mass if same and material == part.material else _mass_now(part, solid, material, densities, size))


def _same_shape(solid: Solid, size: Mapping[str, Any]) -> bool:
    """Return whether a solid has the recorded volume, centre and inertia."""
    volume, com = float(size["volume"]), np.asarray(size["com"], dtype=np.float64)
    diagonal = float(np.linalg.norm(solid.bbox[1] - solid.bbox[0]))
    inertia = np.asarray(size["inertia"], dtype=np.float64)
    return (
        abs(solid.volume - volume) <= SAME_SHAPE * volume
        and float(np.linalg.norm(solid.com - com)) <= SAME_SHAPE * diagonal
        and float(np.linalg.norm(solid.inertia_mm5 - inertia)) <= SAME_SHAPE * float(np.linalg.norm(inertia))
    )


def _same_mesh(shapes: tuple[Shape, ...], drawn: Mapping[str, Any]) -> bool:
    """Return whether one mesh, which FreeCAD keeps in single precision, has the recorded volume and centre."""
    if len(shapes) != 1 or not shapes[0].mesh.is_closed:
        return False
    mesh = shapes[0].placed
    volume, com, *_ = mesh.solid_integrals()
    recorded = float(drawn["volume"])
    return abs(volume - recorded) <= SAME_MESH * recorded and float(
        np.linalg.norm(com - np.asarray(drawn["com"], dtype=np.float64))
    ) <= SAME_MESH * float(np.abs(mesh.vertices).max())


def _mass_now(
    part: Part, solid: Solid, material: str | None, densities: Mapping[str, float], size: Mapping[str, Any] | None
) -> MassProperties | None:
    """Return the mass of a solid: with the density of its material, else with the density that the recorded mass and volume give."""
    mass = part.mass
    if material is not None and material in densities and (material != part.material or mass is not None):
        return solid.mass(densities[material])
    return None if mass is None else solid.mass(mass.mass / ((solid.volume if size is None else float(size["volume"])) * 1e-9))


def _edit_findings(model: _Model) -> Iterator[Finding]:
    """Yield each edit as a finding: taken over, or not."""
    used = model.used()
    words = model.words(used)
    for edit in model.edits:
        taken = _taken(edit, used, words)
        yield Finding(
            code="I_FREECAD_EDIT" if taken else "W_FREECAD_EDIT",
            where=f"objects.{edit.object}",
            message=f"{edit}{'' if taken else ' It was not adopted.'}",
            hint="The assembly that was read has this change."
            if taken
            else _HINTS.get(edit.key, "An assembly cannot represent it; keep the document."),
        )


_OTHER_MASS = "Masses follow the property ArticadMaterial of the part: set it to the name of a material of the plan."
_HINTS = dict.fromkeys(("ShapeMaterial", "ArticadDensity", "ArticadMass"), _OTHER_MASS)


def _taken(edit: Edit, used: set[str], words: set[str]) -> bool:
    """Return whether an edit is in the assembly that was read.

    Args:
        edit: The edit.
        used: Objects on which parts and joints of the assembly depend.
        words: Words of their expressions.
    """
    if edit.kind in ("joint", "limit", "ground", "connector", "group", "material"):
        return True
    if edit.kind == "moved":  # `_elsewhere` names a part that stands elsewhere than its joints allow
        return True
    if edit.kind == "label":
        return edit.type in (*_CONTAINERS, "App::FeaturePython")
    if edit.kind == "deleted":
        return True
    if edit.kind in ("parameter", "dimension", "expression") and edit.type == "App::VarSet":
        return edit.key in words
    return edit.kind != "note" and edit.key not in ("ArticadMass", "ArticadDensity") and edit.object in used


def _elsewhere(model: _Model, made: Assembly) -> Iterator[Finding]:
    """Yield the parts that stand elsewhere in the document than their joints put them; where loops do not close, the joints that do not hold."""
    try:
        poses = made.at()
    except LoopError:  # whoever needs poses is told of the loop
        yield from model.apart(made.joints)
        return
    D = SE3.stack(list(poses.values())).inverse() @ SE3.stack([model.poses[name] for name in poses])
    for name, far, turned in zip(poses, *map(np.ndarray.tolist, sizes(D)), strict=True):
        if far > STANDS_MM or turned > STANDS_RAD:
            yield Finding(
                code="W_FREECAD_ELSEWHERE",
                where=f"parts.{name}",
                parts=(name,),
                message=f"Part {name!r} stands {far:.4g} mm and {math.degrees(turned):.3g}° from where its joints put it.",
                hint="Solve the assembly in FreeCAD and save it; the joints were read as they are.",
                value=far,
                limit=STANDS_MM,
                unit="mm",
            )


def _closure(start: Iterable[str], links: Mapping[str, Iterable[str]]) -> set[str]:
    """Return names and all that their links lead to."""
    found, waiting = set[str](), list(start)
    while waiting:
        name = waiting.pop()
        if name not in found:
            found.add(name)
            waiting += links.get(name, ())
    return found


def _neighbours(joints: Iterable[Joint]) -> dict[str, list[str]]:
    """Return the parts that joints connect to each part."""
    found: dict[str, list[str]] = {}
    for joint in joints:
        found.setdefault(joint.parent, []).append(joint.child)
        found.setdefault(joint.child, []).append(joint.parent)
    return found


def _joints_by_part(joints: Iterable[Joint]) -> dict[str, list[Joint]]:
    """Return the joints of each part that has any."""
    found: dict[str, list[Joint]] = {}
    for joint in joints:
        for name in {joint.parent, joint.child}:
            found.setdefault(name, []).append(joint)
    return found


def _free(wanted: str, taken: Any, numbers: dict[str, int] | None = None) -> str:
    """Return a name that is not taken: the wanted one, or with a number.

    Args:
        wanted: The name.
        taken: The names that are taken; none is ever given back.
        numbers: By name, where to begin to count; kept for the next call.
    """
    numbers = {} if numbers is None else numbers
    name = wanted
    while name in taken:
        number = numbers.get(wanted, 2)
        name, numbers[wanted] = f"{wanted}_{number}", number + 1
    return name


def _wound(angle: float, low: float, high: float) -> float:
    """Return the angle of the same pose that is within limits, else the one nearest to them [rad]."""
    bounds = [bound for bound in (low, high) if math.isfinite(bound)]
    if not bounds or low <= angle <= high:
        return angle
    middle = sum(bounds) / len(bounds)
    near = angle + math.tau * round((middle - angle) / math.tau)
    return next((turned for turned in (near, near - math.tau, near + math.tau) if low <= turned <= high), near)


def _limits(ends: list[tuple[str, tuple[float, float]]], rest: tuple[float, ...]) -> JointLimits:
    """Return limits that contain the rest value: FreeCAD allows a part to rest outside its limits."""
    pairs = [(min(low, value), max(high, value)) for value, (_, (low, high)) in zip(rest, ends, strict=False)]
    return JointLimits(tuple(low for low, _ in pairs), tuple(high for _, high in pairs))


def _near(now: SE3, recorded: SE3) -> SE3:
    return recorded if now.allclose(recorded, mm=SAME_MM, rad=SAME_RAD) else now


def _plain(text: str) -> str:
    """Return a label, or the beginning of a long one, as a valid name."""
    name = re.sub(r"[^a-z0-9]+", "_", text[:MAX_NAME].lower()).strip("_")
    return name if name[:1].isalpha() else f"n{name}"
