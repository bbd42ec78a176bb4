"""Restores an assembly from the records that articad's exporters leave in files of other formats (`articad.export.metadata`)."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable
from pathlib import Path
from typing import Any, get_args

import numpy as np

from articad.aliases import Fastening
from articad.assembly import Assembly, Kept
from articad.connectors.connector import Connector
from articad.connectors.mate import Mate
from articad.connectors.se3 import SE3
from articad.errors import ArticadError
from articad.export.fingerprint import fingerprint
from articad.findings import Finding
from articad.geometry.faceted import facets
from articad.geometry.mass import MassProperties
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Part, Primitive, Shape, Solid
from articad.geometry.shapes import primitive_mesh
from articad.importers.described import Meshes, Rewritten, describes, names_its_meshes
from articad.importers.reading import LARGEST_MM, Folder, unreadable
from articad.kinematics.joints import Coupling, Joint, JointLimits, JointType
from articad.kinematics.mechanism import Mechanism
from articad.plan.resolve import Fit, Material, Waiver
from articad.texts import SPOILED, spoiled

VERSION = 1
MAX_VALUES = 4_000_000  # of all records of a file; an empty list takes twenty times its place in the text
PRIMITIVES = {"box": 3, "cylinder": 2, "sphere": 1, "capsule": 2, "ellipsoid": 3}  # numbers of their sizes

Record = dict[str, Any]
Scale = tuple[float, float, float]

_UNIT: Scale = (1.0, 1.0, 1.0)  # articad writes meshes in mm


def read_records(texts: Iterable[str], path: Path) -> list[Record]:
    """Return the records in a file.

    Raises:
        ReadError: If one is not a JSON object with a kind, or of a later version, or there are too many values.
    """
    records, texts = [], list(texts)
    if (values := sum(text.count(mark) for text in texts for mark in "[{,")) > MAX_VALUES:
        raise unreadable(path, "articad metadata", f"The records have {values} values; the maximum is {MAX_VALUES}.")
    for text in texts:
        try:
            record = json.loads(text, parse_constant=_refused_number)
        except (ValueError, RecursionError) as error:
            raise unreadable(path, "articad metadata", f"A record is not JSON: {error}.") from None
        if not isinstance(record, dict) or not isinstance(record.get("kind"), str):
            raise unreadable(path, "articad metadata", "A record is not an object with a kind.")
        if spoiled(record) is not None:
            raise unreadable(path, "articad metadata", f"A record holds {SPOILED}.")
        records.append(record)
    for record in records:
        if record["kind"] == "assembly" and record.get("version") != VERSION:
            raise unreadable(path, "articad metadata", f"Version {record.get('version')!r} is not {VERSION}; a newer articad wrote it.")
    return records


def stale(records: list[Record], elements: Iterable[Any], path: Path) -> list[Finding]:
    """Return a finding if the file was edited after articad wrote it: then the file counts, not the records."""
    written = next((record.get("fingerprint") for record in records if record["kind"] == "assembly"), None)
    if written is None or written == fingerprint(elements):
        return []
    message = f"{path.name} was edited after articad wrote it, so it is read like any other file, without articad's records."
    hint = "Edit the plan instead and export again, or remove the <articad> records from the file."
    return [Finding(code="W_IMPORT_STALE", where=str(path), message=message, hint=hint)]


def unedited(
    texts: Iterable[str],
    elements: Iterable[Any],
    folder: Folder,
    path: Path,
    stated: Iterable[Any],
    rewritten: Rewritten,
    meshes: Meshes | None = None,
) -> tuple[Assembly | None, list[Finding]]:
    """Return the assembly that a file's records describe; None if it has none, or with a finding if they do not describe the file.

    Args:
        texts: The records.
        elements: The elements that tell an edit.
        folder: For the meshes.
        path: The file.
        stated: The elements that state the mechanism; they are compared with those that the records give.
        rewritten: Writes the assembly again; yields these elements.
        meshes: Looks up the meshes that they name; without it, the names are those of files.

    Raises:
        ReadError: If records are missing, or do not have the form that articad writes.
    """
    records, elements = read_records(texts, path), list(elements)
    if not records:
        return None, []
    if edited := stale(records, elements, path):
        return None, edited
    own = assembly_of(records, folder, path)
    named = all(names_its_meshes(record, elements) for record in records if record["kind"] == "part")
    incomplete = {finding.where.removeprefix("parts.") for finding in folder.findings}
    if named and describes(own, stated, meshes or folder.unscaled, rewritten, incomplete=incomplete):
        return own, []
    message = f"The articad records in {path.name} do not describe its own elements, so it is read like any other file, without them."
    hint = "Export it again from its plan or run; if somebody else gave you the file, do not trust its records."
    return None, [Finding(code="W_IMPORT_STALE", where=str(path), message=message, hint=hint)]


def assembly_of(records: list[Record], folder: Folder, path: Path) -> Assembly:
    """Return the assembly that the records describe, with the meshes of the files that they name.

    Raises:
        ReadError: If records are missing, or do not have the form that articad writes.
    """
    try:
        return _assembly(records, folder)
    except (KeyError, TypeError, ValueError, IndexError, OverflowError) as error:
        raise unreadable(path, "articad metadata", f"The records are incomplete: {type(error).__name__} {error}.") from None
    except ArticadError as error:
        if any(finding.code == "E_UNSAFE_PATH" for finding in error.findings):
            raise
        raise unreadable(path, "articad metadata", f"The records do not form an assembly: {error.message}") from error


def _assembly(records: list[Record], folder: Folder) -> Assembly:
    by_kind: dict[str, list[Record]] = {}
    for record in records:
        by_kind.setdefault(record["kind"], []).append(record)
    (head,) = by_kind["assembly"]
    parts = {record["name"]: _part(record, folder) for record in by_kind.get("part", [])}
    mechanism = Mechanism(
        tuple(parts),
        head["ground"],
        [_joint(record) for record in by_kind.get("joint", [])],
        [_coupling(record) for record in by_kind.get("coupling", [])],
        T_ground=_frame(head["frame"]),
    )
    return Assembly(
        name=head["name"],
        mechanism=mechanism,
        parts=parts,
        materials={record["name"]: Material(**_without_kind(record)) for record in by_kind.get("material", [])},
        fits={record["joint"]: Fit(**_without_kind(record, "joint")) for record in by_kind.get("fit", [])},
        waivers=tuple(Waiver(**_without_kind(record) | {"parts": tuple(record["parts"])}) for record in by_kind.get("waiver", [])),
        deflection=head["deflection"],
        foreign=head.get("foreign", False) is True,
        kept=tuple(Kept(**{key: str(value) for key, value in _without_kind(record).items()}) for record in by_kind.get("kept", [])),
    )


def _part(record: Record, folder: Folder) -> Part:
    where = f"parts.{record['name']}"

    def mesh(file: str | None) -> TriMesh | None:
        if not isinstance(file, str | None):
            raise TypeError("a mesh is not the name of a file")
        return None if file is None else folder.mesh(file, _UNIT, where)

    def shapes(rows: list[Record]) -> tuple[Shape, ...]:
        if not all(isinstance(row, dict) for row in rows):
            raise TypeError("a shape is not an object")
        formed = ((row, _primitive(row.get("primitive"))) for row in rows)
        found = ((row, form, mesh(row["file"]) if form is None else _mesh_of(form, mesh(row["file"]))) for row, form in formed)
        return tuple(Shape(body, _frame(row["frame"]), row["color"], row["name"], form) for row, form, body in found if body is not None)

    return Part(
        record["name"],
        {row["name"]: _connector(row) for row in record["connectors"]},
        shapes(record["visuals"]),
        shapes(record["collisions"]),
        _solid(record["solid"], mesh),
        None if record["mass"] is None else _mass(record["mass"]),
        record["color"],
        record["material"],
    )


def _mesh_of(form: Primitive, stored: TriMesh | None) -> TriMesh:
    """Return the stored mesh of a primitive, of whatever facets, or one that is made if there is none.

    Raises:
        ValueError: If the stored mesh stands for something else.
    """
    if stored is not None and not facets(stored, form):
        raise ValueError(f"the mesh of a {form.kind} has another shape")
    return primitive_mesh(form) if stored is None else stored


def _primitive(record: list[Any] | None) -> Primitive | None:
    if record is None or record[0] not in PRIMITIVES:
        return None
    size = tuple(float(size) for size in record[1:])
    if len(size) != PRIMITIVES[record[0]] or not all(0 < length <= LARGEST_MM for length in size):
        raise ValueError("the size of a shape is not plausible")
    return Primitive(record[0], size)


def _solid(record: Record | None, mesh: Any) -> Solid | None:
    body = None if record is None else mesh(record["file"])
    if record is None or body is None:
        return None
    numbers = (record["deflection"], record["volume"], record["area"])
    return Solid(body, None, None, *numbers, np.array(record["com"], dtype=np.float64), np.array(record["inertia"]), body.bounds)


def _mass(record: Record) -> MassProperties:
    return MassProperties(record["kg"], np.array(record["com"]), np.array(record["inertia"]))


def _connector(record: Record) -> Connector:
    return Connector(record["name"], _frame(record["frame"]), record["label"], record["type"], record["roll_free"])


def _joint(record: Record) -> Joint:
    twist = record["twist"]
    return Joint(
        name=record["name"],
        type=JointType(record["type"]),
        parent=record["parent"],
        child=record["child"],
        parent_connector=record["parent_connector"],
        child_connector=record["child_connector"],
        T_parent_connector=_frame(record["parent_frame"]),
        T_child_connector=_frame(record["child_frame"]),
        mate=Mate(record["mate"]),
        limits=JointLimits(
            tuple(-math.inf if value is None else float(value) for value in record["lower"]),
            tuple(math.inf if value is None else float(value) for value in record["upper"]),
            record["cone"],
            None if twist is None else (float(twist[0]), float(twist[1])),
        ),
        rest=tuple(float(value) for value in record["rest"]),
        lead=record["lead"],
        driver=record["driver"],
        closing=record.get("closing", False) is True,
        effort=tuple(record["effort"]),
        velocity=tuple(record["velocity"]),
        damping=tuple(record.get("damping", ())),
        friction=tuple(record.get("friction", ())),
        fastening=_fastening(record.get("fastening")),
    )


def _fastening(stated: object) -> Fastening | None:
    known: Fastening | None = next((each for each in get_args(Fastening) if each == stated), None)
    if stated is not None and known is None:
        raise ValueError("the fastening of a joint is not known")
    return known


def _coupling(record: Record) -> Coupling:
    return Coupling(record["name"], record["type"], record["a"], record["b"], record["ratio"], record["offset"])


def _frame(numbers: list[float]) -> SE3:
    x, y, z, *xyzw = (float(number) for number in numbers)
    if max(abs(x), abs(y), abs(z)) > LARGEST_MM:
        raise ValueError("the position of a frame is not plausible")
    if len(numbers) != 7 or not all(map(math.isfinite, numbers)) or not abs(math.hypot(*xyzw) - 1) < 1e-12:
        return SE3.from_quaternion(xyzw, [x, y, z])  # refuses anything but a rotation
    return SE3.from_unit_array(np.array([x, y, z, *xyzw]))


def _without_kind(record: Record, *more: str) -> Record:
    return {key: value for key, value in record.items() if key not in {"kind", *more}}


def _refused_number(name: str) -> float:
    raise ValueError(f"{name} is not a number")
