"""Reads STEP: a part for each solid, at its pose. STEP has no joints, so all parts are fixed to the largest one."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from articad.assembly import Assembly
from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.findings import Finding, Findings
from articad.geometry.part import Part, Shape, Solid
from articad.importers.reading import unreadable
from articad.kernels.step_assembly import StepPart, StepReader
from articad.kinematics.joints import Joint, JointLimits, JointType
from articad.kinematics.mechanism import Mechanism

IDENTITY = SE3.identity()
ORIGIN = "origin"  # the connector of each part that holds it to the largest


def read_step(path: str | Path, *, root: str | Path | None = None, deflection: float = 0.05) -> Assembly:
    """Read the solids of a STEP file.

    Args:
        path: The file.
        root: Unused: a STEP file names no other files.
        deflection: Largest distance of the meshes from the surfaces [mm].

    Raises:
        ReadError: If it is not a STEP file, or contains no solid.
    """
    del root
    path = Path(path)
    read = StepReader().read_assembly(path, deflection=deflection)
    parts = {part.name: _part(part, deflection) for part in read if part.valid and part.mesh is not None}
    if not parts:
        raise unreadable(path, "", "It contains no valid solid.")
    findings = [
        Finding(
            code="W_IMPORT_DROPPED",
            where=part.where,
            message=f"{part.name} is not a valid solid; it is left out.",
            hint="Repair it in CAD.",
        )
        for part in read
        if part.name not in parts
    ]
    findings += [
        Finding(
            code="W_IMPORT_DROPPED",
            where=part.where,
            message=f"{part.name} is a solid, but the kernel's mesh of it has {part.gaps} open edges; it is read as a surface, "
            "without volume and mass.",
            hint="Rebuild it in CAD without surfaces that touch along a line, or read it with another deflection.",
        )
        for part in read
        if part.gaps
    ]
    ground = max(parts, key=lambda name: _size(parts[name]))
    joints = [_fixed(ground, name) for name in parts if name != ground]
    return Assembly(path.stem, Mechanism(tuple(parts), ground, joints), parts, findings=Findings(findings), foreign=True)


def _part(part: StepPart, deflection: float) -> Part:
    assert part.mesh is not None
    connectors = {ORIGIN: Connector(ORIGIN, IDENTITY)}
    if part.mesh.is_closed and part.mesh.volume > 0:
        return Part.from_solid(part.name, Solid.from_mesh(part.mesh, deflection=deflection), connectors=connectors)
    return Part(part.name, connectors, (Shape(part.mesh),), ())


def _size(part: Part) -> float:
    return 0.0 if part.mesh is None else float(np.ptp(part.mesh.bounds, axis=0).prod())


def _fixed(ground: str, name: str) -> Joint:
    return Joint(
        name=f"{name}_fixed",
        type=JointType.FIXED,
        parent=ground,
        child=name,
        parent_connector=ORIGIN,
        child_connector=ORIGIN,
        T_parent_connector=IDENTITY,
        T_child_connector=IDENTITY,
        limits=JointLimits((), ()),
        rest=(),
    )
