"""USD with UsdPhysics, as text: rigid bodies at rest, joints between frames on them, loops excluded from the articulation."""

from __future__ import annotations

import json
import math
import re
from collections import Counter
from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from articad.arrays import FloatArray
from articad.connectors.mate import flip
from articad.connectors.se3 import SE3
from articad.export.bundle import Bundle
from articad.export.collisions import Collision, kind_of, shape_model
from articad.export.features import features_of, primitive_features, solid_enough
from articad.export.follow import followers, leaders
from articad.export.gltf import shaded
from articad.export.inertia import Inertial
from articad.export.losses import Feature, kept_losses, losses_of, refuse
from articad.export.lowering import Follows, LoweredModel, lower
from articad.export.markup import number, rounded, rounded_quaternion
from articad.export.meshes import drawn_shapes
from articad.export.names import Names, valid_name
from articad.export.product import of_the_product
from articad.geometry.mass import MassProperties
from articad.geometry.mesh import TriMesh, groups_of_equal
from articad.geometry.mesh_files import linear_color
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
_ABOUT_X = SE3.from_quaternion([1.0, 0.0, 0.0, 0.0])
_REVERSING = {  # half a turn about x reverses motions about and along z; J⁻¹ of the other types has another order of factors
    JointType.FIXED: SE3.identity(),
    JointType.BALL: SE3.identity(),
    JointType.REVOLUTE: _ABOUT_X,
    JointType.SLIDER: _ABOUT_X,
    JointType.CYLINDRICAL: _ABOUT_X,
    JointType.SCREW: _ABOUT_X,
}
_NORMAL_DIGITS = 4  # of the components of unit normals
_POINT_DIGITS = 8  # of coordinates in m: USD keeps points in single precision
_ROOT = '"PhysicsArticulationRootAPI"'
_DEGREES = ("transX", "transY", "transZ", "rotX", "rotY", "rotZ")


