"""MJCF: bodies, joints and equality constraints for MuJoCo."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from lxml import etree

from articad.connectors.se3 import SE3
from articad.export.bundle import Bundle
from articad.export.closing import has_limits, tied_points
from articad.export.collisions import Collision, adjacent, collide, contact_feature, excuse, kind_of, lying
from articad.export.features import rigid_with_ground
from articad.export.hulls import HullOverlap, Pair, mating_pairs, same_group_pairs
from articad.export.inertia import Inertial
from articad.export.loads import GRAVITY_M_S2
from articad.export.losses import Feature, assumed_finding, kept_losses, losses_of, refuse
from articad.export.lowering import (
    AxisMotion,
    Follows,
    Link,
    LoweredJoint,
    LoweredModel,
    Placed,
    ball_total_angle,
    ground_is_world,
    lower,
    metres,
)
from articad.export.markup import child, comment, document, number, numbers, rgba, rounded, tidy, wxyz
from articad.export.meshes import MM_TO_M, MeshFiles, MeshKind
from articad.export.metadata import dumps, records
from articad.export.mjcf_again import Again
from articad.export.names import Names
from articad.export.product import of_the_product
from articad.findings import Findings
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Primitive
from articad.kernels.cache import BuildCache
from articad.kinematics.joints import JointType

if TYPE_CHECKING:
    from articad.assembly import Assembly

Actuators = Literal["position", "motor"]

RESERVED = ("world",)  # the name of MuJoCo's own root body
LEAST_RANGE = 1e-9  # rad or m: MuJoCo takes a range without width as no limit at all
LEAST_VOLUME_MM3 = 1e-3  # MuJoCo reports a smaller mesh as too small to measure
STL_TRIANGLES = 200_000  # MuJoCo refuses larger STL files; OBJ has no such limit
TIMESTEP_S = 0.002
EQUALITY = {"solref": "0.004 1", "solimp": "0.9999 0.9999 0.001"}  # as stiff as the time step allows: the defaults sag visibly
SERVO_ERROR_TURN = 0.05  # rad: error of a servo at full effort
SERVO_ERROR_SLIDE = 0.005  # m, likewise
ROTOR_SHARE = 0.01  # of the moved inertia: the inertia of a motor's rotor as seen through its gears
FRICTION_SPIN, FRICTION_ROLL = 0.005, 0.0001  # MuJoCo's defaults for the other two friction coefficients [m]


@of_the_product
def write_mjcf(
    assembly: Assembly,
    *,
    strict: bool = False,
    meshes: MeshKind = "stl",
    actuators: Actuators | None = None,
    collision: Collision | None = None,
    cache: BuildCache | None = None,
) -> Bundle:
    """Write an assembly as MJCF.

    Body frames are joint frames, the one base body is the ground part, and every joint's value equals articad's in rad or m, so all zero
    is q = 0; the key `home` is the rest pose. Loops are closed by equality constraints between sites.
    Parts that share a joint do not collide with each other, nor do parts fixed to these that touch at rest, nor parts whose solids overlap
    at rest; a comment gives the reason. With
    meshes or hulls for collision, pairs whose hulls meet where the solids do not are excluded as well.

    Args:
        assembly: What to write.
        strict: Refuse what MJCF holds only with a loss of motion, mass or shape.
        meshes: Format of the mesh files: STL has single precision, OBJ nine digits.
        actuators: Give every driver a position servo ("position") or a motor that takes forces ("motor") of the joint's effort, and its
            joint the inertia of a rotor. A servo reaches its full effort when it is 0.05 rad or 5 mm off, and is critically damped for the
            inertia that it moves.
        collision: Collide with convex pieces inside the parts ("pieces"), with the parts' own meshes ("solid"), of which engines use the
            hulls, or with hulls ("hull"). By default pieces; for a file that articad did not write, its own shapes.
        cache: Stores convex pieces by shape; the cache of built parts by default.

    Returns:
        `<name>.xml`, `meshes/…`, and the losses.

    Raises:
        UnrepresentableError: If `strict` and there is such a loss.
    """
    again = Again(assembly)
    model = _lowered(assembly, again)
    contacts: tuple[HullOverlap, ...] = ()
    if not (again.active and kind_of(assembly, collision) == "solid"):  # the file decides what collides in it
        model, contacts = collide(assembly, model, collision, _skipped(assembly), cache)
    writer = _Writer(assembly, model, MeshFiles(meshes, draws=kind_of(assembly, collision) != "solid", cache=cache), again)
    root = writer.document(contacts, actuators=actuators)
    zero = [row.joint.name for row in model.joints if any(_no_force(freedom) for freedom in row.freedoms)]
    nested = [row.joint.name for row in model.joints if row.is_free and _is_nested(row, assembly)]
    features = [
        *writer.features(),
        *(Feature("free.nested", f"joints.{name}") for name in nested),
        *map(contact_feature, contacts),
        *(Feature("effort.zero", f"joints.{name}") for name in zero),
    ]
    losses = (*losses_of("mjcf", features), *kept_losses("mjcf", assembly.kept, again.written))
    if strict:
        refuse(losses)
    assumed = [] if assembly.foreign else [row.joint.name for row in model.joints if any(freedom.load.assumed for freedom in row.freedoms)]
    return Bundle({f"{model.name}.xml": document(root), **writer.files.files}, losses, Findings(assumed_finding(assumed)))


def mechanism_elements(root: Any) -> list[Any]:
    """Return the elements of an MJCF document that state the mechanism: bodies, constraints, and the settings that change what they mean."""
    return [element for path in ("compiler", "default", ".//include", "worldbody", "equality") for element in root.iterfind(path)]


def rewritten(assembly: Assembly) -> Iterator[tuple[list[Any], dict[str, str]]]:
    """Yield what `write_mjcf` states of the mechanism, without and with rotors of actuators, and the digests of the meshes by name."""
    choices: tuple[Actuators | None, ...] = (None, "position")  # "motor" writes the same rotors
    for actuators in choices:
        again = Again(assembly)
        model = _lowered(assembly, again)
        writer = _Writer(assembly, model, MeshFiles(), again)
        root = writer.content((), actuators=actuators)
        yield (
            mechanism_elements(root),
            {writer.assets[path]: digest for digest, path in writer.files.by_digest.items() if path in writer.assets},
        )


def _lowered(assembly: Assembly, again: Again) -> LoweredModel:
    return lower(assembly, () if again.active or _starts_at_world(assembly) else RESERVED, as_it_came=assembly.foreign)


def _starts_at_world(assembly: Assembly) -> bool:
    return assembly.foreign and ground_is_world(assembly)


class _Writer:
    """Builds one document; has what its sections share."""

    def __init__(self, assembly: Assembly, model: LoweredModel, files: MeshFiles, again: Again) -> None:
        self.assembly, self.model, self.files, self.again = assembly, model, files, again
        files.expect(link.part for link in model.links)
        self.sites = Names(again.names("site"))
        self.asset: Any = None
        self.bodies: dict[str, Any] = {}
        self.assets: dict[str, str] = {}
        self.ghosts: dict[str, Inertial] = {}
        self.qpos: dict[str, list[float]] = {}
        self.between: set[str] = set()
        self.exact: set[str] = set()
        self.weighed: set[str] = set()
        self.added: list[Feature] = []
        self.controls: Actuators | None = None

    def features(self) -> list[Feature]:
        """Return the features of the model that apply to the document: steps between two joints of a body do not."""
        said = [feature for feature in self.model.features if feature.where not in self.between]
        said = [feature for feature in said if not (feature.key == "ball" and feature.where in self.exact)]
        return [*(feature for feature in said if not (feature.key == "mass.missing" and feature.where in self.weighed)), *self.added]

    def document(self, contacts: Sequence[HullOverlap], *, actuators: Actuators | None) -> Any:
        root = self.content(contacts, actuators=actuators)
        custom = child(root, "custom")
        written = [*root.iterfind("worldbody"), *root.iterfind("equality")]
        for number_, record in enumerate(records(self.assembly, self.model, self.files, written)):
            child(custom, "text", {"name": f"articad.{number_}.{record['kind']}", "data": dumps(record)})
        return root

    def content(self, contacts: Sequence[HullOverlap], *, actuators: Actuators | None) -> Any:
        """Return the document without records."""
        root = etree.Element("mujoco", model=self.assembly.name if self.assembly.foreign else self.model.name)
        child(root, "compiler", {"angle": "radian", "autolimits": "true", "inertiafromgeom": "false", "balanceinertia": "false"})
        if not self.again.active:
            child(root, "option", {"timestep": number(TIMESTEP_S), "gravity": numbers([0, 0, -GRAVITY_M_S2]), "integrator": "implicitfast"})
            _defaults(root)
        self.asset = child(root, "asset")
        if not self.again.active:
            self._materials()
        world = child(root, "worldbody")
        self._bodies(world)
        self._exclusions(root, contacts)
        self._equalities(root)
        self.controls = actuators
        servos = self._actuators(root, world, actuators) if actuators else []
        if self.again.active:
            self.again.drop_unknown_targets(root)
            self.again.sections(root, same_joints=self._has_the_files_joints(world))
        self._home(root, world, servos)
        if not len(self.asset):
            root.remove(self.asset)
        return root

    def _has_the_files_joints(self, world: Any) -> bool:
        """True if the joints are those of the file, in its order, so that the values of its keys are valid."""
        closing = {joint.name for joint in self.assembly.mechanism.loop_joints}
        moving = [joint.name for joint in self.assembly.joints if joint.type is not JointType.FIXED and joint.name not in closing]
        return [joint.get("name") for joint in world.iter("joint", "freejoint")] == moving

    # ------------------------------------------------------------------ bodies

    def _materials(self) -> None:
        colors = dict.fromkeys(placed.color for link in self.model.links for placed in link.visuals)
        for color in colors:
            child(self.asset, "material", {"name": _material(color), "rgba": rgba(color)})

    def _bodies(self, world: Any) -> None:
        carried = {joint.child: joint for joint in self.model.joints}
        inertials = self._inertials()
        zero: dict[str, SE3] = {}  # pose of each link when all values are zero
        chains: dict[str, tuple[LoweredJoint, ...]] = {}  # over bare links of an MJCF file, which are several joints of one body
        for link in self.model.links:
            joint = carried.get(link.name)
            chain = () if joint is None else (*chains.get(joint.parent, ()), joint)
            zero[link.name] = SE3.identity() if joint is None else zero[joint.parent] @ joint.T_parent_joint
            if self.again.active and joint is not None and self._is_between(link, chain):
                chains[link.name] = chain
                self.between.add(f"parts.{link.part.name}")
                continue
            if joint is not None and joint.is_free:
                body = self._free_body(world, link, joint, zero[link.name])
            else:
                body = world if joint is None and self._is_world(link) else self._body(world, link, chain)
            self.bodies[link.name] = body
            inertial = inertials[link.name]
            if inertial is not None:
                _inertial(body, inertial)
            for one in chain:
                self._joints(body, one)
            self._geoms(body, link)
            self.files.keep_all(link.part, link.name)
            if self.again.active:
                body.attrib.update(self.again.attributes(f"parts.{link.part.name}", "body"))
                self.again.below(f"parts.{link.part.name}", body)
            if self.assembly.foreign:
                continue
            for connector in link.part.connectors.values():
                self._site(body, f"{link.name}__{connector.name}", link.T_link_part @ metres(connector.frame))

    def _free_body(self, world: Any, link: Link, joint: LoweredJoint, place: SE3) -> Any:
        """Return the element of a floating body, at its pose for zero values; MuJoCo requires it to be in the world."""
        T = place @ joint.T_rest
        if _is_nested(joint, self.assembly):
            T = metres(self.assembly.mechanism.rest_poses()[link.part.name]) @ link.T_link_part.inverse()
        self.qpos[joint.name] = [*rounded(T.translation), *wxyz(T)]
        return child(world, "body", {"name": link.name} | _placement(place))

    def _body(self, world: Any, link: Link, chain: tuple[LoweredJoint, ...]) -> Any:
        """Return the element of a body, at its pose when every joint has the value `ref`."""
        if not chain:
            return child(world, "body", {"name": link.name})
        T = SE3.identity()
        for joint in chain:
            T = T @ joint.T_parent_joint @ self._reference(joint)
        return child(self.bodies[chain[0].parent], "body", {"name": link.name} | _placement(T))

    def _is_world(self, link: Link) -> bool:
        """True for the ground of a file if it is the world."""
        return link.name == "world" and link.inertial is None and (self.again.active or _starts_at_world(self.assembly))

    def _is_between(self, link: Link, chain: tuple[LoweredJoint, ...]) -> bool:
        """True for a link that is only the step from one joint of a body to the next; MuJoCo has no such bodies."""
        part, name = link.part, link.part.name
        joints = [joint for joint in self.assembly.joints if name in {joint.parent, joint.child}]
        bare = part.mass is None and not part.visuals and not part.collisions and len(joints) == 2
        beyond = [row for row in self.model.joints if row.parent == link.name]
        if not bare or len(beyond) != 1 or not chain[-1].freedoms or not beyond[0].freedoms:
            return False
        return (beyond[0].T_parent_joint @ self._reference(beyond[0])).allclose(SE3.identity(), mm=1e-9, rad=1e-9)

    def _reference(self, joint: LoweredJoint) -> SE3:
        """Return the joint's motion from zero to the value `ref`, its value in the file's own pose [m]."""
        if len(joint.freedoms) != 1 or not (ref := self.references.get(joint.joint.name)):
            return SE3.identity()
        axis = joint.freedoms[0].axis
        if joint.freedoms[0].kind == "slide":
            return SE3.from_translation(ref * axis)
        turn = SE3.from_quaternion([*(math.sin(ref / 2) * axis), math.cos(ref / 2)])
        return SE3.from_translation(joint.anchor) @ turn @ SE3.from_translation(-joint.anchor)

    @cached_property
    def references(self) -> dict[str, float]:
        """Values of the joints in the file's own pose [rad or m], if not zero."""
        said = {joint.name: self.again.attributes(f"joints.{joint.name}", "joint").get("ref") for joint in self.assembly.joints}
        return {name: float(text) for name, text in said.items() if text}

    def _inertials(self) -> dict[str, Inertial | None]:
        """Return each link's inertia; a ghost of a loop gets half of its part's inertia.

        The lighter the bodies, the softer MuJoCo's constraints between them, so a ghost must not be much lighter than its part.
        """
        self.weighed = {f"parts.{link.part.name}" for link in self.model.links if self.again.active and self._is_weighed(link.name)}
        found = {
            link.name: link.inertial or (Inertial.carrier() if link.moves and f"parts.{link.part.name}" not in self.weighed else None)
            for link in self.model.links
        }
        for loop in self.model.loops:
            whole = found[loop.child]
            if not _needs_ghost(loop):
                continue
            self.ghosts[loop.name] = Inertial.carrier()
            if whole is not None:
                found[loop.child], self.ghosts[loop.name] = whole.halved(loop.T_child_joint)
        return found

    def _is_weighed(self, name: str) -> bool:
        """True for a link to which something with mass is fixed: MuJoCo then requires no mass of its own."""
        masses = {link.name: link.inertial for link in self.model.links}
        fixed = [row.child for row in self.model.joints if row.parent == name and row.joint.type is JointType.FIXED]
        return any(masses[child] is not None or self._is_weighed(child) for child in fixed)

    def _joints(self, body: Any, joint: LoweredJoint) -> None:
        kept = (
            self.again.attributes(f"joints.{joint.joint.name}", "joint")
            if len(joint.freedoms) == 1 or joint.joint.type.quaternion is not None
            else {}
        )
        if joint.is_free:
            plain = kept.keys() <= {"group"}  # <freejoint> has no attributes for dynamics
            child(body, "freejoint" if plain else "joint", {"name": joint.name} | ({} if plain else {"type": "free"}) | kept)
            return
        anchor = {"pos": numbers(joint.anchor)} if joint.anchor.any() else {}
        if joint.joint.type is JointType.BALL:
            attributes = {"name": joint.name, "type": "ball"} | anchor
            total = ball_total_angle(joint.joint)
            if total < math.pi:
                attributes["range"] = numbers([0, max(total, LEAST_RANGE)])
            if "range" in kept and float(kept["range"].split()[-1]) == joint.joint.limits.cone:
                self.exact.add(f"joints.{joint.joint.name}")
            else:
                kept.pop("range", None)
            child(body, "joint", attributes | _dynamics(joint.freedoms[0]) | kept)
            R = SE3.from_quaternion(joint.joint.rest)
            self.qpos[joint.name] = wxyz(R.inverse() if joint.backwards else R)
            return
        for freedom in joint.freedoms:
            attributes = _joint(freedom, foreign=self.assembly.foreign) | anchor
            child(body, "joint", attributes | (self._still_true(kept, freedom) if len(joint.freedoms) == 1 else {}))
            self.qpos[freedom.name] = [freedom.rest]

    @staticmethod
    def _still_true(kept: dict[str, str], freedom: AxisMotion) -> dict[str, str]:
        """Return the kept attributes of a joint; a range of forces only if its larger end is still the joint's effort."""
        ends = [abs(float(word)) for word in kept.get("actuatorfrcrange", "").split()]
        stale = ends and not math.isclose(max(ends), freedom.load.effort, rel_tol=1e-12)
        return {name: value for name, value in kept.items() if not (stale and name == "actuatorfrcrange")}

    def _geoms(self, body: Any, link: Link) -> None:
        for kind, shapes in (("visuals", link.visuals), ("collisions", link.collisions)):
            for index, placed in enumerate(shapes):
                form, place = self._form(placed, link.name), _placement(placed.T_link_shape)
                if self.again.active:
                    usual = {"type": "mesh"} if "mesh" in form else {}
                    free = {"contype": "0", "conaffinity": "0"} if kind == "visuals" else {}
                    kept = self.again.attributes(f"parts.{link.part.name}.{kind}.{index}", "geom")
                    child(body, "geom", usual | form | place | (kept or free | {"rgba": rgba(placed.color)}))
                elif kind == "visuals":
                    child(body, "geom", {"class": "visual"} | form | {"material": _material(placed.color)} | place)
                else:
                    friction = {} if link.friction is None else {"friction": numbers([link.friction, FRICTION_SPIN, FRICTION_ROLL])}
                    child(body, "geom", {"class": "collision"} | form | friction | place)

    def _form(self, placed: Placed, name: str) -> dict[str, str]:
        """Return the attributes of a geom that state its shape: a primitive, or a mesh."""
        form = placed.shape.primitive
        if form is None:
            return {"mesh": self._mesh(placed, name)}
        self.files.keep(placed.shape.mesh, name)  # for the records
        return {"type": form.kind, "size": numbers(_half_sizes(form))}

    def _mesh(self, placed: Placed, name: str) -> str:
        """Return the name of the asset for this mesh; add it if it is new."""
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
        if self.again.active:
            return
        links = {link.part.name: link for link in self.model.links}
        mating = self._joined()
        on_others = {} if self.assembly.foreign else lying(self.assembly)
        reasons = on_others | {contact.parts: excuse(contact) for contact in contacts}
        reasons |= {pair: adjacent(self.assembly, pair) for pair in mating}
        if self.assembly.foreign:  # without shapes there are no contacts to exclude
            mating = [pair for pair in mating if all(links[part].collisions for part in pair)]
        pairs = dict.fromkeys([*mating, *(contact.parts for contact in contacts), *on_others])
        if self.assembly.foreign:
            self.added += [Feature("contact.joined", "parts." + "+".join(pair)) for pair in mating]
        if pairs:
            contact = child(root, "contact")
            for a, b in pairs:
                contact.append(comment(reasons[a, b]))
                child(contact, "exclude", {"body1": links[a].name, "body2": links[b].name})

    def _joined(self) -> list[Pair]:
        """Return the pairs of parts that share a joint; for a file's assembly only those that MuJoCo would let collide.

        MuJoCo excludes contacts of a body with its parent, unless the parent stands still, and of bodies that never move apart.
        """
        mechanism = self.assembly.mechanism
        pairs = list(mating_pairs(mechanism.joints, mechanism.parts))
        if not self.assembly.foreign:
            return pairs
        still = rigid_with_ground(self.assembly)
        rigid = same_group_pairs(mechanism.joints, mechanism.parts)
        closing = {frozenset((joint.parent, joint.child)) for joint in mechanism.loop_joints}
        return [pair for pair in pairs if pair not in rigid and (frozenset(pair) in closing or still & {*pair})]

    def _equalities(self, root: Any) -> None:
        """Write the constraints that the tree of bodies lacks: loops by sites, screws and couplings by their joints."""
        equality = etree.SubElement(root, "equality")
        for joint in (*self.model.joints, *self.model.loops):
            for freedom in joint.freedoms:
                if freedom.follows is not None and freedom.name in self.qpos:
                    _tie(equality, freedom.name, freedom.name, freedom.follows)
        for loop in self.model.loops:
            if (said := self.again.equality(f"joints.{loop.joint.name}")) is None:
                self._close(equality, loop)
            else:
                equality.append(said)
        for name, follower, follows in self.model.couplings:
            if (said := self.again.equality(f"couplings.{name}")) is not None:
                equality.append(said)
            elif {follower, follows.leader} <= self.qpos.keys():
                _tie(equality, name, follower, follows)
        if not len(equality):
            root.remove(equality)

    def _close(self, equality: Any, loop: LoweredJoint) -> None:
        """Close a loop: one point for a ball, two points on the axis for an endless hinge, a weld to a ghost for others."""
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
            why = f"Closes a loop by joint {loop.joint.name}: half of the mass of {loop.joint.child} is here, welded to the half on its other joint."
            ghost.append(comment(why))
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

    def _actuators(self, root: Any, world: Any, kind: Actuators) -> list[AxisMotion]:
        """Add an actuator and a rotor for every driver except balls; return the driven freedoms."""
        driven = {driver.name for driver in self.assembly.mechanism.drivers}
        freedoms = [freedom for joint in (*self.model.joints, *self.model.loops) for freedom in joint.freedoms]
        freedoms = [freedom for freedom in freedoms if freedom.column in driven and freedom.name in self.qpos]
        if freedoms:
            actuator = child(root, "actuator")
            joints = {joint.get("name"): joint for joint in world.iter("joint")}
            for freedom in freedoms:
                if joints[freedom.name].get("armature") is None:
                    joints[freedom.name].set("armature", number(ROTOR_SHARE * freedom.load.carried))
                child(actuator, kind, _servo(freedom) if kind == "position" else _motor(freedom))
        return freedoms

    def _home(self, root: Any, world: Any, servos: list[AxisMotion]) -> None:
        values = tidy(value for joint in world.iter("joint", "freejoint") for value in self.qpos[joint.get("name")])
        if self.again.active or (self.assembly.foreign and self._rests_at_zero()):  # an MJCF file has keys of its own
            return
        if values:
            if self.assembly.foreign:
                self.added.append(Feature("rest.assumed", "model"))
            key = {"name": "home", "qpos": numbers(values)} | (
                {"ctrl": numbers(servo.rest if self.controls == "position" else 0.0 for servo in servos)} if servos else {}
            )
            child(child(root, "keyframe"), "key", key)

    def _rests_at_zero(self) -> bool:
        """True if every joint rests at zero, where engines start."""
        return all(np.allclose(joint.rest, joint.type.neutral, rtol=0, atol=1e-12) for joint in self.assembly.joints)


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
    return {"pos": numbers(rounded(T.translation)), "quat": numbers(wxyz(T))}


