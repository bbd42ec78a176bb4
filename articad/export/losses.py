"""The table of losses: for each feature of an assembly and each format, what it becomes and what is lost.

The table is data: exporters report its rows, `docs/reference/losses.md` is generated from it, and a test walks over
all of it. A feature whose `lost` is empty is held by the format without loss.
"""

from __future__ import annotations

import re
from collections.abc import Container, Iterable
from typing import TYPE_CHECKING, Literal, NamedTuple

from articad.errors import UnrepresentableError
from articad.export.bundle import Loss
from articad.findings import Finding

if TYPE_CHECKING:
    from articad.assembly import Kept

Format = Literal["urdf", "mjcf", "sdf", "usd", "freecad", "glb", "3mf", "step", "plan"]

_SHAPE = re.compile(r"(parts\..*)\.(?:visuals|collisions)\.\d+$")  # where something is said of one shape of a part

MECHANISM_FORMATS: tuple[Format, ...] = ("urdf", "mjcf", "sdf", "usd")  # hold joints; the others hold shapes


class LossRow(NamedTuple):
    """What one feature becomes in one format.

    Attributes:
        becomes: What is written.
        lost: What a reader that does not know articad's metadata does not see; empty for nothing.
        refused: Whether `strict` refuses it, because motion, mass or shape change.
    """

    becomes: str
    lost: str = ""
    refused: bool = False


class Feature(NamedTuple):
    """A feature that an assembly has, so that each writer can look its row up.

    Attributes:
        key: Key of `TABLE`.
        where: What has it, such as `joints.elbow`.
        detail: Numbers or names that the row's text leaves out.
    """

    key: str
    where: str
    detail: str = ""


_ONE_BODY = "the fact that the joints before and after it are joints of one body, with nothing between them"