@of_the_product
def write_usd(assembly: Assembly, *, strict: bool = False, collision: Collision | None = None, cache: BuildCache | None = None) -> Bundle:
    """Write an assembly as one `.usda` file in metres, z-up, with meshes inside.

    Bodies keep the parts' own frames and are posed at rest. A joint's two local frames coincide where its values are zero, so limits
    equal articad's, in degrees and metres. Cylindrical, planar, universal and screw joints become generic joints with their other
    degrees locked.
    Couplings of joints of one kind are written as NewtonMimicAPI, velocity limits, damping and friction of joints as NewtonJointAPI (the
    velocity also as PhysxJointAPI), friction of surfaces as PhysicsMaterialAPI. Names of parts are labels of the class "class", names of
    materials of the class "material" (SemanticsLabelsAPI). A mesh that several shapes have is written once, as an abstract prim to which
    they refer.

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
    links, joints = Names(("joints", "materials", "meshes")), Names(("to_world",))
    root = valid_name(assembly.name)
    bodies = {name: links.claim(name) for name in assembly.parts}
    names = {joint.name: joints.claim(joint.name) for joint in assembly.joints}
    kind = kind_of(assembly, collision)
    model = shape_model(assembly, replace(lower(assembly), features=()), kind, cache)
    colliding = {link.part.name: tuple(placed.shape for placed in link.collisions) or solid_enough(link.part) for link in model.links}
    frictions = {link.part.name: link.friction for link in model.links}
    ties, tied = _mimics(assembly, model)
    features = (
        *_held(assembly, features_of(assembly), tied),
        *model.features,
        *_name_features(assembly, bodies, names),
        *primitive_features(assembly),
    )
    losses = (*losses_of("usd", features), *kept_losses("usd", assembly.kept))
    if strict:
        refuse(losses)
    rest = assembly.mechanism.rest_poses()
    closing = {joint.name for joint in assembly.mechanism.loop_joints}
    lines = [_HEADER.format(root=root)]
    materials = _Materials(f"/{root}/materials")
    free = {joint.child for joint in assembly.joints if joint.type is JointType.FREE and joint.name not in closing}
    lines.append(f'def Xform "{root}"\n{{' if free else f'def Xform "{root}" (\n    prepend apiSchemas = [{_ROOT}]\n)\n{{')
    texts = _Texts()
    shapes = {name: _Shapes.of(part, colliding[name], kind, texts, cache) for name, part in assembly.parts.items()}
    meshes = _Meshes(f"/{root}/meshes", shapes.values())
    for name, part in assembly.parts.items():
        schemas = (_ROOT,) if name in free else ()
        surface = materials.surface(frictions[name], part.material)
        lines += _indented(_body(part, bodies[name], rest[name], shapes[name], meshes, materials, surface, schemas))
    lines += _indented(meshes.prims())
    lines += _indented(materials.prims())
    lines += _indented(['def Scope "joints"', "{"])
    ground = f"</{root}/{bodies[assembly.ground]}>"
    held = [_ROOT] if free else []  # roots of articulations may not be nested, so each is on a prim of its own
    lines += _indented(_joint_prim("PhysicsFixedJoint", "to_world", (None, ground), (rest[assembly.ground], SE3.identity()), [], held), 2)
    backwards = {edge.joint.name for edge in assembly.mechanism.tree.edges if edge.reversed}
    for joint in assembly.joints:
        if joint.type is JointType.FREE:
            continue
        ends = (f"</{root}/{bodies[joint.parent]}>", f"</{root}/{bodies[joint.child]}>")
        more = [*_dynamics(joint), *_mimic(joint, ties.get(joint.name), names, root)]
        rows = _joint(joint, names[joint.name], ends, more, closes=joint.name in closing, backwards=joint.name in backwards)
        lines += _indented(rows, 2)
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


class _Shapes(NamedTuple):
    """The shapes of a part: what is drawn, what collides, and the triangles of those that are meshes, by identity of the shape."""

    visuals: tuple[Shape, ...]
    collisions: tuple[Shape, ...]
    drawn: dict[int, str]
    colliding: dict[int, str]

    @classmethod
    def of(cls, part: Part, collisions: tuple[Shape, ...], kind: Collision, texts: _Texts, cache: BuildCache | None) -> _Shapes:
        """Return the shapes; visual meshes of a built part are simplified, unless the part collides with its own meshes."""
        visuals = part.visuals or part.collisions
        looks = visuals if kind == "solid" else drawn_shapes(part, cache=cache)
        drawn = {id(one): texts.of(look, flat=False) for one, look in zip(visuals, looks, strict=True)}
        colliding = {id(one): texts.of(one, flat=True) for one in collisions if _form(one, "", None) is None}
        return cls(visuals, collisions, drawn, colliding)


class _Texts:
    """Triangles of shapes as text, made once for each mesh and frame."""

    def __init__(self) -> None:
        self._known: dict[tuple[str, bytes, bool], str] = {}

    def of(self, shape: Shape, *, flat: bool) -> str:
        """Return the triangles of a shape in its part's frame; see `_triangles`."""
        key = shape.mesh.digest, shape.frame.data.tobytes(), flat
        if key not in self._known:
            self._known[key] = _triangles(shape.placed, flat=flat)
        return self._known[key]


class _Meshes:
    """Triangles of meshes. What several shapes have is written once, as an abstract prim to which their prims refer."""

    def __init__(self, path: str, shapes: Iterable[_Shapes]) -> None:
        self._path = path
        counts = Counter(text for one in shapes for text in (*one.drawn.values(), *one.colliding.values()))
        self._names = {text: f"mesh_{index}" for index, text in enumerate(text for text, count in counts.items() if count > 1)}

    def head(self, text: str) -> list[str]:
        """Return the reference of a prim with these triangles, if there is one."""
        name = self._names.get(text)
        return [] if name is None else [f"    prepend references = <{self._path}/{name}>"]

    def fields(self, text: str) -> list[str]:
        """Return the triangles, unless the prim refers to them."""
        return [] if text in self._names else text.split("\n")

    def prims(self) -> list[str]:
        """Return the scope of the abstract prims."""
        if not self._names:
            return []
        rows = [row for text, name in self._names.items() for row in (f'def Mesh "{name}"', "{", *text.split("\n"), "}")]
        return ['class Scope "meshes"', "{", *_indented(rows), "}"]


