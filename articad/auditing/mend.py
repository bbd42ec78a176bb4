"""Repairs what can be repaired without guessing, reports what was done, and lists the rest.

Inertias come from closed meshes and a stated density, collision shapes from visual ones, convex pieces from collision meshes on request,
endless axes from their span, names from their own letters, the base's position from the lowest point. Masses of links without shape,
limits, efforts and open meshes are not changed.
"""

from __future__ import annotations

import copy
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final, Literal

from lxml import etree

from articad.assembly import Assembly
from articad.auditing import limits, masses, shapes
from articad.auditing.contact import united
from articad.auditing.declared import Declared, DeclaredLink
from articad.auditing.examine import AuditOptions, audit_file
from articad.auditing.mesh_references import MeshReferences
from articad.auditing.names import MOST_CHARACTERS
from articad.auditing.report import Audit
from articad.auditing.urdf_text import UrdfText
from articad.auditing.wording import counted, listed
from articad.errors import ReadError
from articad.export.bundle import Bundle
from articad.export.convex import hull_mesh, pieces_of
from articad.export.markup import child, document, number, numbers, rpy, tidy
from articad.export.mjcf import STL_TRIANGLES
from articad.export.names import Names
from articad.export.urdf import write_urdf
from articad.files import differs, read_file
from articad.geometry.capping import GAP_SHARE, without_gaps
from articad.geometry.inscribed import Piece
from articad.geometry.mass import MassProperties
from articad.geometry.mesh import TriMesh
from articad.geometry.mesh_files import MAX_FILE_BYTES, write_obj, write_stl
from articad.importers.reading import MM_PER_M, Folder, read_xml
from articad.importers.referenced_files import package_of
from articad.kernels.cache import BuildCache

PIECE_FILE: Final = "pieces/{}.stl"
CONVEX_SHARE: Final = 1e-6  # of its volume: by which a convex mesh may be smaller than its hull
BAD_INERTIA = ("E_AUDIT_INERTIA", "E_AUDIT_INERTIA_TRIANGLE", "W_AUDIT_INERTIA_SHAPE", "W_AUDIT_COM")


@dataclass
class Mended:
    """What was done, and what remains.

    Attributes:
        file: The repaired file.
        done: What was done, in words.
        masses: Masses of links for which they were computed [kg].
        rest: Audit of the repaired file.
    """

    file: Path
    done: list[str] = field(default_factory=list)
    masses: dict[str, float] = field(default_factory=dict)
    rest: Audit | None = None

    def to_json(self) -> dict[str, Any]:
        """Return the part of a report."""
        return {
            "file": str(self.file),
            "done": self.done,
            "masses_kg": self.masses,
            "left": None if self.rest is None else self.rest.to_json(),
        }


def mend(
    path: str | Path,
    out: str | Path,
    *,
    density: float | None = None,
    collision: Literal["pieces"] | None = None,
    choices: AuditOptions | None = None,
) -> Mended:
    """Write a repaired copy of a URDF file and the meshes that it needs.

    Args:
        path: The file; it is not modified.
        out: Folder to write to.
        density: Density of everything without mass [kg/m³]; without it no mass is computed, but inertias for stated masses are.
        collision: "pieces" replaces closed collision meshes that are not convex by convex pieces inside them.
        choices: Options for the audit of the result.

    Raises:
        ReadError: If the file is not URDF.
    """
    path, out, choices = Path(path), Path(out), choices or AuditOptions()
    root = read_xml(path)
    if root.tag != "robot":
        raise ReadError(f"{path}: --fix repairs URDF files, but this is <{root.tag}>; convert it first.", path=str(path))
    references = MeshReferences(Folder.of(path, choices.root or package_of(path)))
    declared = UrdfText(references).declared(root, path)
    declared = replace(declared, states_frames=any(True for _ in root.iterfind("articad")))  # as for the audit of articad's own files
    beside = (out / path.name).resolve() == path.resolve()  # the original is not modified
    mended = Mended(out / (f"{path.stem}_mended{path.suffix}" if beside else path.name))
    mender = _Mender(root, declared, references, density, mended)
    mender.run()
    if collision == "pieces":
        mender.divide(out if beside else None)
    files = _meshes(root, references, mended, out if beside else None) | mender.pieces
    Bundle({mended.file.name: document(root)} | files).write(out)
    mended.rest = audit_file(mended.file, replace(choices, root=out))
    return mended


