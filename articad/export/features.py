"""The features of an assembly that a format may not hold: rows of the table of losses, in the order in which they are declared."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import replace
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from articad.export.convex import hull_mesh
from articad.export.inertia import MM_PER_M, is_possible
from articad.export.losses import Feature
from articad.geometry.mesh import TriMesh, merged
from articad.geometry.part import Part, Shape
from articad.kinematics.joints import Joint, JointType

if TYPE_CHECKING:
    from articad.assembly import Assembly

FLAT_SHARE = 1e-6  # of its size: a mesh thinner than this has no hull that engines can compute
THIN_MM = 1.0  # thickness that a flat mesh gets for collision
WIDE_CONE = math.radians(85.0)  # from here the three angles of a ball come too close to gimbal lock


def features_of(assembly: Assembly) -> list[Feature]:
    """Return the features of joints, couplings, parts and fits."""
    mechanism = assembly.mechanism
    closing = {joint.name for joint in mechanism.loop_joints}
    features = []
    for joint in mechanism.joints:
        features.extend(_loop_features(joint) if joint.name in closing else joint_features(joint))
    features.extend(_coupling_features(assembly))
    features.extend(_part_features(assembly))
    features.extend(Feature("fit", f"joints.{joint}") for joint in assembly.fits)
    features.extend(Feature("fastening", f"joints.{joint.name}") for joint in assembly.joints if joint.fastening)
    return features


def motion_and_mass(assembly: Assembly) -> list[Feature]:
    """Return what formats of shapes alone lose of every assembly: the joints that move, and masses."""
    features = [Feature("motion", f"joints.{joint.name}") for joint in assembly.joints if joint.type is not JointType.FIXED]
    return features + [Feature("mass", f"parts.{name}") for name, part in assembly.parts.items() if part.mass is not None]


def joint_features(joint: Joint) -> list[Feature]:
    """Return the features of a joint that closes no loop, or that a format represents whether it closes one or not."""
    where = f"joints.{joint.name}"
    features = [Feature(_key(joint), where)]
    for unit, lower, upper in zip(joint.type.units, joint.limits.lower, joint.limits.upper, strict=False):
        if math.isinf(lower) != math.isinf(upper):
            features.append(Feature("limits.open", where))
        elif math.isinf(lower) and unit == "mm":
            features.append(Feature("slide.endless", where))
    if any(velocity is not None for velocity in joint.velocity):
        features.append(Feature("velocity", where))
    features.extend(Feature(f"joint.{name}", where) for name in ("damping", "friction") if any(getattr(joint, name)))
    return features


def _key(joint: Joint) -> str:
    if joint.type is JointType.BALL:
        cone = math.pi if joint.limits.cone is None else joint.limits.cone
        if cone >= math.pi and joint.limits.twist is None:
            return "ball.free"
        return "ball.wide" if cone >= WIDE_CONE else "ball"
    if joint.type is JointType.REVOLUTE and math.isinf(joint.limits.lower[0]) and math.isinf(joint.limits.upper[0]):
        return "revolute.endless"
    return str(joint.type)


def _loop_features(joint: Joint) -> list[Feature]:
    where = f"joints.{joint.name}"
    if joint.type is JointType.FREE:
        return [Feature("loop.free", where)]
    if joint.type is JointType.BALL and _key(joint) != "ball.free":
        return [Feature("loop", where), Feature("loop.ball", where)]
    if joint.type in {JointType.CYLINDRICAL, JointType.PLANAR}:
        return [Feature("loop", where), Feature("loop.chain", where)]
    return [Feature("loop", where)]


def _coupling_features(assembly: Assembly) -> list[Feature]:
    """Return a feature per coupling; couplings that name a closing joint, or couple joints already coupled, have a feature of their own."""
    mechanism = assembly.mechanism
    closing = {name for joint in mechanism.loop_joints for name in joint.column_names}
    group = {coordinate.name: coordinate.name for coordinate in mechanism.coordinates}
    features = []
    for coupling in mechanism.couplings:
        a, b = group[coupling.a], group[coupling.b]
        written = a != b and not {coupling.a, coupling.b} & closing
        group = {name: a if leader == b else leader for name, leader in group.items()}
        features.append(Feature("coupling" if written else "coupling.loop", f"couplings.{coupling.name}"))
    return features


def _part_features(assembly: Assembly) -> list[Feature]:
    features = []
    still = rigid_with_ground(assembly) | without_own_mass(assembly)
    used = {end for joint in assembly.joints for end in ((joint.parent, joint.parent_connector), (joint.child, joint.child_connector))}
    for name, part in assembly.parts.items():
        where = f"parts.{name}"
        if name not in still and (part.mass is None or part.mass.mass <= 0):
            features.append(Feature("mass.missing", where))
        elif part.mass is not None and part.mass.mass > 0 and not is_possible(part.mass.mass, part.mass.inertia / MM_PER_M**2):
            features.append(Feature("mass.impossible", where))
        elif name in still and part.mass is not None and part.mass.mass <= 0 and part.mass.inertia.any():
            features.append(Feature("mass.impossible", where, "none: without mass"))
        if any(is_flat(shape.mesh) for shape in part.collisions or part.visuals):
            features.append(Feature("shape.flat", where))
        if not part.visuals and not part.collisions:
            features.append(Feature("shape.missing", where))
        if any((name, connector) not in used for connector in part.connectors):
            features.append(Feature("connector", where))
        if part.material in assembly.materials:
            features.append(Feature("friction", where))
    return features


def steps_of_bodies(assembly: Assembly) -> set[str]:
    """Return the parts that stand for nothing but the step from one joint of an MJCF body to the next."""
    if not any(item.format == "mjcf" for item in assembly.kept):
        return set()
    joined = Counter(end for joint in assembly.joints if joint.type is not JointType.FIXED for end in (joint.parent, joint.child))
    return {
        name
        for name, part in assembly.parts.items()
        if part.mass is None and not part.visuals and not part.collisions and joined[name] == 2 and name not in rigid_with_ground(assembly)
    }


def without_own_mass(assembly: Assembly) -> set[str]:
    """Return the parts of a file that have no mass and are fixed to another: frames, to which engines must not add mass."""
    return {
        edge.part for edge in assembly.mechanism.tree.edges if assembly.foreign and edge.joint.type is JointType.FIXED and not edge.reversed
    }


def primitive_features(assembly: Assembly) -> list[Feature]:
    """Return features for parts whose shapes the file states as primitives, for formats that are written with meshes."""
    return [
        Feature("shape.primitive", f"parts.{name}", shape.primitive.kind)
        for name, part in assembly.parts.items()
        for shape in (*part.visuals, *part.collisions)
        if shape.primitive is not None
    ]


def body_mesh(part: Part) -> TriMesh | None:
    """Return the mesh with which formats of shapes draw a part: its solid's, else the visual, else the collision shape, else None."""
    if part.solid is not None:
        return part.solid.mesh
    shapes = part.visuals or part.collisions
    mesh = merged([shape.placed for shape in shapes]) if shapes else None
    return None if mesh is None or not len(mesh.triangles) else mesh


