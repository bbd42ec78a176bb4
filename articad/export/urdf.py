"""URDF: a tree of links and one-freedom joints, for ROS, Pinocchio, MuJoCo, PyBullet, Isaac and others."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, Literal

from lxml import etree

from articad.connectors.se3 import SE3
from articad.errors import ExportError
from articad.export.bundle import Bundle
from articad.export.closing import TiedPoint, tied_points
from articad.export.collisions import Collision, adjacent, collide, contact_feature, excuse, kind_of, lying
from articad.export.follow import STATES_MIMIC, as_stated, followers, leaders
from articad.export.hulls import HullOverlap, Pair, mating_pairs, same_group_pairs
from articad.export.inertia import Inertial
from articad.export.losses import Feature, assumed_finding, kept_losses, losses_of, refuse
from articad.export.lowering import AxisMotion, Follows, Link, LoweredJoint, LoweredModel, Placed, lower
from articad.export.markup import child, document, number, numbers, rgba, rounded, rounded_angles, rpy, tidy
from articad.export.meshes import MM_TO_M, MeshFiles, MeshKind
from articad.export.metadata import dumps, records
from articad.export.mimic import linear_followers
from articad.export.names import called
from articad.export.product import of_the_product
from articad.export.ros import add_control, package_files, require_package_name, srdf_names
from articad.export.ros import srdf as write_srdf
from articad.findings import Findings
from articad.geometry.part import Primitive
from articad.kernels.cache import BuildCache

if TYPE_CHECKING:
    from articad.assembly import Assembly, Kept

Loops = Literal["none", "isaac", "drake", "mimic"]

DRAKE = "http://drake.mit.edu"  # the namespace of Drake's own elements


@of_the_product
def write_urdf(
    assembly: Assembly,
    *,
    strict: bool = False,
    meshes: MeshKind = "stl",
    loops: Loops = "none",
    package: str | None = None,
    srdf: bool = False,
    ros2_control: bool = False,
    collision: Collision | None = None,
    keep_frames: bool = False,
    cache: BuildCache | None = None,
) -> Bundle:
    """Write an assembly as URDF.

    Link frames are joint frames (for links of a file, their own frames if those can be joint frames), the root link is the ground part,
    and every joint's value equals articad's in rad or m, so all zero is q = 0. Joints of several freedoms become chains over carrier
    links (`<joint>__d1`) of small mass, which is taken out of the moved part. What URDF does not hold is kept in `<articad>` elements,
    which other readers ignore.

    Args:
        assembly: What to write.
        strict: Refuse what URDF holds only with a loss of motion, mass or shape.
        meshes: Format of the mesh files: STL has single precision, OBJ nine digits.
        loops: How closed loops are written in addition to the tree: not at all, as `<loop_joint>` for Isaac Sim, as
            `<drake:ball_constraint>` for Drake, or as `<mimic>` of the driver, if a linear relation is accurate to 0.1 mm.
        package: Name of a ROS 2 package to write: `urdf/`, `meshes/`, a manifest, and meshes named `package://…`.
        srdf: Add `<name>.srdf` with the pairs of links that need no collision check. Elements of an SRDF that was read are written in
            any case.
        ros2_control: Add a `<ros2_control>` system that commands the drivers' positions, on mock hardware.
        collision: Collide with convex pieces inside the parts ("pieces"), with the parts' own meshes ("solid"), of which engines use the
            hulls, or with hulls ("hull"). By default pieces; for a file that articad did not write, its own shapes.
        keep_frames: Give every link the frame of its part. If a joint's axis does not pass through its origin, the joint moves a bare
            link `<joint>__d1`, to which the part's link is fixed.
        cache: Stores convex pieces by shape; the cache of built parts by default.

    Returns:
        `<name>.urdf`, `meshes/…`, and the losses.

    Raises:
        UnrepresentableError: If `strict` and there is such a loss.
        ExportError: E_MIMIC_FIT if `loops` is "mimic" and no linear relation is accurate enough; or if the package's name is invalid in
            ROS.
    """
    if package is not None:
        require_package_name(package)
    model = lower(assembly, part_frames=keep_frames)
    contacts: tuple[HullOverlap, ...] = ()
    if srdf or kind_of(assembly, collision) != "solid" or not assembly.foreign:  # a file's own collision meshes stay as they are
        model, contacts = collide(assembly, model, collision, _skipped(assembly, model), cache)
    tied = {loop.name: tied_points(model, loop) for loop in model.loops} if loops in {"isaac", "drake"} else {}
    keeper = _Keeper(assembly, model)
    stated = keeper.stated_couplings(assembly)
    told = [feature for feature in _loop_features(model, loops, tied) if feature.key != "coupling" or feature.where not in stated]
    features = [*told, *map(contact_feature, contacts), *_features_of_file(assembly, model, keeper)]
    losses = (*losses_of("urdf", features), *kept_losses("urdf", assembly.kept, keeper.written))
    if strict:
        refuse(losses)
    prefix = "" if package is None else f"package://{package}/"
    files = MeshFiles(meshes, draws=kind_of(assembly, collision) != "solid", prefix=prefix, cache=cache)
    files.expect(link.part for link in model.links)
    follows = as_stated(followers(model, leaders(assembly)), model, stated)
    if loops == "mimic" and model.loops:
        follows |= linear_followers(assembly, model)
    version = {"version": keeper.version} if keeper.version else {}
    root = etree.Element("robot", {"name": model.name} | version, nsmap={"drake": DRAKE} if loops == "drake" else None)
    _compiler(root)
    _materials(root, model)
    _tree(root, model, follows, files, keeper)
    for loop in model.loops:
        for point in tied.get(loop.name, ()):
            (_isaac if loops == "isaac" else _drake)(root, loop, point)
    keeper.write(root)
    for record in records(assembly, model, files, [*root.iterfind("link"), *root.iterfind("joint")]):
        child(root, "articad", {"kind": str(record["kind"])}, dumps(record))
    if ros2_control:
        add_control(root, assembly, model)
    documents = {"urdf": document(root)} | _semantics(assembly, model, keeper, contacts if srdf else None)
    if package is None:
        main = {f"{model.name}.{kind}": content for kind, content in documents.items()}
    else:
        main = {f"{kind}/{model.name}.{kind}": content for kind, content in documents.items()}
        main |= package_files(package, model.name, [*documents, files.folder])
    return Bundle({**main, **files.files}, losses, Findings(assumed_finding(_assumed(model, keeper, all_of=True))))


def mechanism_elements(root: Any) -> list[Any]:
    """Return the elements of a URDF document that state the mechanism."""
    return [*root.iterfind("link"), *root.iterfind("joint")]


def rewritten(assembly: Assembly) -> Iterator[tuple[list[Any], dict[str, str]]]:
    """Yield what `write_urdf` states of the mechanism, for each choice that changes it, and the digests of the meshes by name."""
    for keep_frames in (False, True):
        model = lower(assembly, part_frames=keep_frames)
        keeper = _Keeper(assembly, model)
        follows = as_stated(followers(model, leaders(assembly)), model, keeper.stated_couplings(assembly))
        yield _alone(model, follows, keeper)
        if model.loops:
            with contextlib.suppress(ExportError):
                yield _alone(model, follows | linear_followers(assembly, model), keeper)


def _alone(model: LoweredModel, follows: dict[str, Follows], keeper: _Keeper) -> tuple[list[Any], dict[str, str]]:
    root, files = etree.Element("robot"), MeshFiles()
    files.expect(link.part for link in model.links)
    _tree(root, model, follows, files, keeper)
    keeper.write(root)
    return mechanism_elements(root), files.names()


def _features_of_file(assembly: Assembly, model: LoweredModel, keeper: _Keeper) -> list[Feature]:
    """Return the features of a file that URDF changes: primitives, joints that become chains, and efforts that it must state."""
    chains = [row.joint for row in model.joints if assembly.foreign and len(row.freedoms) > 1]
    rests = [row.joint.name for row in model.joints if row.is_free and row.joint.rest != row.joint.type.neutral]
    return [
        *_form_features(model, keeper),
        *(Feature("free.rest", f"joints.{name}") for name in rests),
        *(Feature("chain.carriers", f"joints.{joint.name}", joint.child) for joint in chains),
        *(Feature("effort.assumed", f"joints.{name}") for name in _assumed(model, keeper)),
    ]


class _Keeper:
    """What the assembly's original URDF file has beyond the assembly, and where it is written again."""

    def __init__(self, assembly: Assembly, model: LoweredModel) -> None:
        self.foreign = assembly.foreign
        self.version = ""
        self._places = {f"parts.{link.part.name}": ("link", link.name) for link in model.links}
        self._places |= {f"joints.{row.joint.name}": ("joint", row.name) for row in model.joints if len(row.freedoms) <= 1}
        self._places["model"] = ("robot", "")
        renamed = [old for where, (_, new) in self._places.items() if where != "model" and (old := where.partition(".")[2]) != new]
        self.written: list[Kept] = []
        self.semantics: list[Any] = []  # elements of the SRDF that are written
        self._keep_semantics([item for item in assembly.kept if item.format == "srdf" and item.xml], model)
        named = {
            (f"parts.{link.part.name}", called(tag, names))
            for link in model.links
            for tag, placed in (("visual", link.visuals), ("collision", link.collisions))
            if self.foreign and (names := [one.shape.name for one in placed if one.shape.name])
        }
        for item in assembly.kept:
            if item.format == "urdf" and (item.where, item.what) in named:
                self.written.append(item)
            if item.format != "urdf" or not item.xml or item.where not in self._places or any(name in item.xml for name in renamed):
                continue
            self.written.append(item)
            if item.where == "model" and item.xml.startswith("<robot "):
                self.version = etree.fromstring(item.xml).get("version", "")

    def _keep_semantics(self, items: list[Kept], model: LoweredModel) -> None:
        """Collect the elements of an SRDF whose links and joints are written under the same names."""
        elements = [etree.fromstring(item.xml) for item in items]
        links = {link.name for link in model.links}
        joints = {freedom.name for row in model.joints for freedom in row.freedoms} | {row.name for row in model.joints}
        joints |= {element.get("name") for element in elements if element.tag == "virtual_joint"}
        for item, element in zip(items, elements, strict=True):
            named_links, named_joints = srdf_names(element)
            if named_links <= links and named_joints <= joints:
                self.written.append(item)
                self.semantics.append(element)

    @property
    def capsules(self) -> bool:
        """Whether <capsule> may be written: URDF has it since 1.2."""
        return self.version not in {"", "1.0", "1.1"}

    def stated_couplings(self, assembly: Assembly) -> set[str]:
        """Return the couplings that the file itself states as mimics: written as such again, they lose nothing."""
        tied = {item.where for item in self.written if item.xml == STATES_MIMIC}
        return {f"couplings.{coupling.name}" for coupling in assembly.mechanism.couplings if f"joints.{coupling.b}" in tied}

    def write(self, root: Any) -> None:
        """Restore every element, or its attributes if the element already exists."""
        places = {("link", element.get("name")): element for element in root.iterfind("link")}
        places |= {("joint", element.get("name")): element for element in root.iterfind("joint")}
        places["robot", ""] = root
        for item in self.written:
            if item.xml in {"", STATES_MIMIC}:  # the names of shapes and what joints follow are written with these
                continue
            element, target = etree.fromstring(item.xml), places[self._places[item.where]]
            there = target.find(element.tag) if element.tag in {"limit", "dynamics", "mimic"} else None
            if element.tag == "robot":
                continue
            if there is None:
                target.append(element)
            else:
                there.attrib.update(element.attrib)


