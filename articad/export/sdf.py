"""SDFormat 1.10 for Gazebo: links posed in the model's frame, joints as a graph, loops closed by ordinary joints."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from lxml import etree

from articad.connectors.se3 import SE3
from articad.export.bundle import Bundle
from articad.export.collisions import Collision, kind_of, shape_model
from articad.export.follow import followers, leaders
from articad.export.inertia import Inertial
from articad.export.losses import Feature, assumed_finding, kept_losses, losses_of, refuse
from articad.export.lowering import AxisMotion, Follows, Link, LoweredJoint, LoweredModel, Placed, ground_is_world, lower
from articad.export.markup import child, document, number, numbers, rgba, rounded, rounded_angles, rpy
from articad.export.meshes import MM_TO_M, MeshFiles, MeshKind
from articad.export.metadata import dumps, records
from articad.export.product import of_the_product
from articad.findings import Findings
from articad.kernels.cache import BuildCache
from articad.kinematics.joints import JointType

if TYPE_CHECKING:
    from articad.assembly import Assembly, Kept

RESERVED = ("world",)  # SDFormat's name for the frame of the world
VERSION = "1.10"
MIMIC_VERSION = "1.11"  # the first with <mimic>
ARTICAD = "https://articad.invalid/sdf"  # SDFormat requires a namespace for foreign elements

_NATIVE = {
    JointType.FIXED: "fixed",
    JointType.REVOLUTE: "revolute",
    JointType.SLIDER: "prismatic",
    JointType.BALL: "ball",
    JointType.UNIVERSAL: "universal",
    JointType.SCREW: "screw",
}

_FORMS: dict[str, Callable[[tuple[float, ...]], dict[str, str]]] = {
    "box": lambda size: {"size": numbers(size)},
    "sphere": lambda size: {"radius": number(size[0])},
    "cylinder": lambda size: {"radius": number(size[0]), "length": number(size[1])},
    "capsule": lambda size: {"radius": number(size[0]), "length": number(size[1])},
    "ellipsoid": lambda size: {"radii": numbers(size)},
}
"""The SDFormat element of a primitive with these sizes [m]."""


@of_the_product
def write_sdf(
    assembly: Assembly,
    *,
    strict: bool = False,
    meshes: MeshKind = "stl",
    collision: Collision | None = None,
    cache: BuildCache | None = None,
) -> Bundle:
    """Write an assembly as an SDFormat model.

    Links of a file keep their frames; a ground part without shape and mass that is called world is the world. A tree is posed where all
    values are zero, as in URDF. A model with loops is posed at rest, where its loops are closed, and values and limits are measured from
    there. Cylindrical and planar joints become chains over carrier links.

    Args:
        assembly: What to write.
        strict: Refuse what SDFormat holds only with a loss of motion, mass or shape.
        meshes: Format of the mesh files: STL has single precision; OBJ, which Drake requires, has nine digits.
        collision: Collide with convex pieces inside the parts ("pieces"), with the parts' own meshes ("solid"), or with hulls ("hull").
            By default pieces; for a file that articad did not write, its own shapes.
        cache: Stores convex pieces by shape; the cache of built parts by default.

    Returns:
        `<name>.sdf`, `meshes/…`, and the losses.

    Raises:
        UnrepresentableError: If `strict` and there is such a loss.
    """
    kind = kind_of(assembly, collision)
    lowered = _lowered(assembly)
    model = shape_model(assembly, lowered, kind, cache)
    features = [*model.features, *([Feature("loop.rest", "joints")] if model.loops else [])]
    writer = _Writer(assembly, model, MeshFiles(meshes, draws=kind != "solid", cache=cache))
    losses = (*losses_of("sdf", features), *kept_losses("sdf", assembly.kept, writer.kept.written))
    if strict:
        refuse(losses)
    assumed = [] if assembly.foreign else [row.joint.name for row in model.joints if any(freedom.load.assumed for freedom in row.freedoms)]
    return Bundle({f"{model.name}.sdf": document(writer.document()), **writer.files.files}, losses, Findings(assumed_finding(assumed)))


def mechanism_elements(root: Any) -> list[Any]:
    """Return the elements of an SDFormat document that state the mechanism: links, joints, and what places or adds others."""
    inside = [
        element for tag in ("link", "joint", "pose", "static", "frame", "include", "model") for element in root.iterfind(f"model/{tag}")
    ]
    return [*inside, *root.iterfind("include"), *root.iterfind("world")]


def rewritten(assembly: Assembly) -> Iterator[tuple[list[Any], dict[str, str]]]:
    """Yield what `write_sdf` states of the mechanism, and the digests of the meshes by name."""
    lowered = _lowered(assembly)
    writer = _Writer(assembly, lowered, MeshFiles())
    yield mechanism_elements(writer.document()), writer.files.names()


def _lowered(assembly: Assembly) -> LoweredModel:
    return lower(assembly, () if ground_is_world(assembly) else RESERVED, part_frames=assembly.foreign)


class _Kept:
    """Data of the assembly's original SDFormat file beyond the assembly, and where it is written again."""

    def __init__(self, assembly: Assembly, model: LoweredModel) -> None:
        self.written: list[Kept] = []
        self._at: dict[str, list[Any]] = {}
        joints = [row for row in (*model.joints, *model.loops) if row.joint.type in _NATIVE and not row.backwards]
        there = {f"joints.{row.joint.name}" for row in joints} | {"model"}
        for link in model.links:
            if not link.T_link_part.allclose(SE3.identity(), mm=1e-9, rad=1e-9):
                continue  # it is posed in the link's frame, which has changed
            where = f"parts.{link.part.name}"
            there |= {where, *(f"{where}.visuals.{n}" for n in range(len(link.part.visuals)))}
            if link.collisions and all(a.shape is b for a, b in zip(link.collisions, link.part.collisions, strict=False)):
                there |= {f"{where}.collisions.{n}" for n in range(len(link.part.collisions))}
        for item in assembly.kept:
            if item.format == "sdf" and item.xml and item.where in there:
                self.written.append(item)
                self._at.setdefault(item.where, []).append(etree.fromstring(item.xml))

    def write(self, element: Any, where: str) -> None:
        """Append kept data of an object to its element."""
        for kept in self._at.get(where, []):
            _merge(element, kept)


