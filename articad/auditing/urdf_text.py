"""URDF as its text states it: every link, joint and number, with its line, and findings about what cannot be read."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from articad.auditing.declared import Declared, DeclaredInertial, DeclaredJoint, DeclaredLink, DeclaredShape, Role
from articad.auditing.mesh_references import MeshReferences
from articad.connectors.se3 import SE3
from articad.errors import InvalidSolidError
from articad.findings import Finding
from articad.geometry.mesh import TriMesh
from articad.geometry.shapes import box, cylinder, sphere
from articad.importers.reading import MM_PER_M

_AXES = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
_LARGEST = 1e12  # m, kg, N: beyond it arithmetic on poses loses all precision


@dataclass
class UrdfText:
    """Reads one document.

    Attributes:
        references: Finds its meshes.
        findings: Findings about invalid numbers.
    """

    references: MeshReferences
    findings: list[Finding] = field(default_factory=list)

    def declared(self, document: Any, path: Path) -> Declared:
        """Return what the document declares."""
        links = tuple(self._link(element) for element in document.iterfind("link"))
        joints = tuple(self._joint(element) for element in document.iterfind("joint"))
        return Declared("urdf", document.get("name") or path.stem, links, joints)

    # ------------------------------------------------------------------ links

    def _link(self, element: Any) -> DeclaredLink:
        name, where = element.get("name") or "", place(element)
        shapes = [shape for role in ("visual", "collision") for row in element.iterfind(role) if (shape := self._shape(row, role))]
        return DeclaredLink(name, where, self._inertial(element.find("inertial")), tuple(shapes))

    def _inertial(self, element: Any) -> DeclaredInertial | None:
        if element is None:
            return None
        T = self._pose(element.find("origin"))
        mass, moments = element.find("mass"), element.find("inertia")
        inertia = None
        if moments is not None:
            xx, xy, xz, yy, yz, zz = (self._number(moments, axis, 0.0) or 0.0 for axis in _AXES)
            R = T.rotation
            inertia = R @ np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ R.T * MM_PER_M**2
        return DeclaredInertial(None if mass is None else self._number(mass, "value"), T.translation, inertia)

    def _shape(self, element: Any, role: Role | str) -> DeclaredShape | None:
        geometry = element.find("geometry")
        if geometry is None or not len(geometry):
            return None
        form = geometry[0]
        T, where = self._pose(element.find("origin")), place(element)
        role = "visual" if role == "visual" else "collision"
        if form.tag == "mesh":
            x, y, z = (self._numbers(form, "scale", (1.0, 1.0, 1.0)) * 3)[:3]
            name = form.get("filename") or ""
            mesh, problem, reason = self.references.mesh(name, (x * MM_PER_M, y * MM_PER_M, z * MM_PER_M))
            return DeclaredShape(role, "mesh", where, None if mesh is None else mesh.transformed(T), name, (x, y, z), problem, reason)
        try:
            mesh = self._primitive(form)
        except InvalidSolidError as error:
            return DeclaredShape(role, form.tag, where, problem="unreadable", reason=error.message)
        return DeclaredShape(role, form.tag, where, None if mesh is None else mesh.transformed(T))

    def _primitive(self, form: Any) -> TriMesh | None:
        if form.tag == "box":
            sizes = self._numbers(form, "size", ())
            return box(*(size * MM_PER_M for size in sizes)) if len(sizes) == 3 else None
        radius = (self._number(form, "radius") or 0.0) * MM_PER_M
        if form.tag == "sphere":
            return sphere(radius)
        if form.tag == "cylinder":
            return cylinder(radius, (self._number(form, "length") or 0.0) * MM_PER_M)
        return None

    # ------------------------------------------------------------------ joints

    def _joint(self, element: Any) -> DeclaredJoint:
        kind, name = element.get("type") or "", element.get("name") or ""
        slides = kind == "prismatic"
        unit = MM_PER_M if slides else 1.0
        limit, mimic = element.find("limit"), element.find("mimic")
        lower, upper, effort, velocity = (None if limit is None else self._number(limit, key) for key in _LIMIT)
        ends = [end.get("link") or "" if (end := element.find(side)) is not None else "" for side in ("parent", "child")]
        return DeclaredJoint(
            name,
            place(element),
            kind,
            ends[0],
            ends[1],
            self._pose(element.find("origin")),
            None if lower is None else lower * unit,
            None if upper is None else upper * unit,
            effort,
            None if velocity is None else velocity * unit,
            None if mimic is None else mimic.get("joint") or "",
        )

    # ------------------------------------------------------------------ numbers

    def _pose(self, element: Any) -> SE3:
        if element is None:
            return SE3.identity()
        xyz, rpy = (self._numbers(element, key, (0.0, 0.0, 0.0)) for key in ("xyz", "rpy"))
        if len(xyz) != 3 or len(rpy) != 3:
            return SE3.identity()
        roll, pitch, yaw = rpy
        return SE3.trans(*(x * MM_PER_M for x in xyz)) @ SE3.rot_z(yaw) @ SE3.rot_y(pitch) @ SE3.rot_x(roll)

    def _number(self, element: Any, key: str, default: float | None = None) -> float | None:
        found = self._numbers(element, key, () if default is None else (default,))
        return found[0] if len(found) == 1 else default

    def _numbers(self, element: Any, key: str, default: tuple[float, ...]) -> tuple[float, ...]:
        """Return an attribute's numbers; an invalid one is a finding, and the default is used."""
        text = element.get(key)
        if text is None:
            return default
        try:
            numbers = tuple(float(word) for word in (text.replace(",", " ") if key in {"size", "scale"} else text).split())
        except ValueError:
            self._unreadable(element, key, text, "is not a number; expand xacro first" if "$" in text else "is not a number")
            return default
        if key in _COUNTS and len(numbers) not in _COUNTS[key]:
            self._unreadable(element, key, text, f"has {len(numbers)} numbers, not {_COUNTS[key][-1]}")
            return default
        if any(math.isnan(number) or (abs(number) > _LARGEST and element.tag != "limit") for number in numbers):
            self._unreadable(element, key, text, "is not a finite number")
            return default
        return numbers

    def _unreadable(self, element: Any, key: str, text: str, why: str) -> None:
        where = place(element)
        message = f"{element.tag} {key}={text[:60]!r} {why}."
        self.findings.append(Finding(code="E_AUDIT_NUMBER", where=where, message=message, hint="Give plain decimal numbers."))


_LIMIT = ("lower", "upper", "effort", "velocity")
_COUNTS = {"xyz": (3,), "rpy": (3,), "size": (3,), "scale": (1, 3), "value": (1,), "radius": (1,), "length": (1,)}


def place(element: Any) -> str:
    """Return the place of an element: its nearest named ancestor, and the line."""
    named = element
    while named is not None and named.get("name") is None:
        named = named.getparent()
    name = "" if named is None or named.tag == "robot" else f"{named.tag}s.{named.get('name')}"
    return f"{name or element.tag} (line {element.sourceline})"
