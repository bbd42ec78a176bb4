"""Makes a plan folder from a file that articad did not write: connectors and joints in `plan.json`, shapes as scripts and meshes.

Boxes, cylinders, spheres and capsules become scripts with their sizes as dimensions. A mesh becomes a script with few facets, and is
kept beside it as an STL file for whoever models the part again. Parts without shape that are fixed to another become part of it. With a
kernel, each part is built, and a part that the kernel refuses is approximated more coarsely until it builds (`articad.runs.facets`), so
that the folder builds at once.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from articad.aliases import Json, Progress
from articad.assembly import Assembly
from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.errors import ContractError, KernelError, PlanError, ReadError
from articad.export.bundle import Bundle
from articad.export.losses import losses_of
from articad.export.plan import plan_of
from articad.findings import Finding, Findings
from articad.formats import read
from articad.geometry.mesh import TriMesh, merged
from articad.geometry.mesh_files import write_stl
from articad.geometry.part import Part, Primitive, Shape
from articad.geometry.shapes import box, capsule, cylinder, sphere
from articad.kernels.cache import BuildCache
from articad.kernels.kernel import PartKernel
from articad.kinematics.joints import Joint, JointType
from articad.kinematics.mechanism import Mechanism
from articad.plan.schema import PLAN_FILE, AssemblyPlan
from articad.runs.facets import LEVELS, ROUNDING_MM, one_solid

SAME_VOLUME: Final = 1e-3  # largest difference, as a share of the volume, between a solid of few facets and its mesh without a finding
PLACEHOLDER_MM: Final = 1.0  # radius of the ball that replaces a missing shape

_POLYHEDRON: Final = """

def _polyhedron(corners, triangles):
    return Solid(Shell([Face(Wire.make_polygon([corners[i] for i in triangle])) for triangle in triangles]))
"""


def adopt(
    source: str | Path,
    *,
    root: str | Path | None = None,
    fuse: bool = False,
    kernel: PartKernel | None = None,
    cache: BuildCache | None = None,
    progress: Progress | None = None,
) -> tuple[Assembly, Bundle]:
    """Make a plan folder from a URDF, MJCF, FreeCAD or STEP file; nothing is written yet.

    Args:
        source: The file.
        root: Folder that meshes may be read from; the file's own by default.
        fuse: Replace chains of joints over bare links by the one joint that they represent; see `articad.formats.read`.
        kernel: Builds every part, to verify that the folder builds; without one nothing is built.
        cache: Stores what is built; by default `$ARTICAD_CACHE` or `~/.cache/articad`.
        progress: Called with the outcome of each part.

    Returns:
        The assembly that the plan describes, and `plan.json`, `parts/*.py`, `meshes/*.stl`, with findings about what could not be
        converted.

    Raises:
        ReadError: If the file cannot be read, or is already a plan.
        UnrepresentableError: If a plan cannot express the rest pose of a loop.
    """
    path = Path(source)
    if path.suffix.lower() == ".json":
        raise ReadError(f"{path} is a plan already.", path=str(path))
    assembly, findings = _without_frames(read(path, root=root, fuse=fuse))
    plan, features = plan_of(assembly)
    document: Json = json.loads(plan.dumps())
    parts = {form["name"]: part for form, part in zip(document["parts"], assembly.parts.values(), strict=True)}
    drafts = {name: _Writer(part, name, path.name).draft() for name, part in parts.items()}
    if kernel is not None:
        drafts, refused = _built(document, parts, drafts, path.name, kernel, cache, progress)
        findings += refused
    meshes = {
        f"meshes/{name}.stl": write_stl(merged([shape.placed for shape in shapes]))
        for name, part in parts.items()
        if (shapes := _shapes(part))
    }
    findings += [finding for draft in drafts.values() for finding in draft.findings]
    findings += _missing_fits(assembly)
    scripts = {f"parts/{name}.py": draft.script.encode() for name, draft in drafts.items()}
    files = {PLAN_FILE: _plan_with(document, drafts).dumps().encode(), **scripts, **meshes}
    losses = tuple(loss for loss in losses_of("plan", features) if loss.where != "parts")  # the shapes are in the scripts
    return assembly, Bundle(files, losses, assembly.findings + Findings(findings))


def _plan_with(document: Json, drafts: Mapping[str, _Draft]) -> AssemblyPlan:
    """Return the plan with the drafts' descriptions of its parts."""
    forms = [form | drafts[form["name"]].form for form in document["parts"]]
    return AssemblyPlan.from_json(document | {"parts": forms})