def _merge(element: Any, kept: Any) -> None:
    """Append an element; if the parent has such a child that is also read, append the content to that child."""
    there = element.find(kept.tag) if kept.tag in {"material", "axis", "axis2", "limit", "dynamics", "surface", "friction", "ode"} else None
    if there is None:
        element.append(kept)
        return
    for below in list(kept):
        _merge(there, below)


class _Writer:
    def __init__(self, assembly: Assembly, model: LoweredModel, files: MeshFiles) -> None:
        self.assembly, self.model, self.files = assembly, model, files
        files.expect(link.part for link in model.links)
        self.at_rest = bool(model.loops)
        self.follows = followers(model, leaders(assembly))
        self.poses: dict[str, SE3] = {}
        self.kept = _Kept(assembly, model)
        # links and joints share one namespace, so a joint with a link's name is renamed
        self.taken = {link.name for link in model.links} | {name for joint in model.joints for name in joint.carriers}

    def document(self) -> Any:
        root = etree.Element(
            "sdf", {"version": MIMIC_VERSION if self.assembly.mechanism.couplings else VERSION}, nsmap={"articad": ARTICAD}
        )
        first = self.model.links[1 if ground_is_world(self.assembly) else 0]
        model = child(root, "model", {"name": self.model.name, "canonical_link": first.name})
        carried = {joint.child: joint for joint in self.model.joints}
        for link in self.model.links:
            joint = carried.get(link.name)
            if joint is None:
                self.poses[link.name] = SE3.identity()
                if ground_is_world(self.assembly):
                    continue
                self._link(model, link, link.inertial)
                child(child(model, "joint", {"name": self._joint_name("to_world"), "type": "fixed"}), "parent", text="world")
                child(model[-1], "child", text=link.name)
                continue
            self._tree_joint(model, link, joint)
        self.kept.write(model, "model")
        for loop in self.model.loops:
            if loop.joint.type in _NATIVE:  # at rest its two frames coincide, so the child's is enough
                self._joint(model, loop.name, loop, loop.parent, loop.child, loop.freedoms, loop.T_child_joint)
        kept = child(model, f"{{{ARTICAD}}}records")
        for record in records(self.assembly, self.model, self.files, [*model.iterfind("link"), *model.iterfind("joint")]):
            child(kept, f"{{{ARTICAD}}}record", {"kind": str(record["kind"])}, dumps(record))
        return root

    def _joint_name(self, name: str) -> str:
        while name in self.taken:
            name = f"{name}_joint"
        return name

    def _tree_joint(self, model: Any, link: Link, joint: LoweredJoint) -> None:
        """Write a link, the joint above it, and carriers between them if SDFormat has no such joint."""
        native = joint.joint.type in _NATIVE
        count = 0 if native else len(joint.freedoms) - 1
        inertial = link.inertial or (Inertial.carrier() if link.moves else None)
        whole, carrier = (inertial, Inertial.carrier()) if inertial is None else inertial.without_carriers(count)
        T = self.poses[joint.parent] @ joint.T_parent_joint
        T_end = SE3.identity() if joint.end is None else joint.end[1]
        at = None if joint.end is None else T_end.inverse()  # the joint's frame in the child's
        if joint.is_free:  # no joint at all: an unconnected link is free
            self.poses[link.name] = T @ joint.T_rest @ T_end
            self._link(model, link, inertial)
            return
        if native:
            self.poses[link.name] = T @ self._rest_motion(joint) @ T_end
            self._link(model, link, whole)
            self._joint(model, joint.name, joint, joint.parent, joint.child, joint.freedoms, at)
            return
        names = [joint.parent, *joint.carriers[:count], joint.child]
        for index, freedom in enumerate(joint.freedoms):
            T = T @ (_motion(freedom) if self.at_rest else SE3.identity())
            name = names[index + 1]
            self.poses[name] = T @ T_end if index == count else T
            if index < count:
                element = child(model, "link", {"name": name})
                child(element, "pose", text=_pose(T))
                _inertial(element, carrier)
            else:
                self._link(model, link, whole)
            one = replace(joint, joint=replace(joint.joint, type=_single(freedom)))
            self._joint(model, freedom.name, one, names[index], name, (freedom,), at if index == count else None)

    def _rest_motion(self, joint: LoweredJoint) -> SE3:
        """Return the joint's displacement in the pose that is written."""
        if not self.at_rest or joint.joint.type is JointType.FIXED:
            return SE3.identity()
        if joint.joint.type is not JointType.BALL:
            T = SE3.identity()
            for freedom in joint.freedoms:  # in the joint's frame, which may differ from articad's: lowering keeps the frames of links
                T = T @ _motion(freedom)
            return T
        motion = joint.joint.motion(joint.joint.rest)
        in_metres = SE3.from_quaternion(motion.quaternion, motion.translation / 1000.0)
        return in_metres.inverse() if joint.backwards else in_metres

    def _link(self, model: Any, link: Link, inertial: Inertial | None) -> None:
        element = child(model, "link", {"name": link.name})
        child(element, "pose", text=_pose(self.poses[link.name]))
        if inertial is not None:
            _inertial(element, inertial)
        for index, placed in enumerate(link.visuals):
            visual = self._shape(element, "visual", index, placed, link.name)
            material = child(visual, "material")
            for kind in ("ambient", "diffuse"):
                child(material, kind, text=rgba(placed.color))
            self.kept.write(visual, f"parts.{link.part.name}.visuals.{index}")
        for index, placed in enumerate(link.collisions):
            collision = self._shape(element, "collision", index, placed, link.name)
            self.files.keep_all(link.part, link.name)
            if link.friction is not None:
                ode = child(child(child(collision, "surface"), "friction"), "ode")
                for name in ("mu", "mu2"):
                    child(ode, name, text=number(link.friction))
            self.kept.write(collision, f"parts.{link.part.name}.collisions.{index}")
        self.kept.write(element, f"parts.{link.part.name}")

    def _shape(self, link: Any, tag: str, index: int, placed: Placed, name: str) -> Any:
        element = child(link, tag, {"name": f"{tag}_{index}"})
        child(element, "pose", text=_pose(placed.T_link_shape))
        geometry, form = child(element, "geometry"), placed.shape.primitive
        if form is not None:
            body = child(geometry, form.kind)
            for field, value in _FORMS[form.kind](tuple(size * MM_TO_M for size in form.size)).items():
                child(body, field, text=value)
            self.files.keep(placed.shape.mesh, name)
            return element
        mesh = child(geometry, "mesh")
        child(mesh, "uri", text=self.files.path(placed.shape.mesh, name))
        child(mesh, "scale", text=numbers([MM_TO_M] * 3))
        return element

    def _joint(
        self, model: Any, name: str, joint: LoweredJoint, parent: str, child_link: str, freedoms: tuple[AxisMotion, ...], pose: SE3 | None
    ) -> None:
        kind = joint.joint.type
        turning = freedoms[-1] if kind is JointType.SCREW and not joint.backwards else freedoms[0] if freedoms else None
        native = _NATIVE[kind]
        if kind is JointType.REVOLUTE and turning is not None and math.isinf(turning.lower) and math.isinf(turning.upper):
            native = "continuous"
        element = child(model, "joint", {"name": self._joint_name(name), "type": native})
        child(element, "parent", text=parent)
        child(element, "child", text=child_link)
        if pose is not None:
            child(element, "pose", text=_pose(pose))
        if kind is JointType.SCREW:
            child(element, "screw_thread_pitch", text=number(joint.joint.lead / 1000.0))
        axes = {JointType.UNIVERSAL: freedoms, JointType.FIXED: (), JointType.BALL: ()}.get(kind, (turning,))
        for tag, freedom in zip(("axis", "axis2"), axes, strict=False):
            if freedom is not None:
                self._axis(element, tag, freedom)
        self.kept.write(element, f"joints.{joint.joint.name}")

    def _axis(self, joint: Any, tag: str, freedom: AxisMotion) -> None:
        element = child(joint, tag)
        child(element, "xyz", text=numbers(freedom.axis))
        zero = freedom.rest if self.at_rest else 0.0
        limit = child(element, "limit")
        for name, bound in (("lower", freedom.lower), ("upper", freedom.upper)):
            if math.isfinite(bound):
                child(limit, name, text=number(bound - zero))
        load = freedom.load
        for name, value in (("effort", load.effort), ("velocity", load.velocity)):
            if not self.assembly.foreign or name not in load.assumed:  # SDFormat requires neither
                child(limit, name, text=number(value))
        dynamics = child(element, "dynamics")
        child(dynamics, "damping", text=number(load.damping))
        if load.friction:
            child(dynamics, "friction", text=number(load.friction))
        tie: Follows | None = self.follows.get(freedom.name)
        if tie is not None and freedom.follows is None:
            mimic = child(element, "mimic", {"joint": self._joint_name(tie.leader)})
            child(mimic, "multiplier", text=number(tie.ratio))
            child(mimic, "offset", text=number(tie.offset))
            child(mimic, "reference", text="0")


def _single(freedom: AxisMotion) -> JointType:
    return JointType.SLIDER if freedom.kind == "slide" else JointType.REVOLUTE


def _motion(freedom: AxisMotion) -> SE3:
    """Return the motion of one freedom at rest [m]."""
    if freedom.kind == "slide":
        return SE3.from_translation(freedom.axis * freedom.rest)
    return SE3.from_axis_angle(freedom.axis, freedom.rest)


def _pose(T: SE3) -> str:
    return f"{numbers(rounded(T.translation))} {numbers(rounded_angles(rpy(T)))}"


def _inertial(link: Any, inertial: Inertial) -> None:
    inertial = inertial.inside_bounds().without_dust()
    element = child(link, "inertial")
    child(element, "pose", text=f"{numbers(inertial.com)} 0 0 0")
    child(element, "mass", text=number(inertial.mass))
    moments = child(element, "inertia")
    for i in range(3):
        for j in range(i, 3):
            child(moments, f"i{'xyz'[i]}{'xyz'[j]}", text=number(inertial.inertia[i, j]))
