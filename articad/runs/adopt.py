"""A plan folder of a file that somebody else made: connectors, joints and limits in `plan.json`, shapes as scripts and as meshes.

Boxes, cylinders, spheres and capsules become scripts with their sizes as dimensions; a mesh becomes a script with few facets, and stays beside
it as an STL file for whoever draws the part anew. Parts without shape that are fixed to another become part of it.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from articad.assembly import Assembly
from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.errors import ReadError
from articad.export.bundle import Bundle
from articad.export.convex import hull_mesh, manifold
from articad.export.losses import losses_of
from articad.export.plan import plan_of
from articad.findings import Finding, Findings
from articad.formats import read
from articad.geometry.mesh import TriMesh, merged
from articad.geometry.mesh_files import write_stl
from articad.geometry.part import Part, Primitive, Shape
from articad.geometry.shapes import box, capsule, cylinder, sphere
from articad.kinematics.joints import Joint, JointType
from articad.kinematics.mechanism import Mechanism
from articad.plan.schema import PLAN_FILE, AssemblyPlan

FloatArray = NDArray[np.float64]
Json = dict[str, Any]

MOST_FACETS: Final = 400  # of a part: the CAD kernel sews so many in a second
SAME_VOLUME: Final = 1e-3  # share by which a solid of few facets may differ from its mesh without a word
ROUNDING_MM: Final = 6  # digits of a facet's corners: a millionth of a millimetre
PLACEHOLDER_MM: Final = 1.0  # radius of the ball that stands for a shape that is not there

_POLYHEDRON: Final = """

def _polyhedron(corners, triangles):
    return Solid(Shell([Face(Wire.make_polygon([corners[i] for i in triangle])) for triangle in triangles]))
"""


def adopt(source: str | Path, *, root: str | Path | None = None, fuse: bool = False) -> tuple[Assembly, Bundle]:
    """Make a plan folder of a URDF, MJCF, FreeCAD or STEP file; nothing is written yet.

    Args:
        source: The file.
        root: Folder that meshes may be read from; the file's own by default.
        fuse: Make chains of joints over bare links the one joint that they stand for; see `articad.formats.read`.

    Returns:
        The assembly that the plan tells, and `plan.json`, `parts/*.py`, `meshes/*.stl`, with what could not be taken over.

    Raises:
        ReadError: If the file cannot be read, or is a plan already.
        UnrepresentableError: If a loop rests where a plan cannot let it rest.
    """
    path = Path(source)
    if path.suffix.lower() == ".json":
        raise ReadError(f"{path} is a plan already.", path=str(path))
    assembly, findings = _without_frames(read(path, root=root, fuse=fuse))
    plan, features = plan_of(assembly)
    document: Json = json.loads(plan.dumps())
    scripts: dict[str, bytes] = {}
    meshes: dict[str, bytes] = {}
    for form, part in zip(document["parts"], assembly.parts.values(), strict=True):
        draft = _drafted(part, form["name"], path.name)
        form |= {"dimensions": draft.dimensions, "description": draft.description, "envelope_mm": draft.envelope}
        scripts[f"parts/{form['name']}.py"] = draft.script.encode()
        findings += draft.findings
        shapes = _shapes(part)
        if shapes:
            meshes[f"meshes/{form['name']}.stl"] = write_stl(merged([shape.placed for shape in shapes]))
    findings += _missing_fits(assembly)
    files = {PLAN_FILE: AssemblyPlan.from_json(document).dumps().encode(), **scripts, **meshes}
    losses = tuple(loss for loss in losses_of("plan", features) if loss.where != "parts")  # the shapes are in the scripts
    return assembly, Bundle(files, losses, assembly.findings + Findings(findings))


# ---------------------------------------------------------------------- parts without shape


def _without_frames(assembly: Assembly) -> tuple[Assembly, list[Finding]]:
    """Return the assembly in which parts without shape, fixed to another part, are part of that one."""
    findings: list[Finding] = []
    while True:
        found = next(_frames(assembly), None)
        if found is None:
            return assembly, findings
        bare, kept, T_kept_bare, joint = found
        assembly = _merged(assembly, bare, kept, T_kept_bare, joint)
        message = f"{bare!r} has no shape and is fixed to {kept!r}; it is part of it now."
        hint = "Give it a shape in the file to keep it apart."
        findings.append(Finding(code="I_ADOPT_MERGED", where=f"parts.{bare}", parts=(kept,), message=message, hint=hint))


def _frames(assembly: Assembly) -> Iterator[tuple[str, str, SE3, Joint]]:
    """Yield a part without shape, the part with shape that it is fixed to, its place in that one's frame, and the joint between."""
    bare = {name for name, part in assembly.parts.items() if not _shapes(part)}
    closing = {joint.name for joint in assembly.mechanism.loop_joints}
    rest = assembly.at()
    for joint in assembly.joints:
        if joint.type is not JointType.FIXED or joint.name in closing:
            continue
        for one, other in ((joint.parent, joint.child), (joint.child, joint.parent)):
            if one in bare and other not in bare:
                yield one, other, rest[other].inverse() @ rest[one], joint


