"""Parts that overlap at rest, and parts that nothing holds; `contact_motion` checks the motion.

All measuring is done by `articad.interference`. This module chooses which shapes represent the bodies.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import combinations, product

import numpy as np

from articad.assembly import Assembly
from articad.auditing.contact_case import ContactCase, Contacts, explained, shared_note
from articad.auditing.contact_motion import prove_motion, sample_motion
from articad.auditing.declared import Declared
from articad.auditing.wording import counted
from articad.connectors.se3 import SE3
from articad.findings import Finding, Findings
from articad.geometry.capping import without_gaps
from articad.geometry.mesh import TriMesh, merged
from articad.geometry.part import Part
from articad.interference.body import body_of
from articad.interference.check import check_scene
from articad.interference.holding import Holding
from articad.interference.overlap import measured
from articad.interference.relations import Groups
from articad.interference.report import Checks, PairCheck
from articad.interference.scene import Scene
from articad.interference.verdict import judge
from articad.interference.work import WorkBudget, look_price
from articad.kinematics.joints import JointType

FOREIGN = ("urdf", "mjcf")  # formats whose shapes only approximate the bodies
FOREIGN_GAP_MM = 1.0  # largest gap between fixed shapes of foreign files: they are drawings, not parts to make
MOST_BODIES = 1000  # parts with shapes whose pairs are checked
REST_S = 30.0  # nominal seconds of work, for overlap at rest of simulators' models: robots take a second
MOST_UNION = 24  # shapes of one link that are united; more are used as they are
ROUND = ("sphere", "capsule")
SIMPLE = ("box", "cylinder", "sphere", "capsule", "geom")


def contacts(
    assembly: Assembly,
    declared: Declared,
    *,
    budget: float,
    certified: float | None = None,
    simple: frozenset[str] = frozenset(),
    filtered: frozenset[frozenset[str]] = frozenset(),
) -> Contacts:
    """Check an assembly for overlap, collision and parts that nothing holds.

    Args:
        assembly: The assembly read from the file.
        declared: The file's declarations about shapes.
        budget: Nominal seconds of work for sampling the motion.
        certified: The same for proving it instead; None samples.
        simple: Parts that collide with simple shapes, if the file itself does not say so.
        filtered: Pairs of parts that the file excludes from collision.
    """
    foreign = declared.format in FOREIGN and all(part.solid is None for part in assembly.parts.values())  # articad's own files have solids
    meshes = {name: mesh for name, part in assembly.parts.items() if (mesh := colliding(part)) is not None}
    if len(meshes) > MOST_BODIES:
        return Contacts(Checks(Findings(), (), 0.0, "rest", ()), findings=[_too_many(len(meshes))], strength="none")
    deflections = {name: part.deflection for name, part in assembly.parts.items()}
    scene = Scene.of(meshes, assembly.joints, waivers=assembly.waivers, deflection=deflections, fits=assembly.fits)
    case = ContactCase(assembly, foreign, simple | _simple_parts(declared), filtered, scene, _neighbours(assembly, meshes))
    poses = dict(zip(assembly.mechanism.parts, assembly.mechanism.at_rest, strict=True))
    found = Contacts(pairs=_at_rest(case, poses, WorkBudget(REST_S)))
    found.findings += explained(case, found.pairs.findings)
    found.findings += _held(case, declared, poses, found.pairs)
    found.undone += [f"overlap with {name}: {reason}" for name, reason in scene.broken.items()]
    if scene.bodies and assembly.drivers:
        if certified is None:
            sample_motion(case, found, budget)
        else:
            prove_motion(case, found, certified)
    if case.shared:
        found.findings.append(shared_note(case.shared))
    if declared.format != "plan":
        found.findings = [_from_records(finding) if finding.code == "I_WAIVED" else finding for finding in found.findings]
    return found


def _from_records(finding: Finding) -> Finding:
    """Return the finding about a waiver with where it is from: in a file, nothing but the records of articad can hold one."""
    said = " Only articad's records in the file say so; nothing else in it can be compared with them."
    return replace(finding, message=finding.message + said, hint="Check the reason yourself if you do not know who wrote the file.")


# ---------------------------------------------------------------------- choice of shapes


def colliding(part: Part) -> TriMesh | None:
    """Return the shape that represents a part: its solid, else its collision shapes, else its visual ones, with small gaps closed.

    Overlapping shapes are united.
    """
    if part.solid is not None:
        return part.solid.mesh
    shapes = part.collisions or part.visuals
    return united([without_gaps(shape.placed) for shape in shapes]) if shapes else None


def united(meshes: list[TriMesh]) -> TriMesh:
    """Return the union of meshes as one mesh; a plain concatenation if they are not solids."""
    bodies = [body_of(mesh) for mesh in meshes]
    if len(meshes) == 1 or len(meshes) > MOST_UNION or any(body.fault is not None for body in bodies):
        return merged(meshes)
    whole = bodies[0].manifold
    for body in bodies[1:]:
        whole = whole + body.manifold
    content = whole.to_mesh64()
    return TriMesh(np.asarray(content.vert_properties)[:, :3], np.asarray(content.tri_verts).astype(np.int32))


def _simple_parts(declared: Declared) -> frozenset[str]:
    """Return the parts that collide with at least one box, cylinder, sphere or capsule."""
    return frozenset(
        link.name for link in declared.links if any(shape.kind in SIMPLE for shape in link.of("collision") or link.of("visual"))
    )


def _round(declared: Declared) -> set[str]:
    """Return the links whose visual shapes are all balls and capsules."""
    return {link.name for link in declared.links if link.shapes and all(shape.kind in ROUND for shape in link.shapes)}


def _neighbours(assembly: Assembly, meshes: Mapping[str, TriMesh]) -> frozenset[frozenset[str]]:
    """Return the pairs of parts with one joint between them, counting rigid groups as one body and ignoring bare carriers."""
    solid = Groups(assembly.parts)
    for joint in assembly.joints:
        carried = joint.child not in meshes or (joint.parent not in meshes and joint.parent != assembly.ground)
        if joint.type is JointType.FIXED or carried:
            solid.join(joint.parent, joint.child)
    members = {name: [other for other in meshes if solid.together(name, other)] for name in meshes}
    found = {frozenset(pair) for names in members.values() for pair in combinations(names, 2)}
    for joint in assembly.joints:
        if joint.parent in members and joint.child in members:
            found |= {frozenset(pair) for pair in product(members[joint.parent], members[joint.child])}
    return frozenset(found)


# ---------------------------------------------------------------------- at rest


def _at_rest(case: ContactCase, poses: Mapping[str, SE3], budget: WorkBudget) -> Checks:
    """Check the rest pose. In simulators' formats, `_held` checks by visual shapes what holds each part."""
    if not case.foreign:
        return check_scene(case.scene, poses, ground=case.assembly.ground)
    scene, findings, pairs = case.scene, list[Finding](), list[PairCheck]()
    placed = scene.at(poses)
    near = placed.candidates()
    for at, (a, b) in enumerate(near):
        if budget.is_spent:
            findings.append(_unfinished(near[at:], len(near), budget))
            break
        if a not in scene.broken and b not in scene.broken:
            budget.spend(look_price(*(scene.bodies[name].manifold_triangles for name in (a, b))))
            check, found = judge(scene, (a, b), measured(scene.bodies[a], scene.bodies[b], placed.relative(a, b)))
            pairs.append(check)
            findings += found
    return Checks(Findings(findings), tuple(pairs), scene.deflection, "rest", tuple(scene.bodies))


