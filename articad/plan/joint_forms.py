"""Joints and couplings as a plan states them: angles in degrees, lengths in mm, any number an expression."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Discriminator, Field, Tag

from articad.aliases import Fastening
from articad.plan.fields import CoordinatePair, Interval, Name, Number, NumberPair, PlanObject, Range, Reference, Text, Truth

MateName = Literal["aligned", "opposed"]
Contact = Literal["allowed", "required", "forbidden"]


class FitSpec(PlanObject):
    """How closely the two parts of a joint fit."""

    gap_mm: Interval | None = Field(
        None, description="Surface distance at least min over the motion; play (half the difference of diameters) at most max at rest"
    )
    within_mm: Number | None = Field(None, description="Only surface closer than this to the joint's axis counts")
    contact: Contact | None = None
    name: Text | None = Field(None, description="Instead of gap_mm: H7/g6 (ISO 286), or loose, sliding, press for printed parts")
    nominal_mm: Number | None = Field(None, description="Nominal diameter of a named fit; without it, the bore's")


def _fit_form(value: Any) -> Any:
    """Let a fit be its name alone."""
    return {"name": value} if isinstance(value, str) else value


FitForm = Annotated[FitSpec, BeforeValidator(_fit_form, json_schema_input_type=FitSpec | str)]


class JointForm(PlanObject):
    """What all joints state."""

    name: Name
    type: str
    parent: Reference = Field(description="Motion is measured about and along this connector's +z")
    child: Reference
    mate: MateName = Field("aligned", description="aligned: the two z axes agree at rest; opposed: they point against each other")
    driver: Truth = Field(default=False, description="Only with loops or couplings: a joint that is moved, the others follow")
    fit: FitForm | None = None
    fastening: Fastening | None = Field(None, description="How the two parts are held together, for the order of assembly")
    effort_n_mm: Number | None = Field(None, description="Largest torque of a turning joint")
    velocity_deg_s: Number | None = Field(None, description="Largest speed of a turning joint")
    effort_n: Number | None = Field(None, description="Largest force of a sliding joint")
    velocity_mm_s: Number | None = Field(None, description="Largest speed of a sliding joint")


class FixedSpec(JointForm):
    """Holds the child rigidly."""

    type: Literal["fixed"]


class RevoluteSpec(JointForm):
    """Turns about z."""

    type: Literal["revolute"]
    angle_deg: Range | None = Field(None, description="Required: [lower, upper] in degrees, or endless")
    rest_deg: Number = 0.0


class SliderSpec(JointForm):
    """Slides along z."""

    type: Literal["slider"]
    travel_mm: Interval | None = Field(None, description="Required")
    rest_mm: Number = 0.0


class CylindricalSpec(JointForm):
    """Slides along z and turns about it, independently."""

    type: Literal["cylindrical"]
    travel_mm: Range | None = Field(None, description="Required")
    angle_deg: Range | None = Field(None, description="Required")
    rest_mm: Number = 0.0
    rest_deg: Number = 0.0


class BallSpec(JointForm):
    """Swings and twists about the common origin; rests at the identity."""

    type: Literal["ball"]
    cone_deg: Number | None = Field(None, description="Required: largest angle between the two z axes")
    twist_deg: Interval | None = Field(None, description="Turn about z; null: free")


class ScrewSpec(JointForm):
    """Turns about z and advances along it by lead_mm a turn, right-handed when positive."""

    type: Literal["screw"]
    lead_mm: Number
    angle_deg: Range | None = Field(None, description="Required")
    rest_deg: Number = 0.0


class PlanarSpec(JointForm):
    """Slides along the parent's x and y and turns about z; rests at zero."""

    type: Literal["planar"]
    x_mm: Interval | None = Field(None, description="Required")
    y_mm: Interval | None = Field(None, description="Required")
    angle_deg: Range | None = Field(None, description="Required")