def _merged(assembly: Assembly, bare: str, kept: str, T: SE3, between: Joint) -> Assembly:
    host = assembly.parts[kept]
    names = _free_names(host.connectors, [f"{bare}_{name}" for name in assembly.parts[bare].connectors])
    renamed = dict(zip(assembly.parts[bare].connectors, names, strict=True))
    moved = {
        renamed[name]: Connector(renamed[name], T @ one.frame, one.label, one.kind) for name, one in assembly.parts[bare].connectors.items()
    }
    parts = {name: part for name, part in assembly.parts.items() if name != bare}
    parts[kept] = replace(host, connectors={**host.connectors, **moved})

    def held(joint: Joint) -> Joint:
        if joint.parent == bare:
            frame = T @ joint.T_parent_connector
            joint = replace(joint, parent=kept, parent_connector=renamed[joint.parent_connector], T_parent_connector=frame)
        if joint.child == bare:
            frame = T @ joint.T_child_connector
            joint = replace(joint, child=kept, child_connector=renamed[joint.child_connector], T_child_connector=frame)
        return joint

    joints = [held(joint) for joint in assembly.joints if joint is not between]
    mechanism, moves = assembly.mechanism, assembly.ground == bare
    T_ground = mechanism.T_ground @ T.inverse() if moves else mechanism.T_ground
    ground = kept if moves else mechanism.ground
    made = Mechanism(tuple(parts), ground, joints, mechanism.couplings, T_ground=T_ground)
    return replace(assembly, mechanism=made, parts=parts)


def _free_names(taken: Any, wanted: list[str]) -> list[str]:
    names: list[str] = []
    for name in wanted:
        free = name
        while free in taken or free in names:
            free += "_"
        names.append(free)
    return names


def _missing_fits(assembly: Assembly) -> list[Finding]:
    without = [joint.name for joint in assembly.joints if joint.type is not JointType.FIXED and joint.name not in assembly.fits]
    if not without:
        return []
    named = ", ".join(without[:10]) + (f" and {len(without) - 10} more" if len(without) > 10 else "")
    message = f"No fit is declared for {named}: no file says how much play a joint needs."
    return [Finding(code="I_ADOPT_FITS", where="joints", message=message, hint='Give each a "fit" with gap_mm and contact.')]


# ---------------------------------------------------------------------- scripts


def _shapes(part: Part) -> tuple[Shape, ...]:
    if part.solid is not None:
        return (Shape(part.solid.mesh),)
    return part.visuals or part.collisions


@dataclass
class _Draft:
    """A part's script as far as it is written.

    Attributes:
        description: What the plan says of the part's shape.
        envelope: Sides of its bounding box [mm].
        dimensions: By name [mm].
        script: Its source.
        findings: What is not as the file has it.
    """

    description: str
    envelope: list[float]
    dimensions: dict[str, float]
    script: str
    findings: list[Finding]


def _drafted(part: Part, name: str, source: str) -> _Draft:
    writer = _Writer(part, name, source)
    return writer.draft()