def _inertial(body: Any, inertial: Inertial) -> None:
    """Write mass properties by principal axes, which every reader of MJCF knows: PyBullet ignores `fullinertia`."""
    inertial = inertial.inside_bounds().without_dust()
    moments, axes = inertial.principal()
    quat = wxyz(SE3.from_rotation(axes))
    turned = {"quat": numbers(quat)} if quat[0] != 1 else {}
    child(body, "inertial", {"pos": numbers(inertial.com)} | turned | {"mass": number(inertial.mass), "diaginertia": numbers(moments)})


def _half_sizes(form: Primitive) -> list[float]:
    """Return the sizes of a geom [m]: MuJoCo uses half lengths."""
    sizes = tidy((size * MM_TO_M for size in form.size), scale=0)
    if form.kind == "box":
        return [size / 2 for size in sizes]
    return [sizes[0], sizes[1] / 2] if form.kind in {"cylinder", "capsule"} else sizes


def _no_force(freedom: AxisMotion) -> bool:
    """True for a stated effort of zero: MuJoCo reads the range from 0 to 0 as unlimited."""
    return freedom.load.effort == 0 and "effort" not in freedom.load.assumed


def _dynamics(freedom: AxisMotion) -> dict[str, str]:
    friction = {"frictionloss": number(freedom.load.friction)} if freedom.load.friction else {}
    return {"damping": number(freedom.load.damping)} | friction


