"""STEP AP242: one assembly file with a product per shape and an instance per part, at the rest pose, with names and colours.

Parts joined by fixed joints are instances in a sub-assembly of their own, which moves as one body in a CAD program.

The parts' own STEP files, which the kernel's worker wrote, are merged as text: their entities are renumbered and an assembly structure
is added above them (ISO 10303-44: next assembly usage occurrences with item-defined transformations), so that no B-rep enters this
process and the same parts give the same bytes. Parts with the same file and colour are instances of one product.

A part that has a mesh and no B-rep becomes solids with plane faces, one for each triangle (ISO 10303-42: faceted_brep), or a surface
model if the mesh is open. (OpenCASCADE drops voids of a faceted_brep, so a solid with voids is a brep_with_voids.)
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from articad.connectors.se3 import SE3
from articad.errors import ExportError
from articad.export.bundle import Bundle
from articad.export.features import body_mesh, motion_and_mass
from articad.export.hulls import rigid_groups
from articad.export.losses import Feature, kept_losses, losses_of, refuse
from articad.export.names import Names, valid_name
from articad.export.product import of_the_product
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Part

if TYPE_CHECKING:
    from articad.assembly import Assembly

SCHEMA = "AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF {1 0 10303 442 1 1 4 }"  # ISO 10303-242
PROTOCOL = "ap242_managed_model_based_3d_engineering"
TIME = "2000-01-01T00:00:00"  # the same assembly gives the same bytes
UNCERTAINTY_MM = 1e-7  # two points of the file that are closer count as one
MOST_FACETS = 50_000  # for one part without a B-rep: CAD readers need minutes for more plane faces
LEAST_AREA_MM2 = 1e-12  # a smaller triangle has no plane

_ENTITY = re.compile(r"#(\d+)\s*=\s*((?:[^';]|'(?:[^']|'')*')*);", re.DOTALL)
_TOKEN = re.compile(r"'(?:[^']|'')*'|#(\d+)", re.DOTALL)
_SHAPES = ("ADVANCED_BREP_SHAPE_REPRESENTATION", "SHAPE_REPRESENTATION", "FACETED_BREP_SHAPE_REPRESENTATION")


@dataclass(frozen=True)
class _Component:
    """A part's product in the merged file: numbers of its entities."""

    definition: int
    representation: int
    origin: int


@of_the_product
def write_step(assembly: Assembly, *, flat: bool = False, strict: bool = False) -> Bundle:
    """Write all parts that have a shape as one STEP assembly (AP242) in the rest pose, in mm.

    Parts of the same shape and colour are instances of one product. Parts joined by fixed joints, unless that is all of them, are in a
    sub-assembly `<first part>_group` with the first part's frame.

    Args:
        assembly: What to write.
        flat: Write all parts side by side, each placed in the assembly's frame, with no sub-assemblies.
        strict: Refuse losses of motion, mass or shape; STEP holds no joints, so only a rigid assembly passes.

    Returns:
        `<name>.step` and the losses.

    Raises:
        UnrepresentableError: If `strict` and there is such a loss.
        ExportError: If no part has a shape, a part's file is not STEP, or a part without a B-rep has more than `MOST_FACETS` triangles.
    """
    losses = (*losses_of("step", _features(assembly)), *kept_losses("step", assembly.kept))
    if strict:
        refuse(losses)
    writer = _Writer()
    root = writer.root(assembly.name)
    rest = assembly.mechanism.rest_poses()
    products: dict[tuple[str, str], _Component] = {}
    for group in _groups(assembly, flat=flat):
        above, place = root, SE3.identity()
        if group.name:
            above, place = writer.root(group.name), rest[group.parts[0]]
            writer.place(above, root, group.name, place)
        for name in group.parts:
            part = assembly.parts[name]
            key = str(_shape_key(part)), part.color
            if key not in products:
                products[key] = writer.product(part)
            writer.place(products[key], above, name, place.inverse() @ rest[name])
    if not products:
        raise ExportError(f"No part of {assembly.name!r} has a shape, so there is nothing to write as STEP.")
    return Bundle({f"{valid_name(assembly.name)}.step": writer.document(assembly.name)}, losses)


