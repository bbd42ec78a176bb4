"""URDF: a tree of links and one-freedom joints, for ROS, Pinocchio, MuJoCo, PyBullet, Isaac and others."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, Literal

from lxml import etree

from articad.connectors.se3 import SE3
from articad.export.bundle import Bundle
from articad.export.closing import TiedPoint, tied_points
from articad.export.collisions import Collision, collide, contact_feature
from articad.export.follow import followers
from articad.export.hulls import HullOverlap, Pair, mating_pairs, same_group_pairs
from articad.export.inertia import Inertial
from articad.export.losses import Feature, losses_of, refuse
from articad.export.lowering import Follows, Freedom, Link, LoweredJoint, LoweredModel, Placed, lower
from articad.export.markup import child, document, number, numbers, rgba, rpy
from articad.export.meshes import MM_TO_M, MeshFiles, MeshKind
from articad.export.metadata import dumps, records
from articad.export.mimic import linear_followers
from articad.export.ros import add_control, package_files, require_package_name
from articad.export.ros import srdf as disabled_pairs
from articad.kernels.cache import BuildCache

if TYPE_CHECKING:
    from articad.assembly import Assembly

Loops = Literal["none", "isaac", "drake", "mimic"]

FAR_RAD = 1e6  # stands for an open end of a range that has another end
DRAKE = "http://drake.mit.edu"  # the namespace of Drake's own elements
FAR_M = 1e3  # URDF has no endless prismatic joint


def write_urdf(
    assembly: Assembly,
    *,
    strict: bool = False,
    meshes: MeshKind = "stl",
    loops: Loops = "none",
    package: str | None = None,
    srdf: bool = False,
    ros2_control: bool = False,
    collision: Collision = "solid",
    cache: BuildCache | None = None,
) -> Bundle:
    """Write an assembly as URDF.

    Link frames are joint frames, the root link is the ground part, and every joint's value is ours in rad or m, so all zero is q = 0.
    Joints of several freedoms become chains over carrier links (`<joint>__d1`) of small mass, which is taken out of the moved part.
    What URDF does not hold is kept in `<articad>` elements, which other readers ignore.

    Args:
        assembly: What to write.
        strict: Refuse what URDF holds only with a loss of motion, mass or shape.
        meshes: Format of the mesh files: STL holds single precision, OBJ nine digits.
        loops: How closed loops are written besides the tree: not at all, as `<loop_joint>` for Isaac Sim, as `<drake:ball_constraint>`
            for Drake, or as `<mimic>` of the driver, where a linear relation is as good as 0.1 mm.
        package: Name of a ROS 2 package to lay out: `urdf/`, `meshes/`, a manifest, and meshes named `package://…`.
        srdf: Add `<name>.srdf` with the pairs of links that need no collision check.
        ros2_control: Add a `<ros2_control>` system that commands the drivers' positions, on mock hardware.
        collision: Collide with the parts' own meshes ("solid"), with their hulls, or with convex pieces that are cut until they add no
            contact; the error of both is told.
        cache: Keeps convex pieces by shape; that of built parts by default.

    Returns:
        `<name>.urdf`, `meshes/…`, and the losses.

    Raises:
        UnrepresentableError: If `strict` and there is such a loss.
        ExportError: E_MIMIC_FIT if `loops` is "mimic" and no linear relation is good enough; or if ROS does not take the package's name.
    """
    if package is not None:
        require_package_name(package)
    model = lower(assembly)
    model, contacts = collide(assembly, model, collision, _skipped(assembly, model), cache)
    tied = {loop.name: tied_points(model, loop) for loop in model.loops} if loops in {"isaac", "drake"} else {}
    losses = losses_of("urdf", (*_loop_features(model, loops, tied), *map(contact_feature, contacts)))
    if strict:
        refuse(losses)
    files = MeshFiles(meshes, prefix="" if package is None else f"package://{package}/")
    follows = followers(model, [driver.name for driver in assembly.mechanism.drivers])
    if loops == "mimic" and model.loops:
        follows |= linear_followers(assembly, model)
    root = etree.Element("robot", {"name": model.name}, nsmap={"drake": DRAKE} if loops == "drake" else None)
    _compiler(root)
    _materials(root, model)
    _tree(root, model, follows, files)
    for loop in model.loops:
        for point in tied.get(loop.name, ()):
            (_isaac if loops == "isaac" else _drake)(root, loop, point)
    for record in records(assembly, model, files.by_digest, [*root.iterfind("link"), *root.iterfind("joint")]):
        child(root, "articad", {"kind": str(record["kind"])}, dumps(record))
    if ros2_control:
        add_control(root, assembly, model)
    documents = {"urdf": document(root)} | ({"srdf": _disabled_pairs(assembly, model, contacts)} if srdf else {})
    if package is None:
        main = {f"{model.name}.{kind}": content for kind, content in documents.items()}
    else:
        main = {f"{kind}/{model.name}.{kind}": content for kind, content in documents.items()}
        main |= package_files(package, model.name, [*documents, files.folder])
    return Bundle({**main, **files.files}, losses)


def _tree(root: Any, model: LoweredModel, follows: dict[str, Follows], files: MeshFiles) -> None:
    """Write links and joints, each joint after the link that it moves, carriers before it."""
    carried = {joint.child: joint for joint in model.joints}
    for link in model.links:
        joint = carried.get(link.name)
        carriers = _carrier_count(joint)
        whole, carrier = _inertials(link, carriers)
        if joint is not None:
            for name in joint.carriers[:carriers]:
                _inertial(child(root, "link", {"name": name}), carrier)
        _link(root, link, whole, files)
        if joint is not None:
            _joints(root, joint, follows)


def _disabled_pairs(assembly: Assembly, model: LoweredModel, contacts: Iterable[HullOverlap]) -> bytes:
    order, joints = assembly.mechanism.parts, assembly.mechanism.joints
    return disabled_pairs(model, mating_pairs(joints, order), sorted(same_group_pairs(joints, order)), contacts)


def _compiler(root: Any) -> None:
    """Tell MuJoCo to take file paths as they are, to keep what is drawn and to keep rigidly connected links apart."""
    settings = {"strippath": "false", "discardvisual": "false", "fusestatic": "false", "balanceinertia": "false"}
    child(child(root, "mujoco"), "compiler", settings)


def _materials(root: Any, model: LoweredModel) -> None:
    colors = dict.fromkeys(placed.color for link in model.links for placed in link.visuals)
    for color in colors:
        child(child(root, "material", {"name": _material(color)}), "color", {"rgba": rgba(color)})


def _material(color: str) -> str:
    return f"color_{color.removeprefix('#')}"


def _carrier_count(joint: LoweredJoint | None) -> int:
    return 0 if joint is None else max(0, len(joint.freedoms) - 1)


def _inertials(link: Link, carriers: int) -> tuple[Inertial | None, Inertial]:
    """Return what is left of the link's inertia, and one carrier's."""
    if link.inertial is not None:
        return link.inertial.without_carriers(carriers)
    return (Inertial.carrier() if link.moves else None), Inertial.carrier()


def _link(root: Any, link: Link, inertial: Inertial | None, files: MeshFiles) -> None:
    element = child(root, "link", {"name": link.name})
    if inertial is not None:
        _inertial(element, inertial)
    for placed in link.visuals:
        visual = _shape(element, "visual", placed, link.name, files)
        child(visual, "material", {"name": _material(placed.color)})
    for placed in link.collisions:
        _shape(element, "collision", placed, link.name, files)


def _inertial(link: Any, inertial: Inertial) -> None:
    inertial = inertial.inside_bounds()
    element = child(link, "inertial")
    child(element, "origin", {"xyz": numbers(inertial.com), "rpy": "0 0 0"})
    child(element, "mass", {"value": number(inertial.mass)})
    moments = {f"i{'xyz'[i]}{'xyz'[j]}": number(inertial.inertia[i, j]) for i in range(3) for j in range(i, 3)}
    child(element, "inertia", moments)


def _shape(link: Any, tag: str, placed: Placed, name: str, files: MeshFiles) -> Any:
    element = child(link, tag)
    _origin(element, placed.T_link_shape)
    mesh = {"filename": files.uri(placed.shape.mesh, name), "scale": numbers([MM_TO_M] * 3)}
    child(child(element, "geometry"), "mesh", mesh)
    return element


def _origin(parent: Any, T: SE3) -> None:
    child(parent, "origin", {"xyz": numbers(T.translation), "rpy": numbers(rpy(T))})


def _joints(root: Any, joint: LoweredJoint, follows: dict[str, Follows]) -> None:
    """Write a joint as a chain of one-freedom joints over its carriers."""
    if not joint.freedoms:
        element = child(root, "joint", {"name": joint.name, "type": "fixed"})
        _ends(element, joint.T_parent_joint, joint.parent, joint.child)
        return
    links = [joint.parent, *joint.carriers[: _carrier_count(joint)], joint.child]
    T = joint.T_parent_joint
    for freedom, near, far in zip(joint.freedoms, links[:-1], links[1:], strict=True):
        element = child(root, "joint", {"name": freedom.name, "type": _type(freedom)})
        _ends(element, T, near, far)
        child(element, "axis", {"xyz": numbers(freedom.axis)})
        child(element, "limit", _limit(freedom))
        child(element, "dynamics", {"damping": number(freedom.load.damping), "friction": "0"})
        if freedom.name in follows:
            tie = follows[freedom.name]
            child(element, "mimic", {"joint": tie.leader, "multiplier": number(tie.ratio), "offset": number(tie.offset)})
        T = SE3.identity()


def _ends(element: Any, T_parent_joint: SE3, parent: str, child_link: str) -> None:
    _origin(element, T_parent_joint)
    child(element, "parent", {"link": parent})
    child(element, "child", {"link": child_link})


def _type(freedom: Freedom) -> str:
    if freedom.kind == "slide":
        return "prismatic"
    return "continuous" if math.isinf(freedom.lower) and math.isinf(freedom.upper) else "revolute"


def _limit(freedom: Freedom) -> dict[str, str]:
    bounds = {}
    if _type(freedom) != "continuous":
        far = FAR_RAD if freedom.kind == "turn" else FAR_M
        bounds = {"lower": number(max(freedom.lower, -far)), "upper": number(min(freedom.upper, far))}
    return bounds | {"effort": number(freedom.load.effort), "velocity": number(freedom.load.velocity)}


def _isaac(root: Any, loop: LoweredJoint, point: TiedPoint) -> None:
    """Write a point that Isaac Sim's importer ties."""
    element = child(root, "loop_joint", {"name": f"{loop.name}{point.suffix}", "type": "spherical"})
    for tag, link, T in (("link1", loop.parent, point.near), ("link2", loop.child, point.far)):
        child(element, tag, {"link": link, "xyz": numbers(T.translation), "rpy": numbers(rpy(T))})


