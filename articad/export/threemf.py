"""3MF print pack: one file per part, on its best face, closed meshes only, with a check of the clearance that a process needs."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal

import numpy as np
from lxml import etree

from articad.arrays import FloatArray
from articad.connectors.se3 import SE3
from articad.errors import ExportError
from articad.export.bundle import Bundle
from articad.export.features import body_mesh, motion_and_mass
from articad.export.losses import Feature, kept_losses, losses_of, refuse
from articad.export.markup import child, document, texts
from articad.export.names import FileNames
from articad.export.product import of_the_product
from articad.findings import Finding, Findings
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Part
from articad.kernels.contract import LIGHT
from articad.kinematics.joints import JointType
from articad.texts import escaped

if TYPE_CHECKING:
    from articad.assembly import Assembly

Process = Literal["fdm", "sla", "sls"]

CLEARANCE_MM: dict[Process, float] = {"fdm": 0.2, "sla": 0.1, "sls": 0.3}
"""Smallest gap at which each process reliably prints two surfaces apart."""
SAME_PLANE_MM = 0.01  # faces this close to the lowest point lie on the bed
SAME_DIRECTION = 1e-3  # rad: normals that count as one
CANDIDATES = 12  # directions tried as "down", those with the largest flat area first
MOST_TRIANGLES = 2000  # flat faces consist of large triangles; small ones belong to curved faces
_CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
_TIME = (2000, 1, 1, 0, 0, 0)  # the same part gives the same bytes
_CONTENT_TYPES = (
    b'<?xml version="1.0" encoding="UTF-8"?>\n<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
    b'<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
    b'<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>'
)
_RELATIONS = (
    b'<?xml version="1.0" encoding="UTF-8"?>\n<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
    b'<Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>'
)


@of_the_product
def write_3mf(assembly: Assembly, *, strict: bool = False, process: Process = "fdm") -> Bundle:
    """Write one 3MF file per part, in mm, rotated so that it stands on the largest flat face that it can stand on.

    Args:
        assembly: What to write. A part whose mesh is open is omitted with an error; a part without any shape is a loss, because there is
            nothing to print.
        strict: Refuse losses of motion, mass or shape; printed parts have no joints, so only a single body passes.
        process: The printing process: joints whose declared gap is smaller than the process needs are findings, if both parts are as
            light as plastic or wood.

    Returns:
        `<part>.3mf` for each part, the losses, and findings about clearance.

    Raises:
        UnrepresentableError: If `strict` and there is such a loss.
        ExportError: If no part has a shape.
    """
    losses = (*losses_of("3mf", _features(assembly)), *kept_losses("3mf", assembly.kept))
    if strict:
        refuse(losses)
    files: dict[str, bytes] = {}
    findings = list(_clearances(assembly, process))
    names = FileNames()
    for name, part in assembly.parts.items():
        mesh = body_mesh(part)
        if mesh is None:
            continue
        if not mesh.is_closed:
            message = f"The mesh of part {name!r} is not closed, so it cannot be printed."
            findings.append(
                Finding(code="E_MESH_OPEN", where=f"parts.{name}", parts=(name,), message=message, hint="Close the mesh.", stage="export")
            )
            continue
        files[f"{names.claim(name)}.3mf"] = _package(lying(mesh), escaped(name), part.color)
    if not files and not findings:
        raise ExportError(f"No part of {assembly.name!r} has a shape, so there is nothing to write as 3MF.")
    return Bundle(files, losses, Findings(findings))


def lying(mesh: TriMesh) -> TriMesh:
    """Return the mesh on the plane z = 0, on the largest flat face that can be at its bottom, else as it is."""
    best, largest = SE3.identity(), -1.0
    for down in _flat_directions(mesh):
        turned = _turned_down(down)
        z = turned.apply(mesh.vertices)[:, 2]
        on_bed = (z[mesh.triangles] < z.min() + SAME_PLANE_MM).all(axis=1)
        area = float(np.linalg.norm(mesh.normals_of_twice_area[on_bed], axis=1).sum())
        if area > largest * (1 + 1e-9):
            best, largest = turned, area
    placed = mesh.transformed(best)
    low, high = placed.bounds
    return placed.transformed(SE3.trans(-(low[0] + high[0]) / 2, -(low[1] + high[1]) / 2, -low[2]))


def _flat_directions(mesh: TriMesh) -> list[FloatArray]:
    """Return outward normals sorted by area, largest first; among equals, the original orientation comes first."""
    twice = mesh.normals_of_twice_area
    area = np.linalg.norm(twice, axis=1)
    largest = np.argsort(-area, kind="stable")[:MOST_TRIANGLES]
    largest = largest[area[largest] > 0]
    normals = twice[largest] / area[largest, None]
    directions, place = [np.array((0.0, 0.0, -1.0))], np.zeros(len(largest), dtype=int)
    left = np.arange(len(largest))
    while True:  # the first triangle without a direction states the next one
        alike = ((normals[left] - directions[-1]) ** 2).sum(axis=1) < SAME_DIRECTION**2
        place[left[alike]] = len(directions) - 1
        left = left[~alike]
        if not len(left):
            break
        directions.append(normals[left[0]])
    total = np.bincount(place, weights=area[largest], minlength=len(directions))
    return [directions[index] for index in np.argsort(-total, kind="stable")[:CANDIDATES]]


def _turned_down(normal: FloatArray) -> SE3:
    """Return the smallest rotation that maps a direction to −z."""
    axis = np.cross(normal, [0.0, 0.0, -1.0])
    sine = float(np.linalg.norm(axis))
    if sine < SAME_DIRECTION:
        return SE3.identity() if normal[2] < 0 else SE3.rot_x(np.pi)
    return SE3.from_axis_angle(axis / sine, np.arctan2(sine, -normal[2]))


def _package(mesh: TriMesh, name: str, color: str) -> bytes:
    """Return a 3MF package with one object."""
    root = etree.Element(f"{{{_CORE}}}model", {"unit": "millimeter"}, nsmap={None: _CORE})
    tag = f"{{{_CORE}}}"
    resources = child(root, f"{tag}resources")
    base = child(resources, f"{tag}basematerials", {"id": "1"})
    child(base, f"{tag}base", {"name": color, "displaycolor": color.upper()})
    body = child(resources, f"{tag}object", {"id": "2", "type": "model", "name": name, "pid": "1", "pindex": "0"})
    shape = child(body, f"{tag}mesh")
    child(shape, f"{tag}vertices")
    child(shape, f"{tag}triangles")
    child(child(root, f"{tag}build"), f"{tag}item", {"objectid": "2"})
    model = _filled(document(root), "vertices", '<vertex x="%s" y="%s" z="%s"/>', texts(mesh.vertices.ravel().tolist()))
    model = _filled(model, "triangles", '<triangle v1="%d" v2="%d" v3="%d"/>', mesh.triangles.ravel().tolist())
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED, compresslevel=6) as package:
        for path, content in (("[Content_Types].xml", _CONTENT_TYPES), ("_rels/.rels", _RELATIONS), ("3D/3dmodel.model", model)):
            entry = zipfile.ZipInfo(path, _TIME)
            entry.compress_type = zipfile.ZIP_DEFLATED
            package.writestr(entry, content)
    return stream.getvalue()


def _filled(content: bytes, tag: str, row: str, values: Sequence[object]) -> bytes:
    """Return a document with rows of three values in its only element of a tag, which is empty; lxml would need ten times as long.

    Args:
        content: The document.
        tag: Of the element.
        row: A row with three fields for values.
        values: Of all rows; their texts have no characters to escape.
    """
    before, _, after = content.partition(f"<{tag}/>".encode())
    indent = before[before.rindex(b"\n") :].decode()
    rows = f"{indent}  {row}" * (len(values) // 3) % tuple(values)
    return b"".join((before, f"<{tag}>{rows}{indent}</{tag}>".encode(), after))


def _clearances(assembly: Assembly, process: Process) -> list[Finding]:
    """Return a finding for each joint of two parts that may be printed, whose declared gap is smaller than the process needs."""
    needed = CLEARANCE_MM[process]
    findings = []
    for joint in assembly.joints:
        fit = assembly.fits.get(joint.name)
        if joint.type is JointType.FIXED or fit is None or fit.gap_min is None or fit.gap_min >= needed:
            continue
        if not all(_may_be_printed(assembly.parts[name]) for name in (joint.parent, joint.child)):
            continue
        findings.append(
            Finding(
                code="W_PRINT_CLEARANCE",
                where=f"joints.{joint.name}",
                parts=(joint.parent, joint.child),
                value=fit.gap_min,
                limit=needed,
                unit="mm",
                message=f"Joint {joint.name!r} requires a gap of {fit.gap_min:.6g} mm; {process.upper()} needs {needed:.6g} mm to print the parts apart.",
                hint="Widen the gap, print the parts separately and finish them, or use another process.",
            )
        )
    return findings


def _may_be_printed(part: Part) -> bool:
    """Return whether a part is as light as plastic, or has no known mass."""
    solid, mass = part.solid, part.mass
    return solid is None or mass is None or mass.mass <= LIGHT * 1e-9 * solid.volume


def _features(assembly: Assembly) -> list[Feature]:
    features = motion_and_mass(assembly)
    for name, part in assembly.parts.items():
        if body_mesh(part) is None:
            features.append(Feature("shape.missing", f"parts.{name}"))
    return features