class _Writer:
    """Writes one part script."""

    def __init__(self, part: Part, name: str, source: str) -> None:
        self.part, self.name = part, name
        self.source = re.sub(r"[^\w .-]", "_", source, flags=re.ASCII)  # it stands in a script
        self.dimensions: dict[str, float] = {}
        self.words: list[str] = []
        self.terms: list[str] = []
        self.data: list[str] = []
        self.used = {"Plane"}
        self.findings: list[Finding] = []
        self.counts: dict[str, int] = {}
        self.drawn: list[TriMesh] = []

    def draft(self) -> _Draft:
        meshes = [shape.placed for shape in _shapes(self.part) if not self._primitive(shape)]
        if meshes:
            self._facets(meshes)
        if not self.terms:
            self._placeholder()
        sums = "\n".join(f"    {'shape =' if index == 0 else 'shape +='} {term}" for index, term in enumerate(self.terms))
        reads = "    d = part.dimensions\n" if self.dimensions else ""
        helper = _POLYHEDRON if self.data else ""
        if not any("Plane(" in term for term in self.terms):
            self.used.discard("Plane")
        script = (
            f'"""{self.name}, adopted from {self.source}."""\n\n'
            f"from build123d import {', '.join(sorted(self.used))}\n\n{''.join(self.data)}{helper}\n\n"
            f"def build(part):\n{reads}{sums}\n"
            '    return shape, {name: {"o": one.o, "z": one.z, "x": one.x} for name, one in part.connectors.items()}\n'
        ).replace("\n\n\n\n", "\n\n\n")
        return _Draft(f"Adopted from {self.source}: {'; '.join(self.words)}.", self._envelope(), self.dimensions, script, self.findings)

    def _envelope(self) -> list[float]:
        low, high = (np.array([mesh.bounds[end] for mesh in self.drawn]) for end in (0, 1))
        return [float(side) for side in high.max(axis=0) - low.min(axis=0)]

    def _size(self, base: str, key: str, value: float) -> str:
        self.dimensions[f"{base}_{key}"] = value
        return f'd["{base}_{key}"]'

    def _primitive(self, shape: Shape) -> bool:
        """Add a box, cylinder, sphere or capsule, if the mesh is exactly that of one."""
        kind, sizes = recognised(shape.mesh) if shape.primitive is None else _stated(shape.primitive)
        if not kind:
            return False
        self.counts[kind] = self.counts.get(kind, 0) + 1
        base = kind if self.counts[kind] == 1 else f"{kind}_{self.counts[kind]}"
        self.drawn.append(shape.placed)
        names = [self._size(base, key, value) for key, value in sizes.items()]
        made = {
            "box": lambda: f"Box({', '.join(names)})",
            "cylinder": lambda: f"Cylinder({', '.join(names)})",
            "sphere": lambda: f"Sphere({names[0]})",
            "capsule": lambda: (
                f"(Cylinder({', '.join(names)}) + Pos(0, 0, {names[1]} / 2) * Sphere({names[0]})"
                f" + Pos(0, 0, -{names[1]} / 2) * Sphere({names[0]}))"
            ),
        }[kind]()
        self.used |= {"Cylinder", "Sphere", "Pos"} if kind == "capsule" else {kind.capitalize()}
        self.terms.append(f"{_plane(shape.frame)} * {made}")
        self.words.append(f"{kind} {' x '.join(f'{value:.6g}' for value in sizes.values())} mm")
        return True

    def _facets(self, meshes: list[TriMesh]) -> None:
        """Add solids of few facets in the place of meshes, and say by how much they differ."""
        whole = merged(meshes)
        bodies, exact = few_facets(meshes)
        if not bodies:
            return
        for body in bodies:
            number = len(self.data) + 1
            corners = ", ".join(f"({x}, {y}, {z})" for x, y, z in _rounded(body))
            triangles = ", ".join(f"({a}, {b}, {c})" for a, b, c in body.triangles.tolist())
            self.data.append(f"CORNERS_{number} = [{corners}]\nTRIANGLES_{number} = [{triangles}]\n")
            self.terms.append(f"_polyhedron(CORNERS_{number}, TRIANGLES_{number})")
        self.drawn += bodies
        self.used |= {"Face", "Shell", "Solid", "Wire"}
        facets, volume = sum(len(body.triangles) for body in bodies), sum(body.volume for body in bodies)
        self.words.append(f"a solid of {facets} facets, from meshes/{self.name}.stl")
        more = volume / exact - 1 if exact > 0 else np.nan
        if not abs(more) <= SAME_VOLUME:
            by = f"its volume is {100 * more:+.2g} %" if exact > 0 else "the mesh is open, so this is its hull"
            message = f"A mesh of {len(whole.triangles)} triangles became a solid of {facets} facets; {by}."
            self._warn("W_ADOPT_SHAPE", message, f"Draw it anew in parts/{self.name}.py, after meshes/{self.name}.stl.")

    def _placeholder(self) -> None:
        self.used |= {"Sphere"}
        self.drawn.append(sphere(PLACEHOLDER_MM))
        radius = self._size("placeholder", "radius", PLACEHOLDER_MM)
        self.terms.append(f"Sphere({radius})")
        self.words.append(f"a ball of {PLACEHOLDER_MM:g} mm as a placeholder, since the file gives it no shape")
        self._warn("W_ADOPT_PLACEHOLDER", "The file gives it no shape; a small ball stands for it.", f"Draw it in parts/{self.name}.py.")

    def _warn(self, code: str, message: str, hint: str) -> None:
        self.findings.append(Finding(code=code, where=f"parts.{self.name}", parts=(self.name,), message=message, hint=hint))


