"""USD with UsdPhysics, as text: rigid bodies at rest, joints between frames on them, loops excluded from the articulation."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from articad.arrays import FloatArray
from articad.connectors.mate import flip
from articad.connectors.se3 import SE3
from articad.export.bundle import Bundle
from articad.export.collisions import Collision, kind_of, shape_model
from articad.export.features import features_of, primitive_features, solid_enough
from articad.export.inertia import Inertial, is_possible
from articad.export.losses import Feature, kept_losses, losses_of, refuse
from articad.export.lowering import lower
from articad.export.markup import number
from articad.export.meshes import built_meshes, drawn
from articad.export.names import Names, valid_name
from articad.geometry.mass import MassProperties
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Part, Shape
from articad.kernels.cache import BuildCache
from articad.kinematics.joints import Joint, JointType

if TYPE_CHECKING:
    from articad.assembly import Assembly


MM_PER_M = 1000.0
_WHOLE = re.compile(r"\.0(?=[,\]])")  # of numbers in JSON
CARRIER_MASS_KG = 1e-4  # of a moving part without known mass
_PRIMS = {
    JointType.FIXED: "PhysicsFixedJoint",
    JointType.REVOLUTE: "PhysicsRevoluteJoint",
    JointType.SLIDER: "PhysicsPrismaticJoint",
    JointType.BALL: "PhysicsSphericalJoint",
}
_ROOT = '"PhysicsArticulationRootAPI"'
_DEGREES = ("transX", "transY", "transZ", "rotX", "rotY", "rotZ")


def write_usd(assembly: Assembly, *, strict: bool = False, collision: Collision | None = None, cache: BuildCache | None = None) -> Bundle:
    """Write an assembly as one `.usda` file in metres, z-up, with meshes inside.

    Bodies keep the parts' own frames and are posed at rest. A joint's two local frames coincide where its values are zero, so limits
    equal articad's, in degrees and metres. Cylindrical, planar, universal and screw joints become generic joints with their other
    degrees locked.

    Args:
        assembly: What to write.
        strict: Refuse what USD holds only with a loss of motion, mass or shape.
        collision: Collide with convex pieces inside the parts ("pieces"), with the parts' own meshes ("solid"), or with hulls ("hull").
            By default pieces; for a file that articad did not write, its own shapes.
        cache: Stores convex pieces by shape; the cache of built parts by default.

    Returns:
        `<name>.usda` and the losses.

    Raises:
        UnrepresentableError: If `strict` and there is such a loss.
    """
    links, joints = Names(), Names()
    root = valid_name(assembly.name)
    bodies = {name: links.claim(name) for name in assembly.parts}
    names = {joint.name: joints.claim(joint.name) for joint in assembly.joints}
    kind = kind_of(assembly, collision)
    model = shape_model(assembly, replace(lower(assembly), features=()), kind, cache)
    colliding = {link.part.name: tuple(placed.shape for placed in link.collisions) or solid_enough(link.part) for link in model.links}
    features = (*features_of(assembly), *model.features, *_name_features(assembly, bodies, names), *primitive_features(assembly))
    losses = (*losses_of("usd", features), *kept_losses("usd", assembly.kept))
    if strict:
        refuse(losses)
    rest = assembly.mechanism.rest_poses()
    closing = {joint.name for joint in assembly.mechanism.loop_joints}
    lines = [_HEADER.format(root=root)]
    free = {joint.child for joint in assembly.joints if joint.type is JointType.FREE and joint.name not in closing}
    lines.append(f'def Xform "{root}"\n{{' if free else f'def Xform "{root}" (\n    prepend apiSchemas = [{_ROOT}]\n)\n{{')
    for name, part in assembly.parts.items():
        schemas = (_ROOT,) if name in free else ()
        lines += _indented(_body(part, bodies[name], rest[name], colliding[name], schemas, draws=kind != "solid"))
    lines += _indented(['def Scope "joints"', "{"])
    ground = f"</{root}/{bodies[assembly.ground]}>"
    held = [_ROOT] if free else []  # roots of articulations may not be nested, so each is on a prim of its own
    lines += _indented(_joint_prim("PhysicsFixedJoint", "to_world", (None, ground), (rest[assembly.ground], SE3.identity()), [], held), 2)
    for joint in assembly.joints:
        if joint.type is JointType.FREE:
            continue
        ends = (f"</{root}/{bodies[joint.parent]}>", f"</{root}/{bodies[joint.child]}>")
        lines += _indented(_joint(joint, names[joint.name], ends, closes=joint.name in closing), 2)
    lines += ["    }", "}"]
    return Bundle({f"{root}.usda": ("\n".join(lines) + "\n").encode("ascii")}, losses)


_HEADER = """#usda 1.0
(
    defaultPrim = "{root}"
    kilogramsPerUnit = 1
    metersPerUnit = 1
    upAxis = "Z"
)
"""


def _body(part: Part, name: str, T: SE3, collisions: tuple[Shape, ...], schemas: Iterable[str] = (), *, draws: bool) -> list[str]:
    """Return a rigid body with its meshes; visual meshes of a built part are simplified."""
    listed = ", ".join(['"PhysicsRigidBodyAPI"', '"PhysicsMassAPI"', *schemas])
    mass = part.mass if part.mass is not None and part.mass.mass > 0 else None
    lines = [
        f'def Xform "{name}" (',
        f"    prepend apiSchemas = [{listed}]",
        ")",
        "{",
        *_indented(_mass(mass)),
        f"    double3 xformOp:translate = {_tuple(T.translation / MM_PER_M)}",
        f"    quatd xformOp:orient = {_quaternion(T)}",
        '    uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:orient"]',
    ]
    visuals = part.visuals or part.collisions
    built = built_meshes([part]) if draws else {}
    looks = {id(one): replace(one, mesh=drawn(built[one.mesh.digest]).mesh) if one.mesh.digest in built else one for one in visuals}
    surfaces = {id(one): one for one in collisions if _form(one) is None} | looks
    written = {key: _surface(one.placed) for key, one in surfaces.items()}  # a visual shape may also be a collision shape
    for index, one in enumerate(visuals):
        lines += _indented(_mesh(f"visual_{index}", written[id(one)], one.color or part.color))
    for index, one in enumerate(collisions):
        lines += _indented(_form(one, f"collision_{index}") or _mesh(f"collision_{index}", written[id(one)], None))
    return [*lines, "}"]


def _mass(mass: MassProperties | None) -> list[str]:
    if mass is None:
        return [f"float physics:mass = {number(CARRIER_MASS_KG)}"]
    inertia = mass.inertia
    if not is_possible(mass.mass, inertia / MM_PER_M**2):
        inertia = Inertial(mass.mass, mass.com / MM_PER_M, inertia / MM_PER_M**2).possible().inertia * MM_PER_M**2
    moments, axes = np.linalg.eigh(inertia)
    if np.linalg.det(axes) < 0:
        axes = axes * [1.0, 1.0, -1.0]
    return [
        f"float physics:mass = {number(mass.mass)}",
        f"point3f physics:centerOfMass = {_tuple(mass.com / MM_PER_M)}",
        f"float3 physics:diagonalInertia = {_tuple(moments / MM_PER_M**2)}",
        f"quatf physics:principalAxes = {_quaternion(SE3.from_rotation(axes))}",
    ]


def _form(shape: Shape, name: str = "") -> list[str] | None:
    """Return a primitive for collision, None if USD has none or the shape is a mesh."""
    form, T = shape.primitive, shape.frame
    if form is None or form.kind not in {"box", "sphere", "cylinder", "capsule"}:
        return None
    sizes = [size / MM_PER_M for size in form.size]
    r, order = number(sizes[0]), '"xformOp:translate", "xformOp:orient"'
    prims = {
        "box": ("Cube", ["double size = 1", f"float3 xformOp:scale = {_tuple(sizes)}"]),
        "sphere": ("Sphere", [f"double radius = {r}"]),
        "cylinder": ("Cylinder", ['uniform token axis = "Z"', f"double radius = {r}", f"double height = {number(sizes[-1])}"]),
        "capsule": ("Capsule", ['uniform token axis = "Z"', f"double radius = {r}", f"double height = {number(sizes[-1])}"]),
    }
    prim, fields = prims[form.kind]
    order += ', "xformOp:scale"' if form.kind == "box" else ""
    return [
        f'def {prim} "{name}" (',
        '    prepend apiSchemas = ["PhysicsCollisionAPI"]',
        ")",
        "{",
        *_indented(fields),
        f"    double3 xformOp:translate = {_tuple(T.translation / MM_PER_M)}",
        f"    quatd xformOp:orient = {_quaternion(T)}",
        f"    uniform token[] xformOpOrder = [{order}]",
        '    uniform token purpose = "guide"',
        "}",
    ]


def _surface(mesh: TriMesh) -> list[str]:
    """Return the triangles of a mesh."""
    return [
        f"    int[] faceVertexCounts = [{', '.join('3' * len(mesh.triangles))}]",
        f"    int[] faceVertexIndices = [{', '.join(map(str, mesh.triangles.ravel().tolist()))}]",
        f"    point3f[] points = {_points(mesh.vertices / MM_PER_M)}",
    ]


def _mesh(name: str, surface: list[str], color: str | None) -> list[str]:
    """Return a mesh: drawn in a colour, or for collision by its convex hull."""
    lines = [f'def Mesh "{name}"'] if color is not None else [
        f'def Mesh "{name}" (',
        '    prepend apiSchemas = ["PhysicsCollisionAPI", "PhysicsMeshCollisionAPI"]',
        ")",
    ]  # fmt: skip
    lines += ["{", *surface, '    uniform token subdivisionScheme = "none"']
    if color is None:
        lines += ['    uniform token physics:approximation = "convexHull"', '    uniform token purpose = "guide"']
    else:
        lines.append(f"    color3f[] primvars:displayColor = [{_tuple(_linear(color))}]")
    return [*lines, "}"]


def _joint(joint: Joint, name: str, ends: tuple[str, str], *, closes: bool) -> list[str]:
    """Return a joint; its frame on the child includes the mate's flip, so that both coincide at zero."""
    frames = (joint.T_parent_connector, joint.T_child_connector @ flip(joint.mate))
    extra = ["bool physics:excludeFromArticulation = true"] if closes else []
    kind = _PRIMS.get(joint.type)
    if kind is None:
        return _generic(joint, name, ends, frames, extra)
    if joint.type is not JointType.FIXED:
        extra.append('uniform token physics:axis = "Z"')
    if joint.type is JointType.BALL:
        cone = joint.limits.cone
        if cone is not None and cone < math.pi:
            extra += [f"float physics:coneAngle{i}Limit = {number(math.degrees(cone))}" for i in (0, 1)]
    for *bounds, unit in zip(joint.limits.lower, joint.limits.upper, joint.type.units, strict=False):
        low, high = (_in_usd(bound, unit) for bound in bounds)
        extra += [f"float physics:lowerLimit = {low}", f"float physics:upperLimit = {high}"]
    return _joint_prim(kind, name, ends, frames, extra)


