"""MJCF: bodies, joints and equality constraints for MuJoCo."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from lxml import etree

from articad.connectors.se3 import SE3
from articad.export.bundle import Bundle
from articad.export.closing import has_limits, tied_points
from articad.export.collisions import Collision, collide, contact_feature
from articad.export.features import rigid_with_ground
from articad.export.hulls import HullOverlap, Pair, mating_pairs, same_group_pairs
from articad.export.inertia import Inertial
from articad.export.loads import GRAVITY_M_S2
from articad.export.losses import Feature, assumed_finding, kept_losses, losses_of, refuse
from articad.export.lowering import (
    Follows,
    Freedom,
    Link,
    LoweredJoint,
    LoweredModel,
    Placed,
    ball_total_angle,
    lower,
    metres,
)
from articad.export.markup import child, document, number, numbers, rgba, wxyz
from articad.export.meshes import MM_TO_M, MeshFiles, MeshKind
from articad.export.metadata import dumps, records
from articad.export.names import Names
from articad.findings import Findings
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Primitive
from articad.kernels.cache import BuildCache
from articad.kinematics.joints import JointType

if TYPE_CHECKING:
    from articad.assembly import Assembly, Kept

RESERVED = ("world",)  # the name of MuJoCo's own root body
FAR_RAD = 1e6  # stands for an open end of a range that has another end
FAR_M = 1e3
LEAST_VOLUME_MM3 = 1e-3  # below it MuJoCo calls a mesh too small to measure
STL_TRIANGLES = 200_000  # MuJoCo refuses larger STL files; OBJ has no such bound
TIMESTEP_S = 0.002
EQUALITY = {"solref": "0.004 1", "solimp": "0.9999 0.9999 0.001"}  # as stiff as the time step allows: MuJoCo's default sags visibly
SERVO_ERROR_TURN = 0.05  # rad by which a servo is off at full effort
SERVO_ERROR_SLIDE = 0.005  # m, likewise
ROTOR_SHARE = 0.01  # of what a driven joint moves: the inertia of a motor's rotor as seen through its gears
FRICTION_SPIN, FRICTION_ROLL = 0.005, 0.0001  # MuJoCo's defaults beside the sliding friction [m]


def write_mjcf(
    assembly: Assembly,
    *,
    strict: bool = False,
    meshes: MeshKind = "stl",
    actuators: bool = False,
    collision: Collision = "solid",
    cache: BuildCache | None = None,
) -> Bundle:
    """Write an assembly as MJCF.

    Body frames are joint frames, the one base body is the ground part, and every joint's value is ours in rad or m, so all zero is q = 0;
    the key `home` is the rest pose. Loops are closed by equality constraints between sites.
    Parts that share a joint do not collide with each other, nor do parts that hulls bring into contact, at rest or in motion, where the
    solids are apart.

    Args:
        assembly: What to write.
        strict: Refuse what MJCF holds only with a loss of motion, mass or shape.
        meshes: Format of the mesh files: STL holds single precision, OBJ nine digits.
        actuators: Give every driver a position servo of the joint's effort, and its joint the inertia of a rotor.
        collision: Collide with the parts' own meshes, of which MuJoCo takes the hulls ("solid"), with their hulls, or with convex pieces
            that are cut until they add no contact; the error of both is told.
        cache: Keeps convex pieces by shape; that of built parts by default.

    Returns:
        `<name>.xml`, `meshes/…`, and the losses.

    Raises:
        UnrepresentableError: If `strict` and there is such a loss.
    """
    model, contacts = collide(assembly, lower(assembly, RESERVED), collision, _skipped(assembly), cache)
    zero = [row.joint.name for row in model.joints if any(_no_force(freedom) for freedom in row.freedoms)]
    nested = [row.joint.name for row in model.joints if row.is_free and _is_nested(row, assembly)]
    features = [
        *model.features,
        *(Feature("free.nested", f"joints.{name}") for name in nested),
        *map(contact_feature, contacts),
        *(Feature("effort.zero", f"joints.{name}") for name in zero),
    ]
    losses = (*losses_of("mjcf", features), *kept_losses("mjcf", assembly.kept, _kept_of_joints(assembly, model).values()))
    if strict:
        refuse(losses)
    writer = _Writer(assembly, model, MeshFiles(meshes))
    root = writer.document(contacts, actuators=actuators)
    assumed = [] if assembly.foreign else [row.joint.name for row in model.joints if any(freedom.load.assumed for freedom in row.freedoms)]
    return Bundle({f"{model.name}.xml": document(root), **writer.files.files}, losses, Findings(assumed_finding(assumed, "mjcf")))


class _Writer:
    """Builds one document; holds what its sections share."""

    def __init__(self, assembly: Assembly, model: LoweredModel, files: MeshFiles) -> None:
        self.assembly, self.model, self.files = assembly, model, files
        self.sites = Names()
        self.asset: Any = None
        self.bodies: dict[str, Any] = {}
        self.assets: dict[str, str] = {}
        self.ghosts: dict[str, Inertial] = {}
        self.qpos: dict[str, list[float]] = {}

    def document(self, contacts: Sequence[HullOverlap], *, actuators: bool) -> Any:
        root = etree.Element("mujoco", model=self.model.name)
        child(root, "compiler", {"angle": "radian", "autolimits": "true", "inertiafromgeom": "false", "balanceinertia": "false"})
        child(root, "option", {"timestep": number(TIMESTEP_S), "gravity": numbers([0, 0, -GRAVITY_M_S2]), "integrator": "implicitfast"})
        _defaults(root)
        self.asset = child(root, "asset")
        self._materials()
        world = child(root, "worldbody")
        self._bodies(world)
        places = {joint.get("name"): joint for joint in world.iter("joint", "freejoint")}
        for name, kept in _kept_of_joints(self.assembly, self.model).items():
            if places[name].tag == "freejoint":  # which has no attributes for dynamics
                places[name].tag = "joint"
                places[name].set("type", "free")
            places[name].attrib.update(etree.fromstring(kept.xml).attrib)
        self._exclusions(root, contacts)
        self._equalities(root)
        servos = self._actuators(root, world) if actuators else []
        self._home(root, world, servos)
        custom = child(root, "custom")
        for number_, record in enumerate(records(self.assembly, self.model, self.files.by_digest, [world, *root.iterfind("equality")])):
            child(custom, "text", {"name": f"articad.{number_}.{record['kind']}", "data": dumps(record)})
        if not len(self.asset):
            root.remove(self.asset)
        return root

    # ------------------------------------------------------------------ bodies

    def _materials(self) -> None:
        colors = dict.fromkeys(placed.color for link in self.model.links for placed in link.visuals)
        for color in colors:
            child(self.asset, "material", {"name": _material(color), "rgba": rgba(color)})

    def _bodies(self, world: Any) -> None:
        carried = {joint.child: joint for joint in self.model.joints}
        inertials = self._inertials()
        zero: dict[str, SE3] = {}  # where each body stands when all values are zero
        rest = self.assembly.mechanism.rest_poses()
        for link in self.model.links:
            joint = carried.get(link.name)
            place = SE3.identity() if joint is None else joint.T_parent_joint
            zero[link.name] = place if joint is None else zero[joint.parent] @ place
            parent = world if joint is None else self.bodies[joint.parent]
            if joint is not None and joint.is_free:  # MuJoCo wants it in the world
                parent, place = world, zero[link.name]
                T = metres(rest[link.part.name]) @ link.T_link_part.inverse() if _is_nested(joint, self.assembly) else place @ joint.T_rest
                self.qpos[joint.name] = [*T.translation.tolist(), *wxyz(T)]
            body = child(parent, "body", {"name": link.name} | ({} if joint is None else _placement(place)))
            self.bodies[link.name] = body
            inertial = inertials[link.name]
            if inertial is not None:
                _inertial(body, inertial)
            if joint is not None:
                self._joints(body, joint)
            self._geoms(body, link)
            for connector in link.part.connectors.values():
                self._site(body, f"{link.name}__{connector.name}", link.T_link_part @ metres(connector.frame))

    def _inertials(self) -> dict[str, Inertial | None]:
        """Return each link's inertia; ghosts of loops get half of the part that they stand for.

        MuJoCo's constraints are the softer, the lighter the bodies that they tie, so a ghost must not be much lighter than its part.
        """
        found = {link.name: link.inertial or (Inertial.carrier() if link.moves else None) for link in self.model.links}
        for loop in self.model.loops:
            whole = found[loop.child]
            if not _needs_ghost(loop):
                continue
            self.ghosts[loop.name] = Inertial.carrier()
            if whole is not None:
                found[loop.child], self.ghosts[loop.name] = whole.halved(loop.T_child_joint)
        return found

    def _joints(self, body: Any, joint: LoweredJoint) -> None:
        if joint.is_free:
            child(body, "freejoint", {"name": joint.name})
            return
        if joint.joint.type is JointType.BALL:
            attributes = {"name": joint.name, "type": "ball"}
            total = ball_total_angle(joint.joint)
            if total < math.pi:
                attributes["range"] = numbers([0, total])
            child(body, "joint", attributes | _dynamics(joint.freedoms[0]))
            R = SE3.from_quaternion(joint.joint.rest)
            self.qpos[joint.name] = list(wxyz(R.inverse() if joint.backwards else R))
            return
        for freedom in joint.freedoms:
            child(body, "joint", _joint(freedom, foreign=self.assembly.foreign))
            self.qpos[freedom.name] = [freedom.rest]

    def _geoms(self, body: Any, link: Link) -> None:
        for placed in link.visuals:
            geom = {"class": "visual"} | self._form(placed, link.name) | {"material": _material(placed.color)}
            child(body, "geom", geom | _placement(placed.T_link_shape))
        friction = {} if link.friction is None else {"friction": numbers([link.friction, FRICTION_SPIN, FRICTION_ROLL])}
        for placed in link.collisions:
            child(body, "geom", {"class": "collision"} | self._form(placed, link.name) | friction | _placement(placed.T_link_shape))

    def _form(self, placed: Placed, name: str) -> dict[str, str]:
        """Return the attributes of a geom that say its shape: a primitive body, or a mesh."""
        form = placed.shape.primitive
        if form is None:
            return {"mesh": self._mesh(placed, name)}
        self.files.path(placed.shape.mesh, name)  # the records name it
        return {"type": form.kind, "size": numbers(_half_sizes(form))}

    def _mesh(self, placed: Placed, name: str) -> str:
        """Return the name of the asset that is this mesh, adding it if it is new."""
        mesh = placed.shape.mesh
        path = self.files.path(mesh, name, "obj" if len(mesh.triangles) > STL_TRIANGLES else None)
        asset = path.removeprefix(f"{self.files.folder}/").rpartition(".")[0]
        if path not in self.assets:
            self.assets[path] = asset
            child(self.asset, "mesh", {"name": asset, "file": path, "scale": numbers([MM_TO_M] * 3)} | _mesh_inertia(mesh))
        return asset

    def _site(self, body: Any, name: str, T: SE3) -> str:
        claimed = self.sites.claim(name)
        child(body, "site", {"name": claimed} | _placement(T))
        return claimed

    # ------------------------------------------------------------------ relations

    def _exclusions(self, root: Any, contacts: Sequence[HullOverlap]) -> None:
        links = {link.part.name: link for link in self.model.links}
        mating = mating_pairs(self.assembly.mechanism.joints, self.assembly.mechanism.parts)
        pairs = dict.fromkeys([*mating, *(contact.parts for contact in contacts)])
        if pairs:
            contact = child(root, "contact")
            for a, b in pairs:
                child(contact, "exclude", {"body1": links[a].name, "body2": links[b].name})

    def _equalities(self, root: Any) -> None:
        """Tie what the tree of bodies does not: loops by sites, screws and couplings by their joints."""
        equality = etree.SubElement(root, "equality")
        for joint in (*self.model.joints, *self.model.loops):
            for freedom in joint.freedoms:
                if freedom.follows is not None and freedom.name in self.qpos:
                    _tie(equality, freedom.name, freedom.name, freedom.follows)
        for loop in self.model.loops:
            self._close(equality, loop)
        for name, follower, follows in self.model.couplings:
            if {follower, follows.leader} <= self.qpos.keys():
                _tie(equality, name, follower, follows)
        if not len(equality):
            root.remove(equality)

    def _close(self, equality: Any, loop: LoweredJoint) -> None:
        """Close a loop: a point for a ball, two points on the axis for an endless hinge, all six directions through a ghost for others."""
        near, far = self.bodies[loop.parent], self.bodies[loop.child]
        if loop.is_free:
            return
        if loop.joint.type is JointType.FIXED:
            self._tie_sites(equality, "weld", loop.name, (near, loop.T_parent_joint), (far, loop.T_child_joint))
        elif not _needs_ghost(loop):
            for point in tied_points(self.model, loop):
                self._tie_sites(equality, "connect", f"{loop.name}{point.suffix}", (near, point.near), (far, point.far))
        else:
            ghost = child(near, "body", {"name": loop.carriers[-1]} | _placement(loop.T_parent_joint))
            _inertial(ghost, self.ghosts[loop.name])
            for freedom in loop.freedoms:
                child(ghost, "joint", _joint(freedom, foreign=self.assembly.foreign))
                self.qpos[freedom.name] = [freedom.rest]
                if freedom.follows is not None:
                    _tie(equality, freedom.name, freedom.name, freedom.follows)
            self._tie_sites(equality, "weld", loop.name, (ghost, SE3.identity()), (far, loop.T_child_joint))

    def _tie_sites(self, equality: Any, kind: str, name: str, near: tuple[Any, SE3], far: tuple[Any, SE3]) -> None:
        site1, site2 = (self._site(body, f"{name}__{side}", T) for side, (body, T) in (("near", near), ("far", far)))
        child(equality, kind, {"name": name, "site1": site1, "site2": site2} | EQUALITY)

    def _actuators(self, root: Any, world: Any) -> list[Freedom]:
        """Add a position servo and a rotor for every driver but balls; return the driven freedoms."""
        driven = {driver.name for driver in self.assembly.mechanism.drivers}
        freedoms = [freedom for joint in (*self.model.joints, *self.model.loops) for freedom in joint.freedoms]
        freedoms = [freedom for freedom in freedoms if freedom.column in driven and freedom.name in self.qpos]
        if freedoms:
            actuator = child(root, "actuator")
            joints = {joint.get("name"): joint for joint in world.iter("joint")}
            for freedom in freedoms:
                if joints[freedom.name].get("armature") is None:
                    joints[freedom.name].set("armature", number(ROTOR_SHARE * freedom.load.carried))
                child(actuator, "position", _servo(freedom))
        return freedoms

    def _home(self, root: Any, world: Any, servos: list[Freedom]) -> None:
        values = [value for joint in world.iter("joint", "freejoint") for value in self.qpos[joint.get("name")]]
        if values:
            key = {"name": "home", "qpos": numbers(values)} | ({"ctrl": numbers(servo.rest for servo in servos)} if servos else {})
            child(child(root, "keyframe"), "key", key)


def _defaults(root: Any) -> None:
    default = child(root, "default")
    visual = child(default, "default", {"class": "visual"})
    child(visual, "geom", {"type": "mesh", "contype": "0", "conaffinity": "0", "group": "2"})
    collision = child(default, "default", {"class": "collision"})
    child(collision, "geom", {"type": "mesh", "group": "3"})
    child(default, "site", {"size": "0.002", "group": "4"})


def _material(color: str) -> str:
    return f"color_{color.removeprefix('#')}"


def _placement(T: SE3) -> dict[str, str]:
    return {"pos": numbers(T.translation), "quat": numbers(wxyz(T))}


def _inertial(body: Any, inertial: Inertial) -> None:
    inertial = inertial.inside_bounds()
    I = inertial.inertia
    moments = [I[0, 0], I[1, 1], I[2, 2], I[0, 1], I[0, 2], I[1, 2]]
    child(body, "inertial", {"pos": numbers(inertial.com), "mass": number(inertial.mass), "fullinertia": numbers(moments)})


def _kept_of_joints(assembly: Assembly, model: LoweredModel) -> dict[str, Kept]:
    """Return what an MJCF file said of joints that are one joint again, by the name in what is written."""
    names = {
        f"joints.{row.joint.name}": row.name for row in model.joints if len(row.freedoms) == 1 or row.joint.type.quaternion is not None
    }
    return {names[item.where]: item for item in assembly.kept if item.format == "mjcf" and item.xml and item.where in names}


def _half_sizes(form: Primitive) -> list[float]:
    """Return the sizes of a geom [m]: MuJoCo halves what has two ends."""
    sizes = [size * MM_TO_M for size in form.size]
    if form.kind == "box":
        return [size / 2 for size in sizes]
    return [sizes[0], sizes[1] / 2] if form.kind in {"cylinder", "capsule"} else sizes


def _no_force(freedom: Freedom) -> bool:
    """True for a stated effort of zero: MuJoCo reads the range from 0 to 0 as none."""
    return freedom.load.effort == 0 and "effort" not in freedom.load.assumed


def _dynamics(freedom: Freedom) -> dict[str, str]:
    friction = {"frictionloss": number(freedom.load.friction)} if freedom.load.friction else {}
    return {"damping": number(freedom.load.damping)} | friction


def _joint(freedom: Freedom, *, foreign: bool = False) -> dict[str, str]:
    """Return the attributes of a hinge or slide; the effort limits what actuators give it, where a foreign file states one."""
    turn = freedom.kind == "turn"
    attributes = {"name": freedom.name, "type": "hinge" if turn else "slide", "axis": numbers(freedom.axis)}
    bounds = _range(freedom)
    if bounds is not None:
        attributes["range"] = bounds
    effort = freedom.load.effort
    if not effort > 0 or (foreign and "effort" in freedom.load.assumed):
        return attributes | _dynamics(freedom)
    return attributes | {"actuatorfrcrange": numbers([-effort, effort])} | _dynamics(freedom)


def _range(freedom: Freedom) -> str | None:
    if math.isinf(freedom.lower) and math.isinf(freedom.upper):
        return None
    far = FAR_RAD if freedom.kind == "turn" else FAR_M
    return numbers([max(freedom.lower, -far), min(freedom.upper, far)])


def _servo(freedom: Freedom) -> dict[str, str]:
    effort = freedom.load.effort
    gain = effort / (SERVO_ERROR_TURN if freedom.kind == "turn" else SERVO_ERROR_SLIDE)
    attributes = {"name": freedom.name, "joint": freedom.name, "kp": number(gain), "dampratio": "1"}
    bounds = _range(freedom)
    if bounds is not None:
        attributes["ctrlrange"] = bounds
    return attributes | {"forcerange": numbers([-effort, effort])}


def _tie(equality: Any, name: str, follower: str, follows: Follows) -> None:
    """Write q_follower = ratio · q_leader + offset."""
    polynomial = numbers([follows.offset, follows.ratio, 0, 0, 0])
    child(equality, "joint", {"name": name, "joint1": follower, "joint2": follows.leader, "polycoef": polynomial} | EQUALITY)


def _needs_ghost(loop: LoweredJoint) -> bool:
    """True for joints that points alone cannot hold, or whose limits must hold: a body with the joint is welded to the other side."""
    kind = loop.joint.type
    if kind is JointType.REVOLUTE:
        return has_limits(loop)
    return kind not in {JointType.BALL, JointType.FIXED, JointType.FREE}


def _is_nested(joint: LoweredJoint, assembly: Assembly) -> bool:
    """True for a free joint whose parent is not the world or fixed to it."""
    return joint.joint.parent not in rigid_with_ground(assembly)


def _mesh_inertia(mesh: TriMesh) -> dict[str, str]:
    """Tell MuJoCo not to measure the volume of a mesh that has none; the body's inertia is written anyway."""
    return {} if mesh.is_closed and mesh.volume > LEAST_VOLUME_MM3 else {"inertia": "shell"}


def _skipped(assembly: Assembly) -> set[Pair]:
    """Return the pairs that do not collide in MuJoCo: those that share a joint, which are excluded, and what never moves apart."""
    joints, order = assembly.mechanism.joints, assembly.mechanism.parts
    return set(mating_pairs(joints, order)) | same_group_pairs(joints, order)