@dataclass(frozen=True)
class _Group:
    """Parts of one product: a sub-assembly of this name, or the whole assembly if the name is empty."""

    name: str
    parts: tuple[str, ...]


def _groups(assembly: Assembly, *, flat: bool) -> list[_Group]:
    """Return the parts with a shape, grouped by the body that they move with, in the order in which they are declared."""
    shaped = [name for name, part in assembly.parts.items() if _shape_key(part) is not None]
    body = rigid_groups(assembly.mechanism.joints, tuple(assembly.parts))
    members: dict[int, list[str]] = {}
    for name in shaped:
        members.setdefault(body[name], []).append(name)
    if flat or len(members) < 2:
        return [_Group("", tuple(shaped))]
    names = Names(assembly.parts, valid=str)
    return [_Group(names.claim(f"{parts[0]}_group") if len(parts) > 1 else "", tuple(parts)) for parts in members.values()]


def _shape_key(part: Part) -> str | None:
    """Return a key that is equal for parts of the same shape; None for a part without one."""
    if part.solid is not None and part.solid.step is not None:
        return str(part.solid.step)
    mesh = body_mesh(part)
    return None if mesh is None else mesh.digest


class _Writer:
    """Collects entities under new numbers."""

    def __init__(self) -> None:
        self.entities: list[str] = []
        self._application: int | None = None

    def add(self, body: str) -> int:
        """Append an entity and return its number."""
        self.entities.append(body)
        return len(self.entities)

    def document(self, name: str) -> bytes:
        """Return the file."""
        title = _text(name)
        header = [
            "ISO-10303-21;",
            "HEADER;",
            "FILE_DESCRIPTION(('articad assembly'),'2;1');",
            f"FILE_NAME({title},'{TIME}',(''),(''),'articad','articad','');",
            f"FILE_SCHEMA(('{SCHEMA}'));",
            "ENDSEC;",
            "DATA;",
        ]
        data = [f"#{number} = {body};" for number, body in enumerate(self.entities, start=1)]
        return ("\n".join([*header, *data, "ENDSEC;", "END-ISO-10303-21;"]) + "\n").encode("ascii")

    def root(self, name: str) -> _Component:
        """Add the product that contains the parts."""
        definition, shape = self._definition(name)
        origin = self.axes(SE3.identity())
        representation = self.add(f"SHAPE_REPRESENTATION('',(#{origin}),#{self._geometric_context()})")
        self.add(f"SHAPE_DEFINITION_REPRESENTATION(#{shape},#{representation})")
        return _Component(definition, representation, origin)

    def product(self, part: Part) -> _Component:
        """Add a part's shape as a product: its B-rep, or its mesh as plane faces.

        Raises:
            ExportError: If its file is not STEP, or its mesh has too many triangles.
        """
        if part.solid is not None and part.solid.step is not None:
            return self.component(part.solid.step.read_text("utf-8"), part.name, part.color)
        mesh = body_mesh(part)
        assert mesh is not None
        return self.faceted(mesh, part.name, part.color)

    def _definition(self, name: str) -> tuple[int, int]:
        """Add a product; return its definition and the entity to which a shape is attached."""
        application = self.application()
        context = self.add(f"PRODUCT_CONTEXT('',#{application},'mechanical')")
        product = self.add(f"PRODUCT({_text(name)},{_text(name)},'',(#{context}))")
        self.add(f"PRODUCT_RELATED_PRODUCT_CATEGORY('part',$,(#{product}))")
        formation = self.add(f"PRODUCT_DEFINITION_FORMATION('','',#{product})")
        stage = self.add(f"PRODUCT_DEFINITION_CONTEXT('part definition',#{application},'design')")
        definition = self.add(f"PRODUCT_DEFINITION('design','',#{formation},#{stage})")
        return definition, self.add(f"PRODUCT_DEFINITION_SHAPE('','',#{definition})")

    def application(self) -> int:
        """Return the application context of the file."""
        if self._application is None:
            self._application = self.add("APPLICATION_CONTEXT('Managed model based 3d engineering')")
            self.add(f"APPLICATION_PROTOCOL_DEFINITION('international standard','{PROTOCOL}',2013,#{self._application})")
        return self._application

    def _geometric_context(self) -> int:
        length = self.add("( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.) )")
        angle = self.add("( NAMED_UNIT(*) PLANE_ANGLE_UNIT() SI_UNIT($,.RADIAN.) )")
        solid = self.add("( NAMED_UNIT(*) SI_UNIT($,.STERADIAN.) SOLID_ANGLE_UNIT() )")
        measure = f"LENGTH_MEASURE({_real(UNCERTAINTY_MM)})"
        uncertainty = self.add(f"UNCERTAINTY_MEASURE_WITH_UNIT({measure},#{length},'distance_accuracy_value','confusion accuracy')")
        return self.add(
            f"( GEOMETRIC_REPRESENTATION_CONTEXT(3) GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#{uncertainty})) "
            f"GLOBAL_UNIT_ASSIGNED_CONTEXT((#{length},#{angle},#{solid})) REPRESENTATION_CONTEXT('','') )"
        )

    def axes(self, T: SE3) -> int:
        """Add a placement."""
        point = self.add(f"CARTESIAN_POINT('',{_reals(T.translation)})")
        z, x = (self.add(f"DIRECTION('',{_reals(axis)})") for axis in (T.z_axis, T.x_axis))
        return self.add(f"AXIS2_PLACEMENT_3D('',#{point},#{z},#{x})")

    def component(self, text: str, name: str, color: str) -> _Component:
        """Add a part's file with renumbered entities, and with articad's name and colour.

        Raises:
            ExportError: If it is not the STEP file of one product.
        """
        found = {int(number): " ".join(body.split("\n")) for number, body in _ENTITY.findall(text.partition("DATA;")[2])}
        application = self.application()  # the part's own names another protocol
        own = [old for old, body in found.items() if body.startswith("APPLICATION_CONTEXT")]
        found = {
            old: body for old, body in found.items() if not body.startswith(("APPLICATION_CONTEXT", "APPLICATION_PROTOCOL_DEFINITION"))
        }
        offset = len(self.entities)
        number_of = {old: offset + place for place, old in enumerate(found, start=1)} | dict.fromkeys(own, application)
        kinds: dict[str, list[int]] = {}
        for old, body in found.items():
            kind = body.partition("(")[0].strip()
            kinds.setdefault(kind, []).append(number_of[old])
            self.add(_renamed(kind, _renumbered(body, number_of, name), name))
        links = [(number_of[old], body) for old, body in found.items() if body.startswith("SHAPE_DEFINITION_REPRESENTATION")]
        if not kinds.get("PRODUCT_DEFINITION") or not links:
            raise ExportError(f"The STEP file of part {name!r} does not hold a product with a shape.")
        old_shape = re.findall(r"#(\d+)", links[0][1])[1]
        representation = number_of[int(old_shape)]
        origin = self.axes(SE3.identity())
        solids = [number for kind in ("MANIFOLD_SOLID_BREP", "BREP_WITH_VOIDS") for number in kinds.get(kind, [])]
        self._color(solids, color, re.findall(r"#(\d+)\s*\)\s*$", self.entities[representation - 1])[0])
        return _Component(kinds["PRODUCT_DEFINITION"][0], representation, origin)

    def faceted(self, mesh: TriMesh, name: str, color: str) -> _Component:
        """Add a mesh as a product: a solid for each closed piece of it, a surface model for each open one.

        Raises:
            ExportError: If it has more than `MOST_FACETS` triangles.
        """
        if len(mesh.triangles) > MOST_FACETS:
            raise ExportError(
                f"Part {name!r} has no B-rep, and its mesh of {len(mesh.triangles)} triangles is too fine for plane faces of STEP "
                f"({MOST_FACETS} at most). Simplify the mesh, or write GLB or 3MF."
            )
        definition, shape = self._definition(name)
        context = self._geometric_context()
        origin = self.axes(SE3.identity())
        items, surfaces = self._pieces(mesh if mesh.is_closed else mesh.welded())
        representation = self.add(f"SHAPE_REPRESENTATION('',{_references((*items, *surfaces, origin))},#{context})")
        self.add(f"SHAPE_DEFINITION_REPRESENTATION(#{shape},#{representation})")
        self._color([*items, *surfaces], color, str(context))
        return _Component(definition, representation, origin)

    def _pieces(self, mesh: TriMesh) -> tuple[list[int], list[int]]:
        """Add the connected pieces of a mesh: solids with their voids, and surface models."""
        closed = [piece for piece in mesh.components() if piece.is_closed and abs(piece.volume) > 0]
        outer = [piece for piece in closed if piece.volume > 0]
        voids: dict[int, list[TriMesh]] = {}
        opened = [piece for piece in mesh.components() if not piece.is_closed]
        for hole in (piece for piece in closed if piece.volume < 0):
            # the smallest box around the hole is that of the solid that contains it; a hole outside all solids is a solid inside out
            around = [i for i, piece in enumerate(outer) if _contains(piece.bounds, hole.bounds)]
            if around:
                voids.setdefault(min(around, key=lambda i: outer[i].volume), []).append(hole)
            else:
                opened.append(hole)
        items = []
        for index, piece in enumerate(outer):
            shell = self.add(f"CLOSED_SHELL('',{self._faces(piece)})")
            holes = [self.add(f"CLOSED_SHELL('',{self._faces(hole)})") for hole in voids.get(index, ())]
            if holes:
                # the mesh's normals at a void point away from the material, as brep_with_voids requires (ISO 10303-42)
                oriented = _references([self.add(f"ORIENTED_CLOSED_SHELL('',*,#{hole},.T.)") for hole in holes])
                items.append(self.add(f"BREP_WITH_VOIDS('',#{shell},{oriented})"))
            else:
                items.append(self.add(f"FACETED_BREP('',#{shell})"))
        shells = [self.add(f"OPEN_SHELL('',{self._faces(piece)})") for piece in opened]
        return items, [self.add(f"SHELL_BASED_SURFACE_MODEL('',(#{shell}))") for shell in shells]

    def _faces(self, mesh: TriMesh) -> str:
        """Add a plane face for each triangle; return the list of them."""
        points = [self.add(f"CARTESIAN_POINT('',{_reals(vertex)})") for vertex in mesh.vertices]
        corners = mesh.vertices[mesh.triangles]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        faces = []
        for (a, b, c), corner, normal in zip(mesh.triangles, corners, normals, strict=True):
            length = float(np.linalg.norm(normal))
            if length < 2 * LEAST_AREA_MM2:
                continue
            x = (corner[1] - corner[0]) / np.linalg.norm(corner[1] - corner[0])
            z, ref = self.add(f"DIRECTION('',{_reals(normal / length)})"), self.add(f"DIRECTION('',{_reals(x)})")
            axes = self.add(f"AXIS2_PLACEMENT_3D('',#{points[a]},#{z},#{ref})")
            plane = self.add(f"PLANE('',#{axes})")
            loop = self.add(f"POLY_LOOP('',(#{points[a]},#{points[b]},#{points[c]}))")
            bound = self.add(f"FACE_OUTER_BOUND('',#{loop},.T.)")
            faces.append(self.add(f"FACE_SURFACE('',(#{bound}),#{plane},.T.)"))
        return _references(faces)

    def _color(self, solids: Iterable[int], color: str, context: str) -> None:
        """Give solids a colour."""
        channels = ",".join(_real(int(color[at : at + 2], 16) / 255) for at in (1, 3, 5))
        rgb = self.add(f"COLOUR_RGB('',{channels})")
        fill = self.add(f"FILL_AREA_STYLE_COLOUR('',#{rgb})")
        style = self.add(f"FILL_AREA_STYLE('',(#{fill}))")
        area = self.add(f"SURFACE_STYLE_FILL_AREA(#{style})")
        side = self.add(f"SURFACE_SIDE_STYLE('',(#{area}))")
        usage = self.add(f"SURFACE_STYLE_USAGE(.BOTH.,#{side})")
        assignment = self.add(f"PRESENTATION_STYLE_ASSIGNMENT((#{usage}))")
        items = [self.add(f"STYLED_ITEM('color',(#{assignment}),#{solid})") for solid in solids]
        self.add(f"MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',{_references(items)},#{context})")

    def place(self, part: _Component, root: _Component, name: str, T: SE3) -> None:
        """Put an instance of a part's product into the root at a pose."""
        target = self.axes(T)
        usage = self.add(f"NEXT_ASSEMBLY_USAGE_OCCURRENCE({_text(name)},{_text(name)},'',#{root.definition},#{part.definition},$)")
        shape = self.add(f"PRODUCT_DEFINITION_SHAPE('Placement','Placement of an item',#{usage})")
        motion = self.add(f"ITEM_DEFINED_TRANSFORMATION('','',#{part.origin},#{target})")
        relation = self.add(
            f"( REPRESENTATION_RELATIONSHIP('','',#{part.representation},#{root.representation}) "
            f"REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(#{motion}) SHAPE_REPRESENTATION_RELATIONSHIP() )"
        )
        self.add(f"CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(#{relation},#{shape})")