def is_flat(mesh: TriMesh) -> bool:
    """True for a mesh within a plane, a line or a point: it has no hull to collide with."""
    if mesh.is_closed and mesh.volume > 0:
        return False
    centred = mesh.vertices - mesh.vertices.mean(axis=0)
    extents = np.ptp(centred @ np.linalg.svd(centred, full_matrices=False)[2].T, axis=0)
    return len(extents) < 3 or bool(extents.min() <= FLAT_SHARE * extents.max())


def solid_enough(part: Part) -> tuple[Shape, ...]:
    """Return the collision shapes of a part; flat ones are thickened to `THIN_MM`."""
    return tuple(
        replace(shape, mesh=_thick(shape.mesh), primitive=None) if is_flat(shape.mesh) else shape
        for shape in part.collisions or part.visuals
    )


def _thick(mesh: TriMesh) -> TriMesh:
    corners = np.array(list(product((-THIN_MM / 2, THIN_MM / 2), repeat=3)))
    return hull_mesh((mesh.vertices[:, None] + corners).reshape(-1, 3))


def rigid_with_ground(assembly: Assembly) -> set[str]:
    """Return the parts that never move: the ground and those that fixed joints of the tree connect to it."""
    still = {assembly.mechanism.ground}
    for edge in assembly.mechanism.tree.edges:
        if edge.parent in still and edge.joint.type is JointType.FIXED:
            still.add(edge.part)
    return still