def _built(
    document: Json,
    parts: Mapping[str, Part],
    drafts: dict[str, _Draft],
    source: str,
    kernel: PartKernel,
    cache: BuildCache | None,
    progress: Progress | None,
) -> tuple[dict[str, _Draft], list[Finding]]:
    """Build every part, and draft more coarsely what is refused; return the drafts and findings about what could not be built or tried."""
    for level in (*LEVELS, ""):
        plan = _plan_with(document, drafts)
        try:
            scripts = {name: draft.script for name, draft in drafts.items()}
            Assembly.from_plan(plan, scripts, kernel=kernel, cache=cache, progress=progress)
        except ContractError as error:
            refused = {finding.where.split(".")[1] for finding in error.findings if finding.where.startswith("parts.")} & drafts.keys()
            if not refused or not level:
                return drafts, list(error.findings)
            drafts = drafts | {name: _Writer(parts[name], name, source, level).draft() for name in refused}
        except (PlanError, KernelError) as error:
            message = f"The parts could not be tried out: {error.message}"
            return drafts, [
                Finding(code="W_ADOPT_UNTRIED", where="parts", message=message, hint="Build the folder to see whether they build.")
            ]
        else:
            return drafts, []
    return drafts, []


# ---------------------------------------------------------------------- parts without shape


def _without_frames(assembly: Assembly) -> tuple[Assembly, list[Finding]]:
    """Return the assembly in which parts without shape that are fixed to another part are merged into that one."""
    findings: list[Finding] = []
    while True:
        found = next(_frames(assembly), None)
        if found is None:
            return assembly, findings
        bare, kept, T_kept_bare, joint = found
        assembly = _merged(assembly, bare, kept, T_kept_bare, joint)
        message = f"{bare!r} has no shape and is fixed to {kept!r}; it was merged into {kept!r}."
        hint = "Give it a shape in the file to keep it apart."
        findings.append(Finding(code="I_ADOPT_MERGED", where=f"parts.{bare}", parts=(kept,), message=message, hint=hint))


def _frames(assembly: Assembly) -> Iterator[tuple[str, str, SE3, Joint]]:
    """Yield a part without shape, the part with shape to which it is fixed, its pose in that one's frame, and the joint between."""
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
    message = f"No fit is declared for {named}: the file does not state how much play a joint needs."
    return [Finding(code="I_ADOPT_FITS", where="joints", message=message, hint='Give each a "fit" with gap_mm and contact.')]


# ---------------------------------------------------------------------- scripts


def _shapes(part: Part) -> tuple[Shape, ...]:
    if part.solid is not None:
        return (Shape(part.solid.mesh),)
    return part.visuals or part.collisions


@dataclass
class _Draft:
    """The present draft of a part's script.

    Attributes:
        description: The description of the part's shape in the plan.
        envelope: Sides of its bounding box [mm].
        dimensions: By name [mm].
        script: Its source.
        findings: Differences from the file.
    """

    description: str
    envelope: list[float]
    dimensions: dict[str, float]
    script: str
    findings: list[Finding]

    @property
    def form(self) -> Json:
        """The plan's entries for the part."""
        return {"dimensions": self.dimensions, "description": self.description, "envelope_mm": self.envelope}