def _assumed(model: LoweredModel, keeper: _Keeper, *, all_of: bool = False) -> list[str]:
    """Return the joints whose effort or velocity is written without being stated: those of a file, or all."""
    if not keeper.foreign and not all_of:
        return []
    return [row.joint.name for row in model.joints if any(_writes_assumed(freedom, keeper) for freedom in row.freedoms)]


def _writes_assumed(freedom: AxisMotion, keeper: _Keeper) -> bool:
    needed = freedom.load.assumed - ({"damping"} if keeper.foreign else set())
    return bool(needed) and not _says_no_limit(freedom, keeper)


def _says_no_limit(freedom: AxisMotion, keeper: _Keeper) -> bool:
    """True for an endless joint of a file that states neither effort nor velocity; neither is required there."""
    return keeper.foreign and _type(freedom) == "continuous" and freedom.load.assumed >= {"effort", "velocity"}


def _form_features(model: LoweredModel, keeper: _Keeper) -> list[Feature]:
    """Return features for primitives that become meshes."""
    shapes = [(link.part.name, placed.shape.primitive) for link in model.links for placed in (*link.visuals, *link.collisions)]
    return [Feature("shape.primitive", f"parts.{name}", form.kind) for name, form in shapes if form and _form(form, keeper) is None]


def _form(form: Primitive, keeper: _Keeper) -> tuple[str, dict[str, str]] | None:
    """Return the element of a primitive, None if URDF has none."""
    metres_ = tidy((size * MM_TO_M for size in form.size), scale=0)
    if form.kind == "box":
        return "box", {"size": numbers(metres_)}
    if form.kind == "sphere":
        return "sphere", {"radius": number(metres_[0])}
    if form.kind == "cylinder" or (form.kind == "capsule" and keeper.capsules):
        return form.kind, {"radius": number(metres_[0]), "length": number(metres_[1])}
    return None


