"""STEP assemblies: no joints and no masses, but parts with names and poses; whether they are solids, overlap, or float."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from articad.auditing.declared import Declared, DeclaredLink, DeclaredShape
from articad.auditing.wording import counted, listed
from articad.connectors.se3 import SE3
from articad.findings import Finding
from articad.interference.check import check_pose
from articad.kernels.step_assembly import StepPart, StepReader

DEFLECTION_MM = 0.05  # finer than the tolerances of overlap need, and fast for files of hundreds of parts
PLAIN_NAMES = ("", "solid", "part", "compound", "open cascade", "assembly", "shape", "body", "product", "none", "unnamed")


def audit_step(path: Path) -> tuple[Declared, list[Finding], list[str]]:
    """Return the declarations of a STEP file, the findings about it, and what was not checked.

    Raises:
        ReadError: If it is not a STEP file.
    """
    parts = StepReader().read_assembly(path, deflection=DEFLECTION_MM)
    links = tuple(DeclaredLink(part.name, part.where, None, (DeclaredShape("visual", "mesh", part.where, part.mesh),)) for part in parts)
    declared = Declared("step", path.stem, links, (), states_inertia=False, states_collision=False)
    meshes = {part.name: part.mesh for part in parts if part.valid and part.mesh is not None and not part.gaps}
    findings = [*_not_solid(parts), *_unmeshed(parts), *_unnamed(parts)]
    if len(meshes) > 1:
        poses = dict.fromkeys(meshes, SE3.identity())
        largest = max(meshes, key=lambda name: float(np.ptp(meshes[name].bounds, axis=0).prod()))
        findings += check_pose(meshes, poses, joints=(), deflection=DEFLECTION_MM, ground=largest).findings
    return declared, findings, ["motion: STEP holds no joints"]


def _unmeshed(parts: Sequence[StepPart]) -> Iterator[Finding]:
    """Yield what is not checked of solids whose meshes have gaps."""
    found = [part for part in parts if part.gaps]
    if found:
        gaps = ", ".join(f"{part.name} {part.gaps}" for part in found)
        names = [part.name for part in found]
        yield Finding(
            code="W_AUDIT_NOT_CHECKED",
            where="parts",
            parts=tuple(names),
            message=f"Overlap and contact of {listed(names)} are not checked: the kernel's meshes of these solids are not closed (open edges: {gaps}).",
            hint="Rebuild them in CAD without surfaces that touch along a line.",
            value=len(found),
            limit=0,
        )


def _not_solid(parts: tuple[StepPart, ...]) -> Iterator[Finding]:
    for part in parts:
        if part.valid:
            continue
        yield Finding(
            code="E_AUDIT_NOT_SOLID",
            where=part.where,
            parts=(part.name,),
            message=f"{part.name} is {'a surface, not a solid' if part.loose else 'a solid that the kernel reports as invalid'}.",
            hint="Repair it in CAD: sew its faces, and check the geometry.",
            value=part.faces if part.loose else 0,
            limit=0 if part.loose else 1,
        )


def _unnamed(parts: tuple[StepPart, ...]) -> Iterator[Finding]:
    bad = [part.name for part in parts if part.product.strip().lower().rstrip("0123456789_ -.:") in PLAIN_NAMES]
    if bad and len(parts) > 1:
        yield Finding(
            code="W_AUDIT_UNNAMED",
            where="products",
            parts=tuple(bad),
            message=f"{len(bad)} of {counted(len(parts), 'part')} have no name: {listed(bad)}.",
            hint="Name the products in CAD before you export them.",
            value=len(bad),
            limit=0,
        )