class _Materials:
    """Visual materials by colour, and physical materials by coefficient of friction; both also by the material's name."""

    def __init__(self, path: str) -> None:
        self._path = path
        self._names = Names()
        self._colors: dict[tuple[str, str | None], str] = {}
        self._frictions: dict[tuple[float, str | None], str] = {}

    def look(self, color: str, material: str | None) -> str:
        """Return the path of the visual material of a colour."""
        key = color, material
        if key not in self._colors:
            self._colors[key] = self._names.claim("_".join(filter(None, (material, "color", color.removeprefix("#")))))
        return f"{self._path}/{self._colors[key]}"

    def surface(self, friction: float | None, material: str | None) -> str | None:
        """Return the path of the physical material of a coefficient of friction; None if it is not known."""
        if friction is None:
            return None
        key = friction, material
        if key not in self._frictions:
            self._frictions[key] = self._names.claim("_".join(filter(None, (material, "friction", number(friction)))))
        return f"{self._path}/{self._frictions[key]}"

    def prims(self) -> list[str]:
        """Return the scope that holds them."""
        lines = ['def Scope "materials"', "{"]
        for (color, material), name in self._colors.items():
            shader = f"{self._path}/{name}/surface"
            lines += _indented([
                *_material(name, material),
                f"    token outputs:surface.connect = <{shader}.outputs:surface>",
                '    def Shader "surface"',
                "    {",
                '        uniform token info:id = "UsdPreviewSurface"',
                f"        color3f inputs:diffuseColor = {_tuple(linear_color(color))}",
                "        float inputs:roughness = 0.5",
                "        token outputs:surface",
                "    }",
                "}",
            ])  # fmt: skip
        for (friction, material), name in self._frictions.items():
            lines += _indented([
                *_material(name, material, "PhysicsMaterialAPI"),
                f"    float physics:dynamicFriction = {number(friction)}",
                f"    float physics:staticFriction = {number(friction)}",
                "}",
            ])  # fmt: skip
        return [*lines, "}"]


def _material(name: str, material: str | None, *schemas: str) -> list[str]:
    """Return the first lines of a material, with its name as a label."""
    listed = ", ".join(f'"{one}"' for one in (*schemas, *(["SemanticsLabelsAPI:material"] if material else [])))
    head = [f'def Material "{name}" (', f"    prepend apiSchemas = [{listed}]", ")", "{"] if listed else [f'def Material "{name}"', "{"]
    return [*head, f"    token[] semantics:labels:material = ['{valid_name(material)}']"] if material else head


def _body(
    part: Part,
    name: str,
    T: SE3,
    shapes: _Shapes,
    meshes: _Meshes,
    materials: _Materials,
    surface: str | None,
    schemas: Iterable[str] = (),
) -> list[str]:
    """Return a rigid body with its visual and its collision shapes in two scopes."""
    listed = ", ".join(['"PhysicsRigidBodyAPI"', '"PhysicsMassAPI"', '"SemanticsLabelsAPI:class"', *schemas])
    mass = part.mass if part.mass is not None and part.mass.mass > 0 else None
    lines = [
        f'def Xform "{name}" (',
        f"    prepend apiSchemas = [{listed}]",
        ")",
        "{",
        *_indented(_mass(mass)),
        f"    token[] semantics:labels:class = ['{name}']",
        f"    double3 xformOp:translate = {_position(T.translation)}",
        f"    quatd xformOp:orient = {_quaternion(T)}",
        '    uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:orient"]',
    ]
    drawings = [
        _mesh(
            f"visual_{index}",
            shapes.drawn[id(one)],
            meshes,
            materials.look(one.color or part.color, part.material),
            one.color or part.color,
        )
        for index, one in enumerate(shapes.visuals)
    ]
    colliding = [
        _form(one, f"collision_{index}", surface) or _mesh(f"collision_{index}", shapes.colliding[id(one)], meshes, surface)
        for index, one in enumerate(shapes.collisions)
    ]
    for scope, prims, fields in (("visuals", drawings, []), ("collisions", colliding, ['    uniform token purpose = "guide"'])):
        if prims:
            lines += _indented([f'def Scope "{scope}"', "{", *fields, *_indented(line for prim in prims for line in prim), "}"])
    return [*lines, "}"]


