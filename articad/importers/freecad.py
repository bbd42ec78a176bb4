"""Reads a FreeCAD assembly document, written by articad or made by hand; FreeCAD need not be installed.

The file is a zip of XML and B-rep; the B-rep is read in the kernels' confined worker. Frames come from the document as it is now, so
edits in FreeCAD are kept; what FreeCAD cannot represent (cones, leads, labels, drivers, couplings, fits) comes from articad's records in
it.
"""

from __future__ import annotations

import math
import re
import tempfile
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path

from articad.assembly import Assembly
from articad.connectors.connector import Connector
from articad.connectors.mate import FLIP, Mate
from articad.connectors.se3 import SE3
from articad.errors import ArticadError
from articad.files import read_file
from articad.findings import Finding, Findings
from articad.geometry.part import DEFAULT_COLOR, Part, Shape, Solid
from articad.importers.freecad_mesh import read_mesh_kernel
from articad.importers.reading import LARGEST_MM, MAX_XML_BYTES, Folder, parse_xml, unreadable
from articad.importers.records import assembly_of, read_records
from articad.kernels.archive import Archive, BadArchiveError
from articad.kernels.freecad import BrepReader
from articad.kinematics.joints import Joint, JointLimits, JointType
from articad.kinematics.mechanism import Mechanism
from articad.processes import scratch

MAX_BYTES, MAX_UNPACKED, MAX_ENTRIES = 256 * 2**20, 384 * 2**20, 20_000
SAME_MM, SAME_RAD = 1e-9, 1e-12  # a frame this close to its record is replaced by the record
_TYPES = {
    "Fixed": JointType.FIXED,
    "Revolute": JointType.REVOLUTE,
    "Slider": JointType.SLIDER,
    "Cylindrical": JointType.CYLINDRICAL,
    "Ball": JointType.BALL,
}
_CONTAINERS = ("App::Part", "App::Link", "Mesh::Feature")
_LIMITS = {
    JointType.REVOLUTE: ("Angle",),
    JointType.SLIDER: ("Length",),
    JointType.CYLINDRICAL: ("Length", "Angle"),
}

IDENTITY = SE3.identity()


def read_freecad(path: str | Path, *, root: str | Path | None = None, metadata: bool = True, deflection: float = 0.01) -> Assembly:
    """Read the assembly of a FreeCAD file.

    Args:
        path: The file, `.FCStd`.
        root: Unused: a FreeCAD file holds all of its shapes.
        metadata: Use the records that articad left in its own files, for what FreeCAD cannot represent.
        deflection: Largest distance of the meshes from the solids [mm].

    Raises:
        ReadError: If it is not a FreeCAD file, or contains no assembly with a grounded part.
    """
    del root
    path = Path(path)
    document = _Document(path)
    model = _Model(document, deflection)
    text = document.text(model.assembly, "ArticadRecords") if metadata else ""
    if text:
        folder = Folder.of(path, None)
        recorded = assembly_of(read_records(text.split("\n"), path), folder, path)
        return _updated(model, recorded)
    return model.assemble()


@cache
def _kept() -> tempfile.TemporaryDirectory[str]:
    """Return the folder for the B-rep files that were read; they can be written again until this process ends."""
    return scratch.folder("read")