def _tree(root: Any, model: LoweredModel, follows: dict[str, Follows], files: MeshFiles, keeper: _Keeper) -> None:
    """Write links and joints, each joint after the link that it moves, carriers before it."""
    carried = {joint.child: joint for joint in model.joints}
    for link in model.links:
        joint = carried.get(link.name)
        carriers = _carrier_count(joint)
        whole, carrier = _inertials(link, carriers)
        if joint is not None:
            for name in joint.carriers[:carriers]:
                _inertial(child(root, "link", {"name": name}), carrier)
            if joint.end is not None:
                child(root, "link", {"name": joint.carriers[-1]})
        _link(root, link, whole, files, keeper)
        files.keep_all(link.part, link.name)
        if joint is not None:
            _joints(root, joint, follows, keeper)


def _semantics(assembly: Assembly, model: LoweredModel, keeper: _Keeper, contacts: Iterable[HullOverlap] | None) -> dict[str, bytes]:
    """Return the SRDF, with the pairs that need no collision check if contacts are given; None if it would be empty."""
    if contacts is None and not keeper.semantics:
        return {}
    pairs = () if contacts is None else _disabled_pairs(assembly, contacts)
    return {"srdf": write_srdf(model.name, {link.part.name: link.name for link in model.links}, pairs, keeper.semantics)}