def _stated(form: Primitive) -> tuple[str, dict[str, float]]:
    """Return what `recognised` would of the primitive's mesh; an ellipsoid has no word in a script."""
    names = {"box": "xyz", "cylinder": ("radius", "height"), "sphere": ("radius",), "capsule": ("radius", "length")}.get(form.kind)
    return ("", {}) if names is None else (form.kind, dict(zip(names, form.size, strict=True)))


def recognised(mesh: TriMesh) -> tuple[str, dict[str, float]]:
    """Return what primitive a mesh is, as importers make it, and its sizes [mm]; "" for none."""
    x, y, z = (float(side) for side in mesh.bounds[1] - mesh.bounds[0])
    if min(x, y, z) <= 0:
        return "", {}
    if mesh.digest == box(x, y, z).digest:
        return "box", {"x": x, "y": y, "z": z}
    if mesh.digest == cylinder(x / 2, z).digest:
        return "cylinder", {"radius": x / 2, "height": z}
    if mesh.digest == sphere(z / 2).digest:
        return "sphere", {"radius": z / 2}
    length = z - x
    if length > 0 and mesh.vertices.shape == (whole := capsule(x / 2, length)).vertices.shape:
        same = np.array_equal(mesh.triangles, whole.triangles) and np.allclose(mesh.vertices, whole.vertices, rtol=0, atol=1e-9 * z)
        return ("capsule", {"radius": x / 2, "length": length}) if same else ("", {})
    return "", {}


def few_facets(meshes: list[TriMesh]) -> tuple[list[TriMesh], float]:
    """Return closed bodies of at most `MOST_FACETS` triangles together in the place of meshes, and the meshes' volume; 0 where one is open."""
    whole = [manifold(mesh) for mesh in meshes]
    closed = all(not body.is_empty() and body.volume() > 0 for body in whole)
    vertices = np.concatenate([mesh.vertices for mesh in meshes])
    solid = sum(whole[1:], start=whole[0]) if closed else manifold(hull_mesh(vertices))
    if solid.is_empty():
        return [], 0.0
    exact = float(solid.volume()) if closed else 0.0
    size = float(np.ptp(vertices, axis=0).max())
    coarse, tolerance = solid.simplify(1e-6 * size), 1e-4 * size
    while coarse.num_tri() > MOST_FACETS and tolerance < size / 4:
        coarse, tolerance = solid.simplify(tolerance), 1.2 * tolerance
    if coarse.num_tri() > MOST_FACETS or coarse.is_empty():
        coarse = manifold(hull_mesh(coarse.simplify(size / 50).to_mesh64().vert_properties[:, :3]))
    bodies = [body for body in coarse.decompose() if body.volume() > 0]
    bodies.sort(key=lambda body: (-body.volume(), tuple(body.bounding_box())))
    rows = [body.to_mesh64() for body in bodies]
    return [TriMesh(np.array(row.vert_properties[:, :3]), row.tri_verts.astype(np.int32)) for row in rows], exact


def _rounded(mesh: TriMesh) -> list[list[float]]:
    return [[round(number, ROUNDING_MM) + 0.0 for number in corner] for corner in mesh.vertices.tolist()]


def _plane(T: SE3) -> str:
    """Return a frame as build123d writes it."""
    o, x, z = (tuple(float(number) + 0.0 for number in vector) for vector in (T.translation, T.x_axis, T.z_axis))
    return f"Plane(origin={o}, x_dir={x}, z_dir={z})"