def _too_many(count: int) -> Finding:
    return Finding(
        code="W_AUDIT_NOT_CHECKED",
        where="parts",
        message=f"Contact and motion were not checked: {count} parts have shapes; the maximum is {MOST_BODIES}.",
        hint="Audit the file in pieces.",
        value=count,
        limit=MOST_BODIES,
    )


def _unfinished(left: list[tuple[str, str]], count: int, budget: WorkBudget) -> Finding:
    return Finding(
        code="W_AUDIT_NOT_CHECKED",
        where=f"parts.{left[0][0]}",
        message=f"Overlap at rest was not checked for {len(left)} of {counted(count, 'pair')} of parts that are near each other. "
        f"{budget.ended()}",
        hint="Spread the parts out; so many in one place are probably a mistake.",
        value=len(left),
        limit=0,
    )


def _held(case: ContactCase, declared: Declared, poses: Mapping[str, SE3], rest: Checks) -> list[Finding]:
    """Find parts that touch nothing, or not what they are fixed to: by all visual and collision shapes, open meshes included."""
    if not case.foreign:
        return []  # `check_scene` has checked it
    assembly = case.assembly
    unread = {link.name for link in declared.links if any(shape.mesh is None for shape in link.shapes)}
    # a world is not a body, and balls and capsules only represent limbs
    skipped = unread | ({assembly.ground} | case.simple if declared.format == "mjcf" else _round(declared))
    meshes = {
        name: merged([shape.placed for shape in (*part.visuals, *part.collisions)])
        for name, part in assembly.parts.items()
        if name not in skipped and (part.visuals or part.collisions)
    }
    if len(meshes) < 2:
        return []
    scene = Scene.of(meshes, assembly.joints, deflection=FOREIGN_GAP_MM / 2)
    pairs = {pair.parts: pair for pair in rest.pairs if set(pair.parts) <= set(meshes)}
    holding = Holding(scene.at(poses), pairs)
    return [*holding.fixed_apart(), *holding.floating(assembly.ground, [name for name in assembly.parts if name not in meshes])]