class UniversalSpec(JointForm):
    """Turns about the parent's x by a, then about the turned y by b; rests at zero."""

    type: Literal["universal"]
    a_deg: Interval | None = Field(None, description="Required")
    b_deg: Interval | None = Field(None, description="Required")


class FreeSpec(JointForm):
    """Leaves the child free in all six directions, as the base of a mobile robot; rests where the two connectors coincide."""

    type: Literal["free"]


class JointDerivation(PlanObject):
    """The joint that a derived one copies."""

    source: Name = Field(alias="from")
    op: Literal["mirror", "rigid"]


class DerivedJoint(PlanObject):
    """A joint copied from another, with the signs that a mirror needs."""

    name: Name
    derive: JointDerivation
    parent: Reference
    child: Reference = Field(description="On the part that is the image of the source's child")


JOINT_TYPES = ("fixed", "revolute", "slider", "cylindrical", "ball", "screw", "planar", "universal", "free")


def _joint_tag(value: Any) -> str | None:
    if isinstance(value, dict):
        return "derived" if "derive" in value else value.get("type")
    return "derived" if isinstance(value, DerivedJoint) else getattr(value, "type", None)


JointSpec = FixedSpec | RevoluteSpec | SliderSpec | CylindricalSpec | BallSpec | ScrewSpec | PlanarSpec | UniversalSpec | FreeSpec

AnyJoint = Annotated[
    Annotated[FixedSpec, Tag("fixed")]
    | Annotated[RevoluteSpec, Tag("revolute")]
    | Annotated[SliderSpec, Tag("slider")]
    | Annotated[CylindricalSpec, Tag("cylindrical")]
    | Annotated[BallSpec, Tag("ball")]
    | Annotated[ScrewSpec, Tag("screw")]
    | Annotated[PlanarSpec, Tag("planar")]
    | Annotated[UniversalSpec, Tag("universal")]
    | Annotated[FreeSpec, Tag("free")]
    | Annotated[DerivedJoint, Tag("derived")],
    Discriminator(_joint_tag),
]


class CouplingForm(PlanObject):
    """What all couplings state."""

    name: Name
    type: str
    joints: CoordinatePair = Field(description="[a, b]: b follows a; of a cylindrical joint, joint.travel or joint.angle")


class GearSpec(CouplingForm):
    """Two meshing gears on parallel axes."""

    type: Literal["gear"]
    teeth: NumberPair
    internal: Truth = False


class BeltSpec(CouplingForm):
    """Two pulleys on parallel axes."""

    type: Literal["belt"]
    radii_mm: NumberPair


class RackSpec(CouplingForm):
    """A pinion (joint a) that drives a rack (joint b)."""

    type: Literal["rack"]
    module_mm: Number
    teeth: Number


class ScrewCouplingSpec(CouplingForm):
    """A turning joint a that drives a sliding joint b by lead_mm a turn."""

    type: Literal["screw"]
    lead_mm: Number


class LinearSpec(CouplingForm):
    """b = ratio * a + offset, in mm and degrees."""

    type: Literal["linear"]
    ratio: Number
    offset: Number = 0.0


CouplingSpec = Annotated[GearSpec | BeltSpec | RackSpec | ScrewCouplingSpec | LinearSpec, Field(discriminator="type")]
COUPLING_TYPES = ("gear", "belt", "rack", "screw", "linear")

__all__ = [
    "COUPLING_TYPES",
    "JOINT_TYPES",
    "AnyJoint",
    "BallSpec",
    "BeltSpec",
    "Contact",
    "CouplingForm",
    "CouplingSpec",
    "CylindricalSpec",
    "DerivedJoint",
    "FitSpec",
    "FixedSpec",
    "FreeSpec",
    "GearSpec",
    "JointDerivation",
    "JointForm",
    "JointSpec",
    "LinearSpec",
    "MateName",
    "PlanarSpec",
    "RackSpec",
    "RevoluteSpec",
    "ScrewCouplingSpec",
    "ScrewSpec",
    "SliderSpec",
    "UniversalSpec",
]