class _Document:
    """The XML of a FreeCAD file: objects by name, with their properties."""

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            self.archive = Archive(read_file(path, MAX_BYTES), entries=MAX_ENTRIES, unpacked=MAX_UNPACKED)
            self.root = parse_xml(self.archive.read("Document.xml", MAX_XML_BYTES), path)
        except OSError as error:
            raise unreadable(path, "", f"It cannot be read: {error.strerror}.") from None
        except BadArchiveError as error:
            raise unreadable(path, "", f"It is not a FreeCAD file: {error}.") from None
        self.types = {item.get("name", ""): item.get("type", "") for item in self.root.iterfind("Objects/Object")}
        self.items = {item.get("name", ""): item for item in self.root.iterfind("ObjectData/Object")}
        self._properties = {
            name: {row.get("name"): row for row in item.iterfind("Properties/Property")} for name, item in self.items.items()
        }

    def value(self, name: str, key: str, tag: str, attribute: str = "value") -> str | None:
        row = self._properties.get(name, {}).get(key)
        found = None if row is None else row.find(f".//{tag}")
        return None if found is None else found.get(attribute)

    def text(self, name: str, key: str) -> str:
        return self.value(name, key, "String") or ""

    def has(self, name: str, key: str) -> bool:
        return key in self._properties.get(name, {})

    def truth(self, name: str, key: str, *, default: bool = False) -> bool:
        value = self.value(name, key, "Bool")
        return default if value is None else value == "true"

    def number(self, name: str, key: str) -> float:
        try:
            number = float(self.value(name, key, "Float") or 0.0)
        except ValueError:
            raise unreadable(self.path, f"{name}.{key}", "It is not a number.") from None
        if not abs(number) <= LARGEST_MM:  # also refuses NaN
            raise unreadable(self.path, f"{name}.{key}", "It is not a plausible number.")
        return number

    def choice(self, name: str, key: str) -> str:
        row = self._properties[name][key]
        found = row.find(".//Integer")
        try:
            index = -1 if found is None else int(found.get("value") or 0)
        except ValueError:
            raise unreadable(self.path, f"{name}.{key}", "It is not a whole number.") from None
        options = [option.get("value") for option in row.iterfind(".//Enum")]
        return str(options[index]) if 0 <= index < len(options) else ""

    def links(self, name: str, key: str) -> list[str]:
        row = self._properties.get(name, {}).get(key)
        if row is None:
            return []
        return [found.get("value") or found.get("name") or "" for found in row.iter() if found.tag in ("Link", "XLink")]

    def is_shape(self, name: str) -> bool:
        """Return whether an object is a body or a solid of the Part workbench, such as a box or a cut."""
        kind = self.types.get(name, "")
        return kind == "PartDesign::Body" or (kind.startswith("Part::") and not kind.startswith(("Part::Part2D", "Part::Datum")))

    def results(self, members: list[str]) -> list[str]:
        """Return the shapes among the members of a group from which no other member is made."""
        shapes = [name for name in members if self.is_shape(name)]
        used = {link for name in shapes for key in self._properties[name] if key != "Group" for link in self.links(name, str(key))}
        return [name for name in shapes if name not in used]

    def placement(self, name: str, key: str = "Placement") -> SE3:
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

    def reference(self, name: str, key: str) -> list[str]:
        """Return the objects along a reference, starting at the one that states it."""
        row = self._properties.get(name, {}).get(key)
        link = None if row is None else row.find(".//XLink")
        if link is None:
            return []
        sub = link.find("Sub")
        tail = (sub.get("value") if sub is not None else link.get("sub")) or ""
        names = [link.get("name") or "", *tail.split(".")[:-1]]
        return [step for step in names if step in self.items]