def _disabled_pairs(assembly: Assembly, contacts: Iterable[HullOverlap]) -> Iterator[tuple[str, Pair, str]]:
    """Yield the pairs of parts that need no collision check, with the claim: they share a joint, rest on each other, never move, or overlap."""
    order, joints = assembly.mechanism.parts, assembly.mechanism.joints
    for pair in mating_pairs(joints, order):
        yield "Adjacent", pair, adjacent(assembly, pair)
    overlapping = {contact.parts: contact for contact in contacts}
    for pair, why in ({} if assembly.foreign else lying(assembly)).items():
        if pair not in overlapping:
            yield "Adjacent", pair, why
    for a, b in sorted(same_group_pairs(joints, order)):
        yield "Never", (a, b), f"never move: fixed joints hold {a} and {b} together"
    for contact in overlapping.values():
        yield "Default", contact.parts, excuse(contact)


def _compiler(root: Any) -> None:
    """Make MuJoCo use file paths as they are, keep visual geoms, and keep rigidly connected links separate."""
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
    """Return the rest of the link's inertia, and one carrier's."""
    if link.inertial is not None:
        return link.inertial.without_carriers(carriers)
    return (Inertial.carrier() if link.moves else None), Inertial.carrier()


def _link(root: Any, link: Link, inertial: Inertial | None, files: MeshFiles, keeper: _Keeper) -> None:
    element = child(root, "link", {"name": link.name})
    if inertial is not None:
        _inertial(element, inertial)
    for placed in link.visuals:
        visual = _shape(element, "visual", placed, link.name, files, keeper)
        child(visual, "material", {"name": _material(placed.color)})
    for placed in link.collisions:
        _shape(element, "collision", placed, link.name, files, keeper)


def _inertial(link: Any, inertial: Inertial) -> None:
    inertial = inertial.inside_bounds().without_dust()
    element = child(link, "inertial")
    child(element, "origin", {"xyz": numbers(inertial.com), "rpy": "0 0 0"})
    child(element, "mass", {"value": number(inertial.mass)})
    moments = {f"i{'xyz'[i]}{'xyz'[j]}": number(inertial.inertia[i, j]) for i in range(3) for j in range(i, 3)}
    child(element, "inertia", moments)


def _shape(link: Any, tag: str, placed: Placed, name: str, files: MeshFiles, keeper: _Keeper) -> Any:
    element = child(link, tag, {"name": placed.shape.name} if keeper.foreign and placed.shape.name else None)
    _origin(element, placed.T_link_shape)
    form = None if placed.shape.primitive is None else _form(placed.shape.primitive, keeper)
    if form is not None:
        child(child(element, "geometry"), *form)
        files.keep(placed.shape.mesh, name)  # for the records
        return element
    mesh = {"filename": files.uri(placed.shape.mesh, name), "scale": numbers([MM_TO_M] * 3)}
    child(child(element, "geometry"), "mesh", mesh)
    return element


def _origin(parent: Any, T: SE3) -> None:
    child(parent, "origin", {"xyz": numbers(rounded(T.translation)), "rpy": numbers(rounded_angles(rpy(T)))})