def _mass(mass: MassProperties | None) -> list[str]:
    if mass is None:
        return [f"float physics:mass = {number(CARRIER_MASS_KG)}"]
    moments, axes = Inertial.from_part(mass, SE3.identity()).possible().without_dust().principal()
    return [
        f"float physics:mass = {number(mass.mass)}",
        f"point3f physics:centerOfMass = {_position(mass.com)}",
        f"float3 physics:diagonalInertia = {_tuple(moments)}",
        f"quatf physics:principalAxes = {_quaternion(SE3.from_rotation(axes))}",
    ]


def _form(shape: Shape, name: str, surface: str | None) -> list[str] | None:
    """Return a primitive for collision, None if USD has none or the shape is a mesh."""
    form, T = shape.primitive, shape.frame
    if form is None or form.kind not in {"box", "sphere", "cylinder", "capsule"}:
        return None
    sizes = [size / MM_PER_M for size in form.size]
    r, order = number(sizes[0]), '"xformOp:translate", "xformOp:orient"'
    high = sizes[-1] / 2 + (sizes[0] if form.kind == "capsule" else 0.0)
    round_ = [
        'uniform token axis = "Z"',
        f"double radius = {r}",
        f"double height = {number(sizes[-1])}",
        _extent([sizes[0], sizes[0], high]),
    ]
    prims = {
        "box": ("Cube", ["double size = 1", f"float3 xformOp:scale = {_tuple(sizes)}", _extent([0.5] * 3)]),
        "sphere": ("Sphere", [f"double radius = {r}", _extent([sizes[0]] * 3)]),
        "cylinder": ("Cylinder", round_),
        "capsule": ("Capsule", round_),
    }
    prim, fields = prims[form.kind]
    order += ', "xformOp:scale"' if form.kind == "box" else ""
    return [
        f'def {prim} "{name}" (',
        f"    prepend apiSchemas = [{_schemas('PhysicsCollisionAPI', bound=surface)}]",
        ")",
        "{",
        *_indented(fields),
        *_bound(surface, "physics"),
        f"    double3 xformOp:translate = {_position(T.translation)}",
        f"    quatd xformOp:orient = {_quaternion(T)}",
        f"    uniform token[] xformOpOrder = [{order}]",
        "}",
    ]


def _extent(half: Iterable[float]) -> str:
    half = list(half)
    return f"float3[] extent = [{_tuple(-size for size in half)}, {_tuple(half)}]"


def _schemas(*names: str, bound: str | None) -> str:
    return ", ".join(f'"{name}"' for name in (*names, *(["MaterialBindingAPI"] if bound else [])))


def _bound(material: str | None, purpose: str = "") -> list[str]:
    """Return the binding of a material."""
    return [] if material is None else [f"    rel material:binding{':' + purpose if purpose else ''} = <{material}>"]


def _triangles(mesh: TriMesh, *, flat: bool) -> str:
    """Return the triangles of a mesh with their normals: one for each triangle, or one for each corner, smooth but for creases."""
    points = np.round(mesh.vertices / MM_PER_M, _POINT_DIGITS)
    if flat:
        twice = mesh.normals_of_twice_area
        normals = twice / np.maximum(np.linalg.norm(twice, axis=1), np.finfo(float).tiny)[:, None]
        indices, interpolation = np.arange(len(normals)), "uniform"
    else:
        (_, normals, indices), interpolation = shaded(mesh), "faceVarying"
    normals = np.round(normals, _NORMAL_DIGITS) + 0.0
    places = groups_of_equal(normals[:, ::-1])  # in the order of x, then y, then z
    distinct = np.empty((int(places.max(initial=-1)) + 1, 3))
    distinct[places] = normals
    return "\n".join([
        f"    float3[] extent = [{_tuple(points.min(axis=0))}, {_tuple(points.max(axis=0))}]",
        f"    int[] faceVertexCounts = [{', '.join('3' * len(mesh.triangles))}]",
        f"    int[] faceVertexIndices = {mesh.triangles.ravel().tolist()}",
        f"    point3f[] points = {_points(points)}",
        f"    normal3f[] primvars:normals = {_points(distinct)} (",
        f'        interpolation = "{interpolation}"',
        "    )",
        f"    int[] primvars:normals:indices = {places[indices].tolist()}",
        '    uniform token subdivisionScheme = "none"',
    ])  # fmt: skip