class _Model:
    """Parts, connectors and joints of a document, as it contains them."""

    def __init__(self, document: _Document, deflection: float) -> None:
        self.document, self.deflection = document, deflection
        assemblies = [name for name, kind in document.types.items() if kind == "Assembly::AssemblyObject"]
        if not assemblies:
            raise unreadable(document.path, "Document.xml", "It contains no assembly.")
        self.assembly = assemblies[0]
        members = document.links(self.assembly, "Group")
        self.parts = {
            self._name(item): item
            for item in members
            if (document.types.get(item) in _CONTAINERS or document.is_shape(item)) and not document.has(item, "JointType")
        }
        self.names = {item: name for name, item in self.parts.items()}
        grounded = [document.links(item, "ObjectToGround") for item in document.items if document.has(item, "ObjectToGround")]
        if not grounded or not grounded[0] or grounded[0][0] not in self.names:
            raise unreadable(document.path, self.assembly, "No part of the assembly is grounded.")
        self.ground = self.names[grounded[0][0]]
        self.poses = {name: document.placement(item) for name, item in self.parts.items()}
        self.findings: list[Finding] = []
        self._solids: dict[str, Solid | None] = {}
        self._reader = BrepReader()

    def _name(self, item: str) -> str:
        return self.document.text(item, "ArticadPart") or _plain(self.document.text(item, "Label") or item)

    def container(self, item: str) -> str:
        """Return the object that a link shows, or the object itself."""
        seen: set[str] = set()
        while self.document.types.get(item) == "App::Link" and item not in seen:
            seen.add(item)
            item = next(iter(self.document.links(item, "LinkedObject")), item)
        return item

    def connectors(self, name: str) -> dict[str, SE3]:
        """Return the coordinate systems that articad made in a part."""
        members = self.document.links(self.container(self.parts[name]), "Group")
        return {text: self.document.placement(item) for item in members if (text := self.document.text(item, "ArticadConnector"))}

    def solid(self, name: str) -> Solid | None:
        """Return a part's solid in the part's own frame, measured by the confined worker."""
        container = self.container(self.parts[name])
        if container not in self._solids:
            self._solids[container] = self._measured(container, name)
        return self._solids[container]

    def _measured(self, container: str, name: str) -> Solid | None:
        own = self.document.is_shape(container)
        members = [container] if own else self.document.results(self.document.links(container, "Group"))
        for item in members:
            file = self.document.value(item, "Shape", "Part", "file")
            if not file or file not in self.document.archive.names:
                continue
            # B-rep is written in the object's frame; a body that is a part itself is in the assembly's
            T = self.document.placement(item).inverse() if own else IDENTITY
            try:
                folder = Path(tempfile.mkdtemp(dir=_kept().name))
                return self._reader.read_brep(self.document.archive.read(file), name=name, T=T, deflection=self.deflection, folder=folder)
            except (ArticadError, BadArchiveError) as error:
                self._misshapen(name, f"The shape of {item} is not one valid solid: {str(error)[:200]}")
        return None

    def meshes(self, name: str) -> tuple[Shape, ...]:
        """Return the meshes of a part that is not a solid, in the part's own frame."""
        container = self.container(self.parts[name])
        own = self.document.types.get(container) == "Mesh::Feature"
        found = []
        for item in [container] if own else self.document.links(container, "Group"):
            file = self.document.value(item, "Mesh", "Mesh", "file")
            if self.document.types.get(item) == "Mesh::Feature" and file in self.document.archive.names:
                try:
                    mesh = read_mesh_kernel(self.document.archive.read(file))
                except (ArticadError, BadArchiveError) as error:
                    self._misshapen(name, f"The mesh of {item} is left out: {str(error)[:200]}")
                    continue
                found.append(Shape(mesh, IDENTITY if own else self.document.placement(item)))
        return tuple(found)

    def _misshapen(self, name: str, message: str) -> None:
        hint = "Repair it in FreeCAD."
        self.findings.append(Finding(code="W_FREECAD_SHAPE", where=f"parts.{name}", parts=(name,), message=message, hint=hint))

    # ------------------------------------------------------------------ joints

    def joints(self) -> Iterator[tuple[str, Joint]]:
        """Yield each active joint whose type articad supports, with its object."""
        document = self.document
        for item in document.items:
            off = not document.truth(item, "Activated", default=True) or document.truth(item, "Suppressed")  # in FreeCAD 1.0, in 1.1
            if off or not document.has(item, "JointType"):
                continue
            kind = document.choice(item, "JointType")
            sides = [self._side(item, number) for number in (1, 2)]
            name = document.text(item, "ArticadJoint") or _plain(document.text(item, "Label") or item)
            if kind not in _TYPES or None in sides:
                if not document.text(item, "ArticadJoint"):
                    why = (
                        "has a type that articad does not support"
                        if kind not in _TYPES
                        else "has a side that is not a part of the assembly"
                    )
                    self.findings.append(
                        Finding(
                            code="W_FREECAD_JOINT",
                            where=f"joints.{name}",
                            message=f"Joint {item} ({kind}) {why} and was left out.",
                            hint="Use Fixed, Revolute, Slider, Cylindrical or Ball between two parts of the assembly.",
                        )
                    )
                continue
            yield item, self._joint(item, name, _TYPES[kind], *[side for side in sides if side is not None])

    def _side(self, item: str, number: int) -> tuple[str, str, SE3] | None:
        """Return the part, the connector's name and its frame in the part of one side of a joint."""
        steps = self.document.reference(item, f"Reference{number}")
        places = [place for place, step in enumerate(steps) if step in self.names]
        if not places:
            return None
        frame, part = IDENTITY, steps[places[0]]
        for step in steps[places[0] + 1 :]:
            frame = frame @ self.document.placement(step)
        last = steps[-1]
        connector = self.document.text(last, "ArticadConnector")
        named = connector or _plain(f"{self.document.text(item, 'Label') or item}_{number}")
        offset = self.document.placement(item, f"Placement{number}")
        return self.names[part], named, frame if connector else frame @ offset

    def _joint(self, item: str, name: str, kind: JointType, parent: tuple[str, str, SE3], child: tuple[str, str, SE3]) -> Joint:
        D = (self.poses[parent[0]] @ parent[2]).inverse() @ self.poses[child[0]] @ child[2]
        mate = Mate.ALIGNED if D.rotation[2, 2] >= 0 else Mate.OPPOSED
        motion = D @ (FLIP if mate is Mate.OPPOSED else IDENTITY)
        R, along = motion.rotation, float(motion.translation[2])
        turn = math.atan2(R[1, 0] - R[0, 1], R[0, 0] + R[1, 1])
        rest: tuple[float, ...] = {
            JointType.REVOLUTE: (turn,),
            JointType.SLIDER: (along,),
            JointType.CYLINDRICAL: (along, turn),
            JointType.BALL: tuple(float(number) for number in motion.quaternion),
        }.get(kind, ())
        ends = self._ends(item, kind)
        rest = (
            tuple(_wound(value, *end) if axis == "Angle" else value for value, (axis, end) in zip(rest, ends, strict=True))
            if ends
            else rest
        )
        return Joint(
            name=name,
            type=kind,
            parent=parent[0],
            child=child[0],
            parent_connector=parent[1],
            child_connector=child[1],
            T_parent_connector=parent[2],
            T_child_connector=child[2],
            limits=_limits(ends, rest),
            rest=rest,
            mate=mate,
        )

    def _ends(self, item: str, kind: JointType) -> list[tuple[str, tuple[float, float]]]:
        """Return the names of FreeCAD's limits of a joint, and their values [mm, rad]."""
        ends = []
        for axis in _LIMITS.get(kind, ()):
            scale = math.radians(1.0) if axis == "Angle" else 1.0
            low, high = (
                self.document.number(item, f"{axis}{end}") * scale if self.document.truth(item, f"Enable{axis}{end}") else endless
                for end, endless in (("Min", -math.inf), ("Max", math.inf))
            )
            ends.append((axis, (low, high)))
        return ends

    def assemble(self) -> Assembly:
        """Return the assembly of a document that articad did not write."""
        joints = [joint for _, joint in self.joints()]
        parts = []
        for name in self.parts:
            frames = dict(self.connectors(name))
            for joint in joints:
                if joint.parent == name:
                    frames[joint.parent_connector] = joint.T_parent_connector
                if joint.child == name:
                    frames[joint.child_connector] = joint.T_child_connector
            solid = self.solid(name)
            shapes = self.meshes(name) if solid is None else ()
            connectors = {key: Connector(key, frame) for key, frame in frames.items()}
            parts.append(
                Part(name, connectors, shapes, shapes)
                if solid is None
                else Part.from_solid(name, solid, connectors=connectors, color=DEFAULT_COLOR)
            )
        title = self.document.text(self.assembly, "Label") or self.document.path.stem
        try:
            made = Assembly.from_parts(_plain(title), parts=parts, joints=joints, ground=self.ground, T_ground=self.poses[self.ground])
        except ArticadError as error:
            raise unreadable(self.document.path, self.assembly, f"It is not a valid mechanism: {error.message}") from error
        return replace(made, findings=Findings(self.findings), foreign=True)