TABLE: dict[str, dict[Format, LossRow]] = {
    # --- joints
    "fixed": {
        "urdf": LossRow("a fixed joint"),
        "mjcf": LossRow("a body without joint inside its parent"),
        "sdf": LossRow("a fixed joint"),
        "usd": LossRow("a fixed joint"),
    },
    "revolute": {
        "urdf": LossRow("a revolute joint"),
        "mjcf": LossRow("a hinge"),
        "sdf": LossRow("a revolute joint"),
        "usd": LossRow("a revolute joint"),
    },
    "revolute.endless": {
        "urdf": LossRow("a continuous joint"),
        "mjcf": LossRow("a hinge without range"),
        "sdf": LossRow("a continuous joint"),
        "usd": LossRow("a revolute joint without limits"),
    },
    "slider": {
        "urdf": LossRow("a prismatic joint"),
        "mjcf": LossRow("a slide joint"),
        "sdf": LossRow("a prismatic joint"),
        "usd": LossRow("a prismatic joint"),
    },
    "cylindrical": {
        "urdf": LossRow("a prismatic joint, a carrier link and a revolute joint"),
        "mjcf": LossRow("a slide and a hinge on one body"),
        "sdf": LossRow("a prismatic joint, a carrier link and a revolute joint"),
        "usd": LossRow("a generic joint that slides along and turns about z"),
    },
    "ball": {
        "urdf": LossRow(
            "three revolute joints about x, y, z with two carrier links",
            "the cone becomes a box about x and y that contains it, and the twist's range is widened to contain the declared one",
            refused=True,
        ),
        "mjcf": LossRow("a ball joint", "cone and twist become one limit on the total angle, which contains them", refused=True),
        "sdf": LossRow("a ball joint", "cone and twist: a ball of SDFormat has no limits", refused=True),
        "usd": LossRow("a spherical joint with a cone", "the range of its twist"),
    },
    "ball.free": {
        "urdf": LossRow("three revolute joints about x, y, z with two carrier links"),
        "mjcf": LossRow("a ball joint"),
        "sdf": LossRow("a ball joint"),
        "usd": LossRow("a spherical joint"),
    },
    "ball.wide": {
        "urdf": LossRow(
            "three revolute joints about x, y, z with two carrier links",
            "the cone reaches 85° or more: where the second angle is ±90° the first and the third axis are the same (gimbal lock)",
            refused=True,
        ),
        "mjcf": LossRow("a ball joint"),
        "sdf": LossRow("a ball joint", "cone and twist: a ball of SDFormat has no limits", refused=True),
        "usd": LossRow("a spherical joint with a cone", "the range of its twist"),
    },
    "screw": {
        "urdf": LossRow(
            "a prismatic joint that mimics a revolute joint, with a carrier link",
            "in readers that ignore <mimic>, the two move independently",
        ),
        "mjcf": LossRow("a slide and a hinge on one body, tied by an equality of joints"),
        "sdf": LossRow("a screw joint"),
        "usd": LossRow("a generic joint that slides along and turns about z", "the lead: the two move independently", refused=True),
    },
    "planar": {
        "urdf": LossRow("two prismatic joints and a revolute joint, with two carrier links"),
        "mjcf": LossRow("two slides and a hinge on one body"),
        "sdf": LossRow("two prismatic joints and a revolute joint, with two carrier links"),
        "usd": LossRow("a generic joint that slides along x and y and turns about z"),
    },
    "universal": {
        "urdf": LossRow("two revolute joints with a carrier link"),
        "mjcf": LossRow("two hinges on one body"),
        "sdf": LossRow("a universal joint"),
        "usd": LossRow("a generic joint that turns about x and y"),
    },
    "free": {
        "urdf": LossRow("a floating joint"),
        "mjcf": LossRow("a freejoint on a body of the world"),
        "sdf": LossRow("a link without a joint, posed at rest"),
        "usd": LossRow("a body without a joint, the root of its own articulation"),
    },
    "free.nested": {
        "urdf": LossRow("a floating joint"),
        "mjcf": LossRow(
            "a freejoint on a body of the world", "the part from which its values are measured: they are measured from the world"
        ),
        "sdf": LossRow("a link without a joint, posed at rest"),
        "usd": LossRow("a body without a joint, the root of its own articulation"),
    },
    "free.rest": {
        "urdf": LossRow("a floating joint with zero where its frames coincide", "the rest value"),
        "mjcf": LossRow("the key at rest"),
        "sdf": LossRow("a link without a joint, posed at rest"),
        "usd": LossRow("a body without a joint, posed at rest"),
    },
    "loop.free": {name: LossRow("nothing: other joints impose its constraints already") for name in MECHANISM_FORMATS},
    "limits.open": {
        "urdf": LossRow("a far limit, 1e6 rad or 1000 m away", "the joint is endless in that direction"),
        "mjcf": LossRow("a far limit, 1e6 rad or 1000 m away", "the joint is endless in that direction"),
        "sdf": LossRow("a limit in one direction only"),
        "usd": LossRow("one infinite limit"),
    },
    "slide.endless": {
        "urdf": LossRow("limits of ±1000 m", "the slide is endless"),
        "mjcf": LossRow("a slide joint without range"),
        "sdf": LossRow("a prismatic joint without limits"),
        "usd": LossRow("infinite limits"),
    },
    "velocity": {
        "urdf": LossRow("the velocity of <limit>"),
        "mjcf": LossRow("metadata", "MJCF has no limit on a joint's velocity"),
        "sdf": LossRow("the velocity of <limit>"),
        "usd": LossRow("the velocity limits of NewtonJointAPI and PhysxJointAPI"),
    },
    "joint.damping": {
        "urdf": LossRow("the damping of <dynamics>"),
        "mjcf": LossRow("the damping of the joint"),
        "sdf": LossRow("the damping of <dynamics>"),
        "usd": LossRow("the damping of NewtonJointAPI"),
    },
    "joint.friction": {
        "urdf": LossRow("the friction of <dynamics>"),
        "mjcf": LossRow("the frictionloss of the joint"),
        "sdf": LossRow("the friction of <dynamics>"),
        "usd": LossRow("the friction of NewtonJointAPI"),
    },
    "effort.assumed": {
        name: LossRow("effort and velocity that carry the load", "the fact that the file states none; this format requires them")
        for name in MECHANISM_FORMATS
    },
    "rest.assumed": {
        "urdf": LossRow("metadata"),
        "mjcf": LossRow("the key home, at rest", "the fact that the file states no such pose: zero is outside of its limits"),
        "sdf": LossRow("metadata"),
        "usd": LossRow("bodies that are posed at rest"),
    },
    "chain.carriers": {
        "urdf": LossRow(
            "a chain of joints over carrier links", "the fact that it is one joint; its carriers take a small share of the part's mass"
        ),
        "mjcf": LossRow("joints of one body"),
        "sdf": LossRow("a joint, or a chain of joints"),
        "usd": LossRow("a joint"),
    },
    "chain.step": {
        "urdf": LossRow("a link of 1e-4 kg", _ONE_BODY),
        "mjcf": LossRow("a body of 1e-4 kg", _ONE_BODY),
        "sdf": LossRow("a link of 1e-4 kg", _ONE_BODY),
        "usd": LossRow("a body of 1e-4 kg", _ONE_BODY),
    },
    "contact.joined": {
        "urdf": LossRow("collision meshes"),
        "mjcf": LossRow("an excluded pair", "contacts between two parts that a joint connects: MuJoCo lets a body touch what stands still"),
        "sdf": LossRow("collision meshes"),
        "usd": LossRow("shapes to collide with"),
    },
    "effort.zero": {
        "urdf": LossRow("an effort of zero"),
        "mjcf": LossRow("no actuatorfrcrange", "the fact that no force may drive the joint: MuJoCo reads an empty range as unlimited"),
        "sdf": LossRow("an effort of zero"),
        "usd": LossRow("nothing", "efforts"),
    },
    # --- loops and couplings
    "loop": {
        "urdf": LossRow("metadata", "URDF holds trees only: this joint is left out and its loop is open", refused=True),
        "mjcf": LossRow("equality constraints between sites"),
        "sdf": LossRow("a joint like any other"),
        "usd": LossRow("a joint that is excluded from the articulation"),
    },
    "loop.points": {
        "urdf": LossRow("points that two links share", "only the chosen reader closes the loop, and the closing joint has no limits there"),
        "mjcf": LossRow("equality constraints between sites"),
        "sdf": LossRow("a joint like any other"),
        "usd": LossRow("a joint that is excluded from the articulation"),
    },
    "loop.mimic": {
        "urdf": LossRow("<mimic> of the driver", "readers that ignore <mimic> open the loop"),
        "mjcf": LossRow("equality constraints between sites"),
        "sdf": LossRow("a joint like any other"),
        "usd": LossRow("a joint that is excluded from the articulation"),
    },
    "loop.ball": {
        "urdf": LossRow("metadata"),
        "mjcf": LossRow("an equality of two points", "the cone and twist of a ball that closes a loop", refused=True),
        "sdf": LossRow("a ball joint", "cone and twist: a ball of SDFormat has no limits", refused=True),
        "usd": LossRow("a spherical joint with a cone", "the range of its twist"),
    },
    "coupling": {
        "urdf": LossRow("<mimic>", "readers that ignore <mimic> let the joints move on their own"),
        "mjcf": LossRow("an equality of joints"),
        "sdf": LossRow("<mimic>", "readers that ignore <mimic> let the joints move on their own"),
        "usd": LossRow("nothing", "NewtonMimicAPI couples single joints of one kind only: the joints move independently", refused=True),
    },
    "coupling.loop": {
        "urdf": LossRow(
            "metadata", "the coupling: it names a joint that closes a loop, or couples joints that are already coupled", refused=True
        ),
        "mjcf": LossRow("an equality of joints"),
        "sdf": LossRow(
            "metadata", "the coupling: it names a joint that closes a loop, or couples joints that are already coupled", refused=True
        ),
        "usd": LossRow("nothing", "the coupling: the joints move independently", refused=True),
    },
    "loop.rest": {
        "urdf": LossRow("the tree with all values at zero"),
        "mjcf": LossRow("a key at rest"),
        "sdf": LossRow("a model posed at rest", "values are measured from rest, where the loops are closed, not from zero"),
        "usd": LossRow("bodies posed at rest"),
    },
    "loop.chain": {
        "urdf": LossRow("metadata"),
        "mjcf": LossRow("equality constraints between sites"),
        "sdf": LossRow("metadata", "SDFormat has no joint of this kind, and a chain cannot close a loop: it is left out", refused=True),
        "usd": LossRow("a generic joint that is excluded from the articulation"),
    },
    # --- what formats of shapes make of motion and mass
    "motion": {
        "glb": LossRow("an animation of every driver", "joints and their limits: glTF has none", refused=True),
        "3mf": LossRow("parts one by one", "joints and limits: 3MF has none", refused=True),
        "step": LossRow("parts placed as they rest", "joints and limits: STEP readers know none", refused=True),
    },
    "mass": {
        "glb": LossRow("nothing", "mass and inertia: glTF has none"),
        "3mf": LossRow("nothing", "mass and inertia: 3MF has none"),
        "step": LossRow("a solid without density", "mass and inertia"),
    },
    "brep.missing": {
        "step": LossRow("a plane face for each triangle of its mesh", "smooth faces: the part has a mesh and no B-rep"),
    },
    # --- parts
    "link.frame": {
        name: LossRow("a frame on the joint", "the original frame of the link: the joint does not pass through its origin")
        for name in MECHANISM_FORMATS
    }
    | {"sdf": LossRow("its own frame, in which the joint is posed")},
    "root.frame": {
        name: LossRow("the frame of the world", "the frame of the ground part: the root link stands in the world's frame")
        for name in MECHANISM_FORMATS
    },
    "shape.primitive": {
        "urdf": LossRow("a mesh", "the primitive: URDF 1.0 does not have it"),
        "mjcf": LossRow("a geom of that kind"),
        "sdf": LossRow("a body of that kind"),
        "usd": LossRow("a mesh", "the primitive type"),
    },
    "mass.missing": {
        "urdf": LossRow("1e-4 kg", "the mass of a moving part is not known", refused=True),
        "mjcf": LossRow("1e-4 kg", "the mass of a moving part is not known", refused=True),
        "sdf": LossRow("1e-4 kg", "the mass of a moving part is not known", refused=True),
        "usd": LossRow("1e-4 kg", "the mass of a moving part is not known", refused=True),
    },
    "mass.impossible": {
        name: LossRow(
            "the nearest inertia that is physically possible",
            "the inertia as given, which is physically impossible and which engines refuse",
            refused=True,
        )
        for name in MECHANISM_FORMATS
    },
    "shape.flat": {
        name: LossRow("a collision hull 1 mm thick", "a surface without thickness, with which engines cannot collide")
        for name in MECHANISM_FORMATS
    },
    "shape.missing": {
        "urdf": LossRow("a link without shapes"),
        "mjcf": LossRow("a body without geoms"),
        "sdf": LossRow("a link without shapes"),
        "usd": LossRow("a body without meshes"),
        "step": LossRow("nothing", "its position and name: the part has no shape"),
        "glb": LossRow("a node without a mesh"),
        "3mf": LossRow("nothing", "the part: it has no shape, so there is nothing to print"),
    },
    "hull": {
        "urdf": LossRow(
            "collision meshes",
            "readers that collide with convex hulls (MuJoCo, PyBullet) see these two parts overlap at rest or in motion, and URDF cannot exclude the pair",
        ),
        "mjcf": LossRow(
            "an excluded pair",
            "MuJoCo collides with convex hulls; those of these two parts overlap at rest or in motion, so they do not collide at all",
        ),
        "sdf": LossRow("collision meshes"),
        "usd": LossRow("convex hulls for collision"),
    },
    "collision.hull": {
        name: LossRow("a convex hull for collision", "dents, holes and slots of the part: other bodies cannot enter them", refused=True)
        for name in MECHANISM_FORMATS
    },
    "collision.pieces": {
        name: LossRow("convex pieces inside the solid for collision", "what the pieces leave out of the solid")
        for name in MECHANISM_FORMATS
    },
    "collision.open": {
        name: LossRow("its mesh for collision, which engines replace by its hull", "convex pieces: the surface encloses no volume")
        for name in MECHANISM_FORMATS
    },
    "color": {
        "urdf": LossRow("<material>"),
        "mjcf": LossRow("a material"),
        "sdf": LossRow("a material"),
        "usd": LossRow("a material and displayColor"),
    },
    "friction": {
        "urdf": LossRow("metadata", "URDF has no friction between surfaces: readers use their own"),
        "mjcf": LossRow("the geoms' friction"),
        "sdf": LossRow("friction of the collision's surface"),
        "usd": LossRow("PhysicsMaterialAPI"),
    },
    "connector": {
        "urdf": LossRow("metadata"),
        "mjcf": LossRow("a site"),
        "sdf": LossRow("metadata"),
        "usd": LossRow("nothing", "connectors that no joint uses"),
    },
    "fit": {
        "urdf": LossRow("metadata"),
        "mjcf": LossRow("metadata"),
        "sdf": LossRow("metadata"),
        "usd": LossRow("nothing", "fits"),
    },
    "fastening": {
        "urdf": LossRow("metadata"),
        "mjcf": LossRow("metadata"),
        "sdf": LossRow("metadata"),
        "usd": LossRow("nothing", "how parts are fastened"),
    },
    "name": {
        "urdf": LossRow("a name of letters, digits and underscores", "the name as given, which is kept in the metadata"),
        "mjcf": LossRow("a name of letters, digits and underscores", "the name as given, which is kept in the metadata"),
        "sdf": LossRow("a name of letters, digits and underscores", "the name as given, which is kept in the metadata"),
        "usd": LossRow("a name of letters, digits and underscores", "the name as given"),
    },
}


