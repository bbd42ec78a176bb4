"""STEP: one assembly file with a product per part, placed as it rests, with names and colours.

The parts' own STEP files, which the kernel's worker wrote, are merged as text: their entities are renumbered and an assembly
structure is put above them (ISO 10303-44: next assembly usage occurrences with item-defined transformations), so that no B-rep enters
this process and the same parts give the same bytes.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from articad.connectors.se3 import SE3
from articad.errors import ExportError
from articad.export.bundle import Bundle
from articad.export.losses import Feature, losses_of, refuse
from articad.export.names import valid_name
from articad.kinematics.joints import JointType

if TYPE_CHECKING:
    from articad.assembly import Assembly

TIME = "2000-01-01T00:00:00"  # the same assembly gives the same bytes
UNCERTAINTY_MM = 1e-7  # below which two points of the file are one

_ENTITY = re.compile(r"#(\d+)\s*=\s*((?:[^';]|'(?:[^']|'')*')*);", re.DOTALL)
_TOKEN = re.compile(r"'(?:[^']|'')*'|#(\d+)", re.DOTALL)
_SHAPES = ("ADVANCED_BREP_SHAPE_REPRESENTATION", "SHAPE_REPRESENTATION", "FACETED_BREP_SHAPE_REPRESENTATION")


@dataclass(frozen=True)
class _Component:
    """Where a part's product is in the merged file: numbers of its entities."""

    definition: int
    representation: int
    origin: int


def write_step(assembly: Assembly, *, strict: bool = False) -> Bundle:
    """Write the B-rep of all parts as one STEP assembly (AP214) in the rest pose, in mm.

    Args:
        assembly: What to write; parts without a B-rep are left out.
        strict: Refuse losses of motion, mass or shape; STEP holds no joints, so only a rigid assembly passes.

    Returns:
        `<name>.step` and the losses.

    Raises:
        UnrepresentableError: If `strict` and there is such a loss.
        ExportError: If no part has a B-rep, or a part's file is not STEP.
    """
    losses = losses_of("step", _features(assembly))
    if strict:
        refuse(losses)
    files = {
        name: part.solid.step.read_text("utf-8") for name, part in assembly.parts.items() if part.solid is not None and part.solid.step
    }
    if not files:
        raise ExportError(f"No part of {assembly.name!r} has a B-rep, so there is nothing to write as STEP.")
    writer = _Writer()
    root = writer.root(assembly.name)
    rest = assembly.mechanism.rest_poses()
    for name, text in files.items():
        # copies do not share a product: many readers show its name, not the instance's
        writer.place(writer.component(text, name, assembly.parts[name].color), root, name, rest[name])
    return Bundle({f"{valid_name(assembly.name)}.step": writer.document(assembly.name)}, losses)


class _Writer:
    """Collects entities under new numbers."""

    def __init__(self) -> None:
        self.entities: list[str] = []

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
            "FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));",
            "ENDSEC;",
            "DATA;",
        ]
        data = [f"#{number} = {body};" for number, body in enumerate(self.entities, start=1)]
        return ("\n".join([*header, *data, "ENDSEC;", "END-ISO-10303-21;"]) + "\n").encode("ascii")

    def root(self, name: str) -> _Component:
        """Add the product that the parts are placed in."""
        application = self.add("APPLICATION_CONTEXT('automotive design')")
        self.add(f"APPLICATION_PROTOCOL_DEFINITION('international standard','automotive_design',2000,#{application})")
        context = self.add(f"PRODUCT_CONTEXT('',#{application},'mechanical')")
        product = self.add(f"PRODUCT({_text(name)},{_text(name)},'',(#{context}))")
        self.add(f"PRODUCT_RELATED_PRODUCT_CATEGORY('part',$,(#{product}))")
        formation = self.add(f"PRODUCT_DEFINITION_FORMATION('','',#{product})")
        stage = self.add(f"PRODUCT_DEFINITION_CONTEXT('part definition',#{application},'design')")
        definition = self.add(f"PRODUCT_DEFINITION('design','',#{formation},#{stage})")
        shape = self.add(f"PRODUCT_DEFINITION_SHAPE('','',#{definition})")
        origin = self.axes(SE3.identity())
        representation = self.add(f"SHAPE_REPRESENTATION('',(#{origin}),#{self._geometric_context()})")
        self.add(f"SHAPE_DEFINITION_REPRESENTATION(#{shape},#{representation})")
        return _Component(definition, representation, origin)

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
        """Take over a part's file under new numbers, with our name and colour.

        Raises:
            ExportError: If it is not the STEP file of one product.
        """
        found = {int(number): " ".join(body.split("\n")) for number, body in _ENTITY.findall(text.partition("DATA;")[2])}
        offset = len(self.entities)
        number_of = {old: offset + place for place, old in enumerate(found, start=1)}
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
        listed = ",".join(f"#{item}" for item in items)
        self.add(f"MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',({listed}),#{context})")

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
    """Return an entity with its references under new numbers; what stands in quotes is left alone."""

    def new(match: re.Match[str]) -> str:
        if match.group(1) is None:
            return match.group(0)
        try:
            return f"#{number_of[int(match.group(1))]}"
        except KeyError:
            raise ExportError(f"The STEP file of part {name!r} refers to #{match.group(1)}, which it does not hold.") from None

    return _TOKEN.sub(new, body)


def _renamed(kind: str, body: str, name: str) -> str:
    """Return a product under the part's name."""
    return (
        re.sub(r"^PRODUCT\s*\(\s*'(?:[^']|'')*'\s*,\s*'(?:[^']|'')*'", lambda _: f"PRODUCT({_text(name)},{_text(name)}", body)
        if kind == "PRODUCT"
        else body
    )


def _text(value: str) -> str:
    """Return a string of a STEP file: quotes doubled, what is not ASCII as UTF-16 in hexadecimal."""
    encoded = "".join(c if " " <= c <= "~" else f"\\X2\\{c.encode('utf-16-be').hex().upper()}\\X0\\" for c in value.replace("\\", "\\\\"))
    return "'" + encoded.replace("'", "''") + "'"


def _real(value: float) -> str:
    """Return a number with the point that the format demands."""
    mantissa, _, exponent = repr(float(value) + 0.0).partition("e")
    mantissa = mantissa.removesuffix(".0") + "." if mantissa.endswith(".0") or "." not in mantissa else mantissa
    return f"{mantissa}E{exponent}" if exponent else mantissa


def _reals(values: Iterable[float]) -> str:
    return "(" + ",".join(_real(value) for value in values) + ")"


def _features(assembly: Assembly) -> list[Feature]:
    features = [Feature("motion", f"joints.{joint.name}") for joint in assembly.joints if joint.type is not JointType.FIXED]
    for name, part in assembly.parts.items():
        if part.mass is not None:
            features.append(Feature("mass", f"parts.{name}"))
        if part.solid is None or part.solid.step is None:
            features.append(Feature("brep.missing", f"parts.{name}"))
    return features