def _joint(freedom: AxisMotion, *, foreign: bool = False) -> dict[str, str]:
    """Return the attributes of a hinge or slide; the effort limits the actuators' forces if a foreign file states one."""
    turn = freedom.kind == "turn"
    attributes = {"name": freedom.name, "type": "hinge" if turn else "slide", "axis": numbers(rounded(freedom.axis))}
    bounds = _range(freedom)
    if bounds is not None:  # "limited" follows from the range in MuJoCo, not in PyBullet
        attributes |= {"limited": "true", "range": bounds}
    effort = freedom.load.effort
    if not effort > 0 or (foreign and "effort" in freedom.load.assumed):
        return attributes | _dynamics(freedom)
    return attributes | {"actuatorfrcrange": numbers([-effort, effort])} | _dynamics(freedom)


def _range(freedom: AxisMotion) -> str | None:
    if math.isinf(freedom.lower) and math.isinf(freedom.upper):
        return None
    lower, upper = freedom.finite_range
    width = max(LEAST_RANGE, 8 * math.ulp(lower))
    if upper - lower < width:
        lower, upper = (lower + upper - width) / 2, (lower + upper + width) / 2
    return numbers(tidy([lower, upper]))


def _servo(freedom: AxisMotion) -> dict[str, str]:
    effort = freedom.load.effort
    gain = effort / (SERVO_ERROR_TURN if freedom.kind == "turn" else SERVO_ERROR_SLIDE)
    attributes = {"name": freedom.name, "joint": freedom.name, "kp": number(gain), "dampratio": "1"}
    bounds = _range(freedom)
    if bounds is not None:
        attributes["ctrlrange"] = bounds
    return attributes | {"forcerange": numbers([-effort, effort])}