def _joints(root: Any, joint: LoweredJoint, follows: dict[str, Follows], keeper: _Keeper) -> None:
    """Write a joint as a chain of one-freedom joints over its carriers."""
    if not joint.freedoms:
        element = child(root, "joint", {"name": joint.name, "type": "floating" if joint.is_free else "fixed"})
        _ends(element, joint.T_parent_joint, joint.parent, _end(joint))
        _fix_to_end(root, joint)
        return
    links = [joint.parent, *joint.carriers[: _carrier_count(joint)], _end(joint)]
    T = joint.T_parent_joint
    for freedom, near, far in zip(joint.freedoms, links[:-1], links[1:], strict=True):
        element = child(root, "joint", {"name": freedom.name, "type": _type(freedom)})
        _ends(element, T, near, far)
        child(element, "axis", {"xyz": numbers(rounded(freedom.axis))})
        limit = _limit(freedom, keeper)
        if limit:
            child(element, "limit", limit)
        child(element, "dynamics", {"damping": number(freedom.load.damping), "friction": number(freedom.load.friction)})
        if freedom.name in follows:
            tie = follows[freedom.name]
            child(element, "mimic", {"joint": tie.leader, "multiplier": number(tie.ratio), "offset": number(tie.offset)})
        T = SE3.identity()
    _fix_to_end(root, joint)


def _end(joint: LoweredJoint) -> str:
    """Return the link that the joint moves: its child, or a bare link to which the child is fixed."""
    return joint.child if joint.end is None else joint.carriers[-1]


def _fix_to_end(root: Any, joint: LoweredJoint) -> None:
    """Fix the child link to the bare link that the joint moves, if its own frame is elsewhere."""
    if joint.end is not None:
        name, T = joint.end
        _ends(child(root, "joint", {"name": name, "type": "fixed"}), T, _end(joint), joint.child)


def _ends(element: Any, T_parent_joint: SE3, parent: str, child_link: str) -> None:
    _origin(element, T_parent_joint)
    child(element, "parent", {"link": parent})
    child(element, "child", {"link": child_link})


def _type(freedom: AxisMotion) -> str:
    if freedom.kind == "slide":
        return "prismatic"
    return "continuous" if math.isinf(freedom.lower) and math.isinf(freedom.upper) else "revolute"


def _limit(freedom: AxisMotion, keeper: _Keeper) -> dict[str, str]:
    bounds: dict[str, str] = {}
    if _says_no_limit(freedom, keeper):
        return bounds
    if _type(freedom) != "continuous":
        lower, upper = freedom.finite_range  # URDF has no endless prismatic joint
        bounds = {"lower": number(lower), "upper": number(upper)}
    return bounds | {"effort": number(freedom.load.effort), "velocity": number(freedom.load.velocity)}


def _isaac(root: Any, loop: LoweredJoint, point: TiedPoint) -> None:
    """Write a point constraint of Isaac Sim's importer."""
    element = child(root, "loop_joint", {"name": f"{loop.name}{point.suffix}", "type": "spherical"})
    for tag, link, T in (("link1", loop.parent, point.near), ("link2", loop.child, point.far)):
        child(element, tag, {"link": link, "xyz": numbers(rounded(T.translation)), "rpy": numbers(rounded_angles(rpy(T)))})


def _drake(root: Any, loop: LoweredJoint, point: TiedPoint) -> None:
    """Write a point constraint of Drake's parser."""
    element = child(root, f"{{{DRAKE}}}ball_constraint")
    for tag, link in (("body_A", loop.parent), ("body_B", loop.child)):
        child(element, f"{{{DRAKE}}}ball_constraint_{tag}", {"name": link})
    for tag, T in (("p_AP", point.near), ("p_BQ", point.far)):
        child(element, f"{{{DRAKE}}}ball_constraint_{tag}", {"value": numbers(rounded(T.translation))})


def _loop_features(model: LoweredModel, loops: Loops, tied: Mapping[str, tuple[TiedPoint, ...]]) -> list[Feature]:
    """Return the model's features with the losses of its loops."""
    written = {f"joints.{loop.joint.name}": bool(tied.get(loop.name)) for loop in model.loops}
    key = "loop.mimic" if loops == "mimic" else "loop.points"
    keep = loops == "mimic"
    return [
        feature._replace(key=key) if feature.key == "loop" and (keep or written[feature.where]) else feature for feature in model.features
    ]


def _skipped(assembly: Assembly, model: LoweredModel) -> set[Pair]:
    """Return the pairs that readers skip by themselves: parent and child without a carrier between, and parts that never move."""
    joints, order = assembly.mechanism.joints, assembly.mechanism.parts
    chained = {frozenset((joint.joint.parent, joint.joint.child)) for joint in model.joints if len(joint.freedoms) > 1}
    return {pair for pair in mating_pairs(joints, order) if frozenset(pair) not in chained} | same_group_pairs(joints, order)