# Rows that USD and its extensions can express for some joints only.
TABLE["coupling.mimic"] = TABLE["coupling"] | {
    "usd": LossRow("NewtonMimicAPI", "readers that do not know NewtonMimicAPI let the joints move on their own")
}
for _key, _lost in {"velocity": "velocity limits", "joint.damping": "damping", "joint.friction": "friction"}.items():
    _row = LossRow("nothing", f"{_lost} of a joint of several freedoms: NewtonJointAPI has one number for all of them")
    TABLE[f"{_key}.several"] = TABLE[_key] | {"usd": _row}

_BALL = LossRow("a ball joint", "its cone and twist: a ball of FreeCAD has no limits")
_FREECAD: dict[str, LossRow] = {
    "fixed": LossRow("a fixed joint"),
    "revolute": LossRow("a revolute joint with its limits"),
    "revolute.endless": LossRow("a revolute joint without limits"),
    "slider": LossRow("a slider joint with its limits"),
    "cylindrical": LossRow("a cylindrical joint with its limits"),
    "ball": _BALL,
    "ball.free": LossRow("a ball joint"),
    "ball.wide": _BALL,
    "screw": LossRow("a cylindrical joint and a thread", "FreeCAD's solver does not enforce the lead", refused=True),
    "planar": LossRow("a distance of zero between two planes", "its limits"),
    "universal": LossRow("a ball and a perpendicular joint", "its two limits", refused=True),
    "free": LossRow("no joint: its part is loose", "the joint, except in articad's record"),
    "loop.free": LossRow("no joint: it constrains nothing", "the joint, except in articad's record"),
    "limits.open": LossRow("a limit in one direction only"),
    "slide.endless": LossRow("a joint without that limit"),
    "velocity": LossRow("a record", "FreeCAD has no limit on a joint's velocity"),
    "joint.damping": LossRow("a record", "damping: FreeCAD has none"),
    "joint.friction": LossRow("a record", "friction in joints: FreeCAD has none"),
    "coupling": LossRow("a suppressed joint of the same kind", "FreeCAD's solver does not enforce it", refused=True),
    "fit": LossRow("a record", "fits: FreeCAD has none"),
    "fastening": LossRow("a record", "how parts are fastened: FreeCAD has no such property"),
    "freecad.coupling": LossRow("a record", "FreeCAD has no such coupling", refused=True),
    "freecad.features": LossRow("its B-rep", "its features: it follows no parameter; write with FreeCAD to keep them"),
    "freecad.brep": LossRow("its B-rep", "editable features: it follows no parameter; build with the FreeCAD kernel to get them"),
    "freecad.dimension": LossRow("a fixed number", "the dimension's link to its features"),
    "freecad.placement": LossRow("a fixed placement", "the link of its placement to parameters: FreeCAD's solver places it after an edit"),
    "freecad.mesh": LossRow("a mesh", "coordinates beyond single precision, and an editable solid"),
    "freecad.frame": LossRow("a fixed frame", "the link to parameters"),
    "freecad.direction": LossRow(
        "a fixed direction", "the link of its direction to parameters: its x is chosen by rule, or it is a mirror image"
    ),
}
"""How a FreeCAD document represents each feature for FreeCAD itself; its records hold the rest."""