def mend_assembly(
    assembly: Assembly,
    out: str | Path,
    *,
    density: float | None = None,
    collision: Literal["pieces"] | None = None,
    choices: AuditOptions | None = None,
) -> Mended:
    """Write an assembly as URDF, with masses from its solids where it has none; with convex pieces on request."""
    out, choices = Path(out), choices or AuditOptions()
    weighed: dict[str, float] = {}
    parts = dict(assembly.parts)
    for name, part in parts.items():
        if part.mass is None and part.solid is not None and density is not None:
            parts[name] = replace(part, mass=part.solid.mass(density))
            weighed[name] = part.solid.mass(density).mass
    bundle = write_urdf(replace(assembly, parts=parts), collision=collision)
    bundle.write(out)
    done = [f"computed the mass of {counted(len(weighed), 'part')} at {density:g} kg/m³: {listed(list(weighed))}"] if weighed else []
    done.append("written as URDF")
    mended = Mended(out / bundle.main, done, weighed)
    mended.rest = audit_file(mended.file, replace(choices, root=out))
    return mended


class _Mender:
    """Changes one document."""

    def __init__(self, root: Any, declared: Declared, references: MeshReferences, density: float | None, mended: Mended) -> None:
        self.root, self.declared, self.references, self.density, self.mended = root, declared, references, density, mended
        self.links = {element.get("name"): element for element in root.iterfind("link")}
        self.pieces: dict[str, bytes] = {}

    def run(self) -> None:
        """Do all that can be done; names last, because everything else finds links by them."""
        self._compiler()
        self._endless()
        self._weigh()
        self._collide()
        self._raise()
        self._name()

    def _compiler(self) -> None:
        """Make MuJoCo keep folders in the names of meshes, as every other reader does."""
        if self.root.find("mujoco") is None:
            settings = {"strippath": "false", "discardvisual": "false", "fusestatic": "false", "balanceinertia": "false"}
            child(child(self.root, "mujoco"), "compiler", settings)
            self.mended.done.append("set MuJoCo to keep folders in mesh names")

    def _endless(self) -> None:
        """Make bounded turns of 2π or more continuous."""
        found = {finding.message.split("'")[1] for finding in limits.endless(self.declared)}
        changed = []
        for element in self.root.iterfind("joint"):
            if element.get("name") in found and element.get("type") == "revolute":
                element.set("type", "continuous")
                limit = element.find("limit")
                for bound in ("lower", "upper"):
                    limit.attrib.pop(bound, None)
                changed.append(element.get("name"))
        if changed:
            self.mended.done.append(f"made {counted(len(changed), 'joint')} continuous: {listed(changed)}")

    def _weigh(self) -> None:
        """Give mass and inertia to links with closed shapes: from the density, or from the stated mass if only the inertia is wrong."""
        moving = {name for group in self.declared.moving_groups for name in group}
        wrong = {
            name for check in masses.CHECKS for finding in check(self.declared) if finding.code in BAD_INERTIA for name in finding.parts
        }
        weighed, corrected = [], []
        for link in self.declared.links:
            stated = None if link.inertial is None else link.inertial.mass
            needs = stated is None or stated < 0 or (stated == 0 and link.name in moving)
            if not (self.density if needs else link.name in wrong) or (body := _body(link)) is None:
                continue
            mass = MassProperties.from_solid(*body.solid_integrals(), self.density or 1.0)
            if not needs and stated is not None:  # only the shape counts
                mass = mass.scaled(stated / mass.mass)
                corrected.append(link.name)
            else:
                weighed.append(link.name)
                self.mended.masses[link.name] = mass.mass
            self._write_inertial(self.links[link.name], mass)
        if weighed:
            self.mended.done.append(f"computed the mass of {counted(len(weighed), 'link')} at {self.density:g} kg/m³: {listed(weighed)}")
        if corrected:
            self.mended.done.append(
                f"computed the inertia of {counted(len(corrected), 'link')} from shape and stated mass: {listed(corrected)}"
            )

    def _write_inertial(self, link: Any, mass: MassProperties) -> None:
        for old in link.findall("inertial"):
            link.remove(old)
        element = etree.Element("inertial")
        link.insert(0, element)
        child(element, "origin", {"xyz": numbers(mass.com / MM_PER_M), "rpy": "0 0 0"})
        child(element, "mass", {"value": number(mass.mass)})
        inertia = mass.inertia / MM_PER_M**2
        child(element, "inertia", {f"i{'xyz'[i]}{'xyz'[j]}": number(inertia[i, j]) for i in range(3) for j in range(i, 3)})

    def _collide(self) -> None:
        """Use visual shapes for collision, if they are closed."""
        added = []
        for finding in shapes.no_collision(self.declared):
            for name in finding.parts:
                link = self.declared.by_name[name]
                if _body(link) is None:
                    continue
                for visual in self.links[name].findall("visual"):
                    element = copy.deepcopy(visual)
                    element.tag = "collision"
                    for material in element.findall("material"):
                        element.remove(material)
                    element.attrib.pop("name", None)
                    self.links[name].append(element)
                added.append(name)
        if added:
            self.mended.done.append(f"copied visual shapes for collision to {counted(len(added), 'link')}: {listed(added)}")

    def divide(self, kept: Path | None = None) -> None:
        """Replace collision meshes that are not convex by convex pieces inside them; `pieces` gets the files of their meshes.

        Small gaps of a mesh are closed first.

        Args:
            kept: A folder of which no file may be replaced by another.
        """
        cache, names = BuildCache(), Names()
        divided, gaps, left = [], [], []
        for link in UrdfText(self.references).declared(self.root, self.mended.file).links:
            elements = [one for place in self.root.iterfind("link") if place.get("name") == link.name for one in place.findall("collision")]
            elements = [
                one for one in elements if (geometry := one.find("geometry")) is not None and len(geometry)
            ]  # the others are no shapes
            for element, shape in zip(elements, link.of("collision"), strict=True):
                if shape.kind != "mesh" or shape.mesh is None or _is_convex(shape.mesh):
                    continue
                found = pieces_of(without_gaps(shape.mesh), cache)
                if not found.inside:
                    left.append(link.name)
                    continue
                if not shape.mesh.is_closed:
                    gaps.append(link.name)
                for index, piece in enumerate(found.pieces):
                    element.addprevious(self._piece(element, piece, _free_name(names, f"{link.name}_{index}", kept)))
                element.getparent().remove(element)
                divided.append(f"{link.name} ({len(found.pieces)}, {found.missing:.2g} mm left out)")
        if divided:
            self.mended.done.append(
                f"divided {counted(len(divided), 'collision mesh', 'collision meshes')} into convex pieces: {listed(divided)}"
            )
        if gaps:
            meshes = counted(len(gaps), "collision mesh", "collision meshes")
            self.mended.done.append(f"closed gaps of at most {100 * GAP_SHARE:g} % of the surface in {meshes} first: {listed(gaps)}")
        if left:
            self.mended.done.append(f"left {counted(len(left), 'collision mesh', 'collision meshes')} that enclose nothing: {listed(left)}")

    def _piece(self, old: Any, piece: Piece, name: str) -> Any:
        """Return the collision element of a piece; pieces are in the link's frame."""
        element = etree.Element("collision", {"name": name} if old.get("name") else {})
        xyz = numbers(tidy(piece.frame.translation / MM_PER_M))
        child(element, "origin", {"xyz": xyz, "rpy": numbers(tidy(rpy(piece.frame)))})
        geometry, form = child(element, "geometry"), piece.primitive
        if form is None:
            self.pieces[PIECE_FILE.format(name)] = write_stl(piece.mesh)
            child(geometry, "mesh", {"filename": PIECE_FILE.format(name), "scale": "0.001 0.001 0.001"})
            return element
        sizes = tidy((size / MM_PER_M for size in form.size), scale=0)
        if form.kind == "box":
            child(geometry, "box", {"size": numbers(sizes)})
        elif form.kind == "sphere":
            child(geometry, "sphere", {"radius": number(sizes[0])})
        else:
            child(geometry, "cylinder", {"radius": number(sizes[0]), "length": number(sizes[1])})
        return element

    def _raise(self) -> None:
        """Put a base link at the lowest point, and the robot on it."""
        for finding in shapes.base_below(self.declared):
            (old,) = self.declared.roots
            name = "base_floor"
            while name in self.links or any(joint.name == name for joint in self.declared.joints):
                name += "_"
            link = etree.Element("link", {"name": name})
            self.root.insert(0, link)
            joint = child(self.root, "joint", {"name": f"{name}_joint", "type": "fixed"})
            child(joint, "origin", {"xyz": f"0 0 {number((finding.value or 0.0) / MM_PER_M)}", "rpy": "0 0 0"})
            child(joint, "parent", {"link": name})
            child(joint, "child", {"link": old})
            self.mended.done.append(f"put {old} {finding.value:.4g} mm above a new base link {name}")

    def _name(self) -> None:
        """Give every link and joint a name that all readers accept, and update all references."""
        changes: dict[str, str] = {}
        for kind in ("link", "joint"):
            names = Names()
            mapping = {element.get("name"): names.claim(element.get("name") or kind) for element in self.root.iterfind(kind)}
            for element in self.root.iter(kind):
                if element.get("name") in mapping:
                    element.set("name", mapping[element.get("name")])
            for element in self.root.iter():
                key = "link" if kind == "link" else "joint"
                if element.get(key) in mapping:
                    element.set(key, mapping[element.get(key)])
                if element.tag == "gazebo" and element.get("reference") in mapping:
                    element.set("reference", mapping[element.get("reference")])
            changes |= names.changed
        old = self.root.get("name") or ""
        new = Names().claim(old or "robot")[:MOST_CHARACTERS].strip("_")
        if new != old:
            self.root.set("name", new)
            changes[old[:40]] = new
        if changes:
            shown = [f"{before!r} → {after!r}" for before, after in changes.items()]
            self.mended.done.append(f"renamed {len(changes)}: {listed(shown)}")