def _updated(model: _Model, recorded: Assembly) -> Assembly:
    """Return the assembly of the records, with frames, limits and shapes as the document has them now."""
    found = {joint.name: joint for _, joint in model.joints()}
    connectors = {name: model.connectors(name) for name in model.parts}
    parts = {name: _part_now(part, connectors.get(name, {}), model) for name, part in recorded.parts.items() if name in model.parts}
    if set(parts) != set(recorded.parts) or model.ground != recorded.ground:
        return model.assemble()  # parts were removed: the records no longer apply
    joints = [_joint_now(joint, found.get(joint.name), parts) for joint in recorded.joints]
    mechanism = Mechanism(
        tuple(parts),
        recorded.ground,
        joints,
        recorded.mechanism.couplings,
        T_ground=_near(model.poses[model.ground], recorded.mechanism.T_ground),
    )
    return replace(recorded, mechanism=mechanism, parts=parts, findings=Findings(model.findings))


def _part_now(part: Part, frames: dict[str, SE3], model: _Model) -> Part:
    connectors = {
        name: replace(connector, frame=_near(frames.get(name, connector.frame), connector.frame))
        for name, connector in part.connectors.items()
    }
    solid = model.solid(part.name)
    if solid is None:
        shapes = model.meshes(part.name)
        return replace(part, connectors=connectors, visuals=shapes, collisions=shapes)
    shown = Part.from_solid(part.name, solid, connectors=connectors, color=part.color, material=part.material)
    return replace(shown, mass=part.mass)


def _joint_now(joint: Joint, found: Joint | None, parts: dict[str, Part]) -> Joint:
    now = replace(
        joint,
        T_parent_connector=parts[joint.parent].connectors[joint.parent_connector].frame,
        T_child_connector=parts[joint.child].connectors[joint.child_connector].frame,
    )
    if found is None or found.type is not joint.type or joint.type not in _LIMITS:
        return now
    periods = [math.tau if axis == "Angle" else math.inf for axis in _LIMITS[joint.type]]
    turned = [
        new + round((old - new) / period) * period if period < math.inf else new
        for new, old, period in zip(found.rest, joint.rest, periods, strict=True)
    ]
    limits = tuple(
        tuple(old if math.isclose(new, old, rel_tol=1e-12, abs_tol=1e-12) else new for new, old in zip(new_row, old_row, strict=True))
        for new_row, old_row in ((found.limits.lower, joint.limits.lower), (found.limits.upper, joint.limits.upper))
    )
    rest = tuple(old if abs(new - old) < SAME_MM else seen for seen, new, old in zip(found.rest, turned, joint.rest, strict=True))
    return replace(now, limits=JointLimits(limits[0], limits[1]), rest=rest)


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
    """Return a label as a valid name."""
    name = re.sub(r"[^a-z0-9]+", "_", text.lower()).strip("_")
    return name if name[:1].isalpha() else f"n{name}"