def _mesh(name: str, triangles: str, meshes: _Meshes, bound: str | None, color: str | None = None) -> list[str]:
    """Return a mesh: drawn in a colour, or for collision by its convex hull; with its material's path."""
    own = () if color is not None else ("PhysicsCollisionAPI", "PhysicsMeshCollisionAPI", "NewtonMeshCollisionAPI")
    lines = [
        f'def Mesh "{name}" (',
        f"    prepend apiSchemas = [{_schemas(*own, bound=bound)}]",
        *meshes.head(triangles),
        ")",
        "{",
        *meshes.fields(triangles),
        *_bound(bound, "physics" if color is None else ""),
    ]
    if color is None:
        lines.append('    uniform token physics:approximation = "convexHull"')
    else:
        lines.append(f"    color3f[] primvars:displayColor = [{_tuple(linear_color(color))}]")
    return [*lines, "}"]


class _Extra(NamedTuple):
    """A schema that a joint has in addition to its frames and limits, with its fields."""

    schema: str
    fields: list[str]


def _is_single(joint: Joint) -> bool:
    """True for joints whose coordinates share one number of NewtonJointAPI."""
    return joint.type in {JointType.REVOLUTE, JointType.SLIDER, JointType.BALL}


def _dynamics(joint: Joint) -> list[_Extra]:
    """Return stated velocity limit, damping and friction; torques are stated in N·mm, angles in USD are degrees."""
    if not _is_single(joint):
        return []
    turns = joint.type is not JointType.SLIDER
    effort = 1 / MM_PER_M if turns else 1.0  # N·mm to N·m
    value = math.degrees(1.0) if turns else 1 / MM_PER_M  # rad to degrees, mm to m
    velocity, damping, friction = (next(iter(values), None) for values in (joint.velocity, joint.damping, joint.friction))
    rows = []
    if velocity is not None:
        rows.append(f"float newton:velocityLimit = {number(velocity * value)}")
    if damping:
        rows.append(f"float newton:damping = {number(damping * effort / value)}")
    if friction:
        rows.append(f"float newton:friction = {number(friction * effort)}")
    found = [_Extra("NewtonJointAPI", rows)] if rows else []
    if velocity is not None:
        found.append(_Extra("PhysxJointAPI", [f"float physxJoint:maxJointVelocity = {number(velocity * value)}"]))
    return found


def _mimics(assembly: Assembly, model: LoweredModel) -> tuple[dict[str, tuple[Follows, str]], set[str]]:
    """Return what each joint follows and the name of the joint that leads, and the places of the couplings that this expresses.

    NewtonMimicAPI can tie joints of one kind, each with one freedom in the tree. Newton refuses leaders that follow others themselves.
    """
    written = {feature.where for feature in features_of(assembly) if feature.key == "coupling"}
    single = {
        freedom.name: (freedom.kind, joint.joint.name)
        for joint in model.joints
        if joint.joint.type in {JointType.REVOLUTE, JointType.SLIDER}
        for freedom in joint.freedoms
    }
    rows = [
        (name, follower, follows)
        for name, follower, follows in model.couplings
        if f"couplings.{name}" in written
        and {follower, follows.leader} <= single.keys()
        and single[follower][0] == single[follows.leader][0]
    ]
    tied = followers(replace(model, couplings=tuple(rows)), leaders(assembly))
    found = {single[name][1]: (follows, single[follows.leader][1]) for name, follows in tied.items() if name in single}
    return found, {f"couplings.{name}" for name, _, _ in rows}