_PLAN: dict[str, LossRow] = {
    "mass.missing": LossRow("a density of 1000 kg/m³", "the mass of a moving part is not known", refused=True),
    "name": LossRow("a name of lower-case words", "the name as given"),
    "joint.damping": LossRow("nothing", "damping: a plan has none, and exports compute it"),
    "joint.friction": LossRow("nothing", "friction in joints: a plan has none"),
    "plan.shape": LossRow(
        "the sides of each part's bounding box", "the shapes: a plan states what to build, and scripts build it", refused=True
    ),
    "plan.mass": LossRow("a material whose density gives its mass", "centre of mass and inertia if they differ from those of a solid"),
    "plan.density": LossRow("a density of 1000 kg/m³", "its mass: its shape encloses no volume", refused=True),
    "plan.rest": LossRow("a rest at zero", "the rest value of the joint: ball, planar, universal and free joints of a plan rest at zero"),
    "plan.endless": LossRow(
        "a far limit, 1e6 mm or 100 turns away",
        "the fact that the coordinate is endless; in a plan only revolute and cylindrical joints can be",
    ),
    "plan.capacity": LossRow("the first effort or velocity", "the others: a plan states one for rotation and one for translation"),
}
"""Features that a plan cannot represent exactly; it was designed for all others."""