class _Writer:
    """Writes one part script: with the primitives of the part, or one solid of facets at a level of `articad.runs.facets`."""

    def __init__(self, part: Part, name: str, source: str, level: str | None = None) -> None:
        self.part, self.name, self.level = part, name, level
        self.source = re.sub(r"[^\w .-]", "_", source, flags=re.ASCII)  # part of the script's text
        self.dimensions: dict[str, float] = {}
        self.words: list[str] = []
        self.terms: list[str] = []
        self.data: list[str] = []
        self.used = {"Plane"}
        self.findings: list[Finding] = []
        self.counts: dict[str, int] = {}
        self.drawn: list[TriMesh] = []

    def draft(self) -> _Draft:
        meshes = [shape.placed for shape in _shapes(self.part) if self.level is not None or not self._primitive(shape)]
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
        """Add a box, cylinder, sphere or capsule, if the mesh is exactly one."""
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
        """Add a solid of few facets in place of meshes, and report by how much it differs."""
        whole, found = merged(meshes), one_solid(meshes, self.level or LEVELS[0])
        if found.mesh is None:
            return
        corners = ", ".join(f"({x}, {y}, {z})" for x, y, z in _rounded(found.mesh))
        triangles = ", ".join(f"({a}, {b}, {c})" for a, b, c in found.mesh.triangles.tolist())
        self.data.append(f"CORNERS = [{corners}]\nTRIANGLES = [{triangles}]\n")
        self.terms.append("_polyhedron(CORNERS, TRIANGLES)")
        self.drawn.append(found.mesh)
        self.used |= {"Face", "Shell", "Solid", "Wire"}
        facets = len(found.mesh.triangles)
        self.words.append(f"a solid of {facets} facets, from meshes/{self.name}.stl")
        more = found.mesh.volume / found.exact - 1 if found.exact > 0 else np.nan
        said = [f"its volume is {100 * more:+.2g} %" if found.exact > 0 else "the mesh is open, and its holes are closed"]
        said += [
            {"pieces": "convex pieces stand for it", "hull": "its hull stands for it", "box": "its box stands for it"}.get(found.level, "")
        ]
        said += [
            f"thin bars tie {found.bars} loose pieces to it" if found.bars else "",
            f"{found.crumbs} crumbs are left out" if found.crumbs else "",
        ]
        if not abs(more) <= SAME_VOLUME or any(said[1:]):
            message = f"A mesh of {len(whole.triangles)} triangles became a solid of {facets} facets; {', '.join(filter(None, said))}."
            self._warn("W_ADOPT_SHAPE", message, f"Draw it anew in parts/{self.name}.py, after meshes/{self.name}.stl.")

    def _placeholder(self) -> None:
        self.used |= {"Sphere"}
        self.drawn.append(sphere(PLACEHOLDER_MM))
        radius = self._size("placeholder", "radius", PLACEHOLDER_MM)
        self.terms.append(f"Sphere({radius})")
        self.words.append(f"a ball of {PLACEHOLDER_MM:g} mm as a placeholder, because the file gives it no shape")
        self._warn("W_ADOPT_PLACEHOLDER", "The file gives it no shape; a small ball represents it.", f"Draw it in parts/{self.name}.py.")

    def _warn(self, code: str, message: str, hint: str) -> None:
        self.findings.append(Finding(code=code, where=f"parts.{self.name}", parts=(self.name,), message=message, hint=hint))


def _stated(form: Primitive) -> tuple[str, dict[str, float]]:
    """Return what `recognised` would return for the primitive's mesh; scripts have no ellipsoid."""
    names = {"box": "xyz", "cylinder": ("radius", "height"), "sphere": ("radius",), "capsule": ("radius", "length")}.get(form.kind)
    return ("", {}) if names is None else (form.kind, dict(zip(names, form.size, strict=True)))


def recognised(mesh: TriMesh) -> tuple[str, dict[str, float]]:
    """Return the primitive that a mesh is, in the importers' triangulation, and its sizes [mm]; "" for none."""
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


def _rounded(mesh: TriMesh) -> list[list[float]]:
    return [[round(number, ROUNDING_MM) + 0.0 for number in corner] for corner in mesh.vertices.tolist()]


def _plane(T: SE3) -> str:
    """Return a frame in build123d's notation."""
    o, x, z = (tuple(float(number) + 0.0 for number in vector) for vector in (T.translation, T.x_axis, T.z_axis))
    return f"Plane(origin={o}, x_dir={x}, z_dir={z})"