def _drake(root: Any, loop: LoweredJoint, point: TiedPoint) -> None:
    """Write a point that Drake's parser ties."""
    element = child(root, f"{{{DRAKE}}}ball_constraint")
    for tag, link in (("body_A", loop.parent), ("body_B", loop.child)):
        child(element, f"{{{DRAKE}}}ball_constraint_{tag}", {"name": link})
    for tag, T in (("p_AP", point.near), ("p_BQ", point.far)):
        child(element, f"{{{DRAKE}}}ball_constraint_{tag}", {"value": numbers(T.translation)})


def _loop_features(model: LoweredModel, loops: Loops, tied: Mapping[str, tuple[TiedPoint, ...]]) -> list[Feature]:
    """Return the model's features with what became of its loops."""
    written = {f"joints.{loop.joint.name}": bool(tied.get(loop.name)) for loop in model.loops}
    key = "loop.mimic" if loops == "mimic" else "loop.points"
    keep = loops == "mimic"
    return [
        feature._replace(key=key) if feature.key == "loop" and (keep or written[feature.where]) else feature for feature in model.features
    ]


def _skipped(assembly: Assembly, model: LoweredModel) -> set[Pair]:
    """Return the pairs that readers skip by themselves: a parent and its child, where no carrier stands between, and what never moves."""
    joints, order = assembly.mechanism.joints, assembly.mechanism.parts
    chained = {frozenset((joint.joint.parent, joint.joint.child)) for joint in model.joints if len(joint.freedoms) > 1}
    return {pair for pair in mating_pairs(joints, order) if frozenset(pair) not in chained} | same_group_pairs(joints, order)