TABLE |= {key: {} for key in (*_FREECAD, *_PLAN) if key not in TABLE}
for _key, _row in _FREECAD.items():
    TABLE[_key]["freecad"] = _row
for _key, _rows in TABLE.items():
    if _key in _PLAN or (
        "urdf" in _rows
        and not _key.startswith(
            (
                "hull",
                "collision",
                "limits",
                "slide.",
                "loop.points",
                "loop.mimic",
                "loop.rest",
                "free.",
                "effort.",
                "chain.",
                "rest.",
                "contact.",
                "link.frame",
                "root.frame",
                "shape.primitive",
            )
        )
    ):
        _rows["plan"] = _PLAN.get(_key, LossRow("the same"))


def losses_of(format_name: Format, features: Iterable[Feature]) -> tuple[Loss, ...]:
    """Return the losses that these features have in a format, in order, each once."""
    losses: dict[Loss, None] = {}
    for feature in features:
        row = TABLE[feature.key][format_name]
        if row.lost:
            kept = f"{row.becomes} ({feature.detail})" if feature.detail else row.becomes
            losses[Loss(format_name, feature.where, kept, row.lost, row.refused)] = None
    return tuple(losses)


def kept_losses(format_name: Format, kept: Iterable[Kept], written: Container[Kept] = ()) -> tuple[Loss, ...]:
    """Return a loss for everything that the file said beyond the assembly and that is not written, one for the shapes of each part."""
    lost: dict[tuple[str, str], list[str]] = {}
    for item in kept:
        if item.what and item not in written:
            shape = _SHAPE.match(item.where)
            lost.setdefault((shape[1], "shapes") if shape else (item.where, item.what), []).append(item.what)
    return tuple(Loss(format_name, where, "nothing", "; ".join(dict.fromkeys(said)), refused=False) for (where, _), said in lost.items())


def assumed_finding(joints: Iterable[str]) -> list[Finding]:
    """Return the finding that lists joints whose effort, velocity or damping is computed because it is not stated; equal for all formats."""
    names = list(dict.fromkeys(joints))
    if not names:
        return []
    listed = ", ".join(names[:8]) + (f" and {len(names) - 8} others" if len(names) > 8 else "")
    message = f"Effort, velocity or damping of {listed} are not stated; exports have values computed from mass, gravity and the worst pose."
    hint = "State them where the drives are known."
    return [Finding(code="I_EFFORT_ASSUMED", where="joints", message=message, hint=hint, stage="export")]


def refuse(losses: Iterable[Loss]) -> None:
    """Raise on the first loss that changes motion, mass or shape, naming all of them.

    Raises:
        UnrepresentableError: If there is one.
    """
    refused = [loss for loss in losses if loss.refused]
    if not refused:
        return
    findings = [
        Finding(
            code="E_UNREPRESENTABLE",
            where=loss.where,
            message=f"{loss.format}: {loss.lost}.",
            hint=f"Without strict it becomes {loss.kept}.",
        )
        for loss in refused
    ]
    first = refused[0]
    raise UnrepresentableError(first.where, first.format, first.lost, findings=findings)