def _renumbered(body: str, number_of: dict[int, int], name: str) -> str:
    """Return an entity with renumbered references; text in quotes is not changed."""

    def new(match: re.Match[str]) -> str:
        if match.group(1) is None:
            return match.group(0)
        try:
            return f"#{number_of[int(match.group(1))]}"
        except KeyError:
            raise ExportError(f"The STEP file of part {name!r} refers to #{match.group(1)}, which it does not hold.") from None

    return _TOKEN.sub(new, body)


def _renamed(kind: str, body: str, name: str) -> str:
    """Return a product with the part's name."""
    return (
        re.sub(r"^PRODUCT\s*\(\s*'(?:[^']|'')*'\s*,\s*'(?:[^']|'')*'", lambda _: f"PRODUCT({_text(name)},{_text(name)}", body)
        if kind == "PRODUCT"
        else body
    )


def _text(value: str) -> str:
    """Return a string of a STEP file: quotes doubled, non-ASCII characters as UTF-16 in hexadecimal."""
    encoded = "".join(c if " " <= c <= "~" else f"\\X2\\{c.encode('utf-16-be').hex().upper()}\\X0\\" for c in value.replace("\\", "\\\\"))
    return "'" + encoded.replace("'", "''") + "'"


def _real(value: float) -> str:
    """Return a number with the decimal point that the format requires."""
    mantissa, _, exponent = repr(float(value) + 0.0).partition("e")
    mantissa = mantissa.removesuffix(".0") + "." if mantissa.endswith(".0") or "." not in mantissa else mantissa
    return f"{mantissa}E{exponent}" if exponent else mantissa


def _references(entities: Iterable[int]) -> str:
    return "(" + ",".join(f"#{entity}" for entity in entities) + ")"


def _reals(values: Iterable[float]) -> str:
    return "(" + ",".join(_real(value) for value in values) + ")"


def _contains(outer: np.ndarray, inner: np.ndarray) -> bool:
    return bool((outer[0] <= inner[0]).all() and (inner[1] <= outer[1]).all())


def _features(assembly: Assembly) -> list[Feature]:
    features = motion_and_mass(assembly)
    for name, part in assembly.parts.items():
        if _shape_key(part) is None:
            features.append(Feature("shape.missing", f"parts.{name}"))
        elif part.solid is None or part.solid.step is None:
            features.append(Feature("brep.missing", f"parts.{name}"))
    return features