def _is_convex(mesh: TriMesh) -> bool:
    """True for a body that its hull replaces exactly, and for a mesh without triangles."""
    if not len(mesh.triangles):
        return True
    return mesh.is_closed and mesh.volume > 0 and hull_mesh(mesh.vertices).volume <= mesh.volume * (1 + CONVEX_SHARE)


def _free_name(names: Names, wanted: str, kept: Path | None) -> str:
    """Return a name for a piece whose file does not exist in the folder yet."""
    name = names.claim(wanted)
    while kept is not None and (kept / PIECE_FILE.format(name)).exists():
        name = names.claim(wanted)
    return name


def _body(link: DeclaredLink) -> TriMesh | None:
    """Return the union of a link's shapes, in its frame; None if one is not closed."""
    chosen = link.of("visual") or link.of("collision")
    meshes = [shape.mesh for shape in chosen]
    closed = [mesh for mesh in meshes if mesh is not None and mesh.is_closed and mesh.volume > 0]
    if not closed or len(closed) != len(meshes):
        return None
    whole = united([body for mesh in closed for body in _bodies(mesh)])
    return whole if whole.is_closed and whole.volume > 0 else None


def _bodies(mesh: TriMesh) -> tuple[TriMesh, ...]:
    """Return the bodies of a mesh, so that their overlaps count once; the mesh itself if one of its pieces is a void."""
    pieces = mesh.components()
    return pieces if all(piece.is_closed and piece.volume > 0 for piece in pieces) else (mesh,)