def _motor(freedom: AxisMotion) -> dict[str, str]:
    """Return a motor whose control is the torque [N·m] or force [N], up to the joint's effort."""
    effort = numbers([-freedom.load.effort, freedom.load.effort])
    return {"name": freedom.name, "joint": freedom.name, "ctrlrange": effort, "forcerange": effort}


def _tie(equality: Any, name: str, follower: str, follows: Follows) -> None:
    """Write q_follower = ratio · q_leader + offset."""
    polynomial = numbers(tidy([follows.offset, follows.ratio, 0, 0, 0]))
    child(equality, "joint", {"name": name, "joint1": follower, "joint2": follows.leader, "polycoef": polynomial} | EQUALITY)


def _needs_ghost(loop: LoweredJoint) -> bool:
    """True for joints that points cannot hold, or whose limits must hold: a body with the joint is welded to the other side."""
    kind = loop.joint.type
    if kind is JointType.REVOLUTE:
        return has_limits(loop)
    return kind not in {JointType.BALL, JointType.FIXED, JointType.FREE}


def _is_nested(joint: LoweredJoint, assembly: Assembly) -> bool:
    """True for a free joint whose parent is not the world or fixed to it."""
    return joint.joint.parent not in rigid_with_ground(assembly)


def _mesh_inertia(mesh: TriMesh) -> dict[str, str]:
    """Tell MuJoCo not to compute the volume of a mesh that has none; the body's inertia is written anyway."""
    return {} if mesh.is_closed and mesh.volume > LEAST_VOLUME_MM3 else {"inertia": "shell"}


def _skipped(assembly: Assembly) -> set[Pair]:
    """Return the pairs that do not collide in MuJoCo: those that share a joint, which are excluded, and those that never move apart."""
    joints, order = assembly.mechanism.joints, assembly.mechanism.parts
    return set(mating_pairs(joints, order)) | same_group_pairs(joints, order)