def _mimic(joint: Joint, tie: tuple[Follows, str] | None, names: Mapping[str, str], root: str) -> list[_Extra]:
    """Return follower = offset + ratio · leader; the offset in degrees or m."""
    if tie is None:
        return []
    follows, leader = tie
    offset = math.degrees(follows.offset) if joint.type is JointType.REVOLUTE else follows.offset
    fields = [
        f"float newton:mimicCoef0 = {number(offset)}",
        f"float newton:mimicCoef1 = {number(follows.ratio)}",
        f"rel newton:mimicJoint = </{root}/joints/{names[leader]}>",
    ]
    return [_Extra("NewtonMimicAPI", fields)]


def _held(assembly: Assembly, features: Iterable[Feature], tied: Container[str]) -> list[Feature]:
    """Return the features; those that USD can express for some joints only get a key of their own."""
    several = {f"joints.{joint.name}" for joint in assembly.joints if not _is_single(joint)}
    found = []
    for feature in features:
        if feature.key == "coupling" and feature.where in tied:
            found.append(feature._replace(key="coupling.mimic"))
        elif feature.key in {"velocity", "joint.damping", "joint.friction"} and feature.where in several:
            found.append(feature._replace(key=f"{feature.key}.several"))
        else:
            found.append(feature)
    return found


def _joint(joint: Joint, name: str, ends: tuple[str, str], more: Sequence[_Extra], *, closes: bool, backwards: bool) -> list[str]:
    """Return a joint; its frame on the child includes the mate's flip, so that both coincide at zero.

    `body0` is nearer to the ground, as Newton requires. For a joint that leads from child to parent, both frames are turned about an axis
    by F, so that F⁻¹ J(q)⁻¹ F = J(q): values and limits stay the same.
    """
    frames = (joint.T_parent_connector, joint.T_child_connector @ flip(joint.mate))
    turn = _REVERSING.get(joint.type)
    if backwards and turn is not None:
        ends, frames = (ends[1], ends[0]), (frames[1] @ turn, frames[0] @ turn)
    extra = ["bool physics:excludeFromArticulation = true"] if closes else []
    extra += [line for one in more for line in one.fields]
    schemas = [f'"{one.schema}"' for one in more]
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
    return _joint_prim(kind, name, ends, frames, extra, schemas)


def _generic(joint: Joint, name: str, ends: tuple[str, str], frames: tuple[SE3, SE3], extra: list[str]) -> list[str]:
    """Return a generic joint whose other degrees are locked by a lower limit above the upper one."""
    schemas, limits = [], []
    free = {f"{'trans' if step.kind == 'slide' else 'rot'}{'XYZ'[step.axis]}": step for step in joint.type.steps}
    for degree in _DEGREES:
        step = free.get(degree)
        if step is None:
            low, high = "1", "-1"
        elif step.advances:  # the slide of a screw follows its turn; Newton locks degrees without a limit
            travel = (joint.lead / math.tau * bounds[0] for bounds in (joint.limits.lower, joint.limits.upper))
            low, high = (_in_usd(bound, "mm") for bound in sorted(travel))
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
        for line in (
            f"point3f physics:localPos{i} = {_position(T.translation)}",
            f"quatf physics:localRot{i} = {_quaternion(T)}",
        )
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


def _position(mm: FloatArray) -> str:
    return _tuple(rounded(mm / MM_PER_M))


def _quaternion(T: SE3) -> str:
    x, y, z, w = rounded_quaternion(T)
    return _tuple([w, x, y, z])


def _indented(lines: Iterable[str], levels: int = 1) -> list[str]:
    return ["    " * levels + line for line in lines]


def _name_features(assembly: Assembly, bodies: dict[str, str], joints: dict[str, str]) -> list[Feature]:
    changed = [("parts", *item) for item in bodies.items()] + [("joints", *item) for item in joints.items()]
    features = [Feature("name", f"{kind}.{old}", new) for kind, old, new in changed if old != new]
    return features + ([Feature("name", "name", valid_name(assembly.name))] if valid_name(assembly.name) != assembly.name else [])