def _generic(joint: Joint, name: str, ends: tuple[str, str], frames: tuple[SE3, SE3], extra: list[str]) -> list[str]:
    """Return a generic joint whose other degrees are locked by a lower limit above the upper one."""
    schemas, limits = [], []
    free = {f"{'trans' if step.kind == 'slide' else 'rot'}{'XYZ'[step.axis]}": step for step in joint.type.steps}
    for degree in _DEGREES:
        step = free.get(degree)
        if step is None:
            low, high = "1", "-1"
        elif step.advances:  # it follows another
            continue
        else:
            at = step.coordinate or 0
            low, high = (_in_usd(bounds[at], joint.type.units[at]) for bounds in (joint.limits.lower, joint.limits.upper))
        schemas.append(f'"PhysicsLimitAPI:{degree}"')
        limits += [f"float limit:{degree}:physics:low = {low}", f"float limit:{degree}:physics:high = {high}"]
    return _joint_prim("PhysicsJoint", name, ends, frames, [*extra, *limits], schemas)


def _joint_prim(
    kind: str, name: str, ends: tuple[str | None, str], frames: tuple[SE3, SE3], extra: list[str], schemas: Iterable[str] = ()
) -> list[str]:
    listed = ", ".join(schemas)
    head = [f'def {kind} "{name}" (', f"    prepend apiSchemas = [{listed}]", ")"] if listed else [f'def {kind} "{name}"']
    relations = [f"rel physics:body{i} = {end}" for i, end in enumerate(ends) if end is not None]
    places = [
        line
        for i, T in enumerate(frames)
        for line in (f"point3f physics:localPos{i} = {_tuple(T.translation / MM_PER_M)}", f"quatf physics:localRot{i} = {_quaternion(T)}")
    ]
    return [*head, "{", *_indented([*relations, *places, *extra]), "}"]