def _meshes(root: Any, references: MeshReferences, mended: Mended, kept: Path | None) -> dict[str, bytes]:
    """Return the mesh files that the document names, in a format that every simulator reads, and update their names.

    Args:
        root: The document.
        references: Its meshes.
        mended: Receives what was done.
        kept: A folder of which no file may be replaced by another.
    """
    files: dict[str, bytes] = {}
    taken: dict[Path, str] = {}
    names, converted = Names(), []
    for element in root.iter("mesh"):
        stated = element.get("filename") or ""
        path = references.paths.get(stated)
        if path is None:
            continue
        if path not in taken:
            raw = references.raw(stated)
            as_it_is = path.suffix.lower() in {".stl", ".obj"} or raw is None
            suffix = path.suffix.lower() if as_it_is else ".stl" if len(raw.triangles) <= STL_TRIANGLES else ".obj"  # type: ignore[union-attr]
            if raw is None or as_it_is:
                content = read_file(path, MAX_FILE_BYTES)
            else:
                content = write_stl(raw) if suffix == ".stl" else write_obj(raw)
                converted.append(path.name)
            name = f"meshes/{names.claim(path.stem)}{suffix}"
            while kept is not None and differs(kept / name, content):
                name = f"meshes/{names.claim(path.stem)}{suffix}"
            taken[path] = name
            files[taken[path]] = content
        element.set("filename", taken[path])
    if converted:
        mended.done.append(
            f"converted {counted(len(converted), 'mesh', 'meshes')} to a format that all simulators read: {listed(converted)}"
        )
    return files