def _in_usd(bound: float, unit: str) -> str:
    """Return a limit in degrees or m; infinite ones are a keyword of the format."""
    if math.isinf(bound):
        return "inf" if bound > 0 else "-inf"
    return number(math.degrees(bound) if unit == "rad" else bound / MM_PER_M)


def _points(points: FloatArray) -> str:
    """Return rows of numbers formatted as by `number`, but much faster for many."""
    text = json.dumps((points + 0.0).tolist())
    return "[" + _WHOLE.sub("", text[1:-1]).replace("[", "(").replace("]", ")") + "]"


def _tuple(values: Iterable[float]) -> str:
    return "(" + ", ".join(number(value) for value in values) + ")"


def _quaternion(T: SE3) -> str:
    x, y, z, w = T.quaternion
    return _tuple([w, x, y, z])


def _linear(color: str) -> list[float]:
    """Convert "#rrggbb" (sRGB) to the linear colour of USD."""
    channels = [int(color[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    return [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]


def _indented(lines: Iterable[str], levels: int = 1) -> list[str]:
    return ["    " * levels + line for line in lines]


def _name_features(assembly: Assembly, bodies: dict[str, str], joints: dict[str, str]) -> list[Feature]:
    changed = [("parts", *item) for item in bodies.items()] + [("joints", *item) for item in joints.items()]
    features = [Feature("name", f"{kind}.{old}", new) for kind, old, new in changed if old != new]
    return features + ([Feature("name", "name", valid_name(assembly.name))] if valid_name(assembly.name) != assembly.name else [])
