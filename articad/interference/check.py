"""One pose: which parts overlap, which float, which meshes cannot be checked.

Bounding boxes select the pairs; a boolean of the two solids gives the verdict (`articad.interference.overlap`).
Definitions and tolerances: `docs/reference/certificate.md`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from articad.connectors.se3 import SE3
from articad.findings import Finding, Findings
from articad.geometry.mesh import TriMesh
from articad.interference.coaxial import Coaxial
from articad.interference.holding import Holding
from articad.interference.overlap import NOTHING, distance, measured, se3_of
from articad.interference.relations import FitLike, WaiverLike
from articad.interference.report import Checks, PairCheck, Strength
from articad.interference.scene import Scene
from articad.interference.verdict import judge
from articad.kinematics.joints import Joint

__all__ = ["Checks", "PairCheck", "Scene", "Strength", "check_pose", "check_scene"]


def check_pose(
    meshes: Mapping[str, TriMesh],
    poses: Mapping[str, SE3],
    *,
    joints: Sequence[Joint],
    waivers: Sequence[WaiverLike] = (),
    deflection: Mapping[str, float] | float = 0.0,
    over: str = "rest",
    fits: Mapping[str, FitLike] | None = None,
    ground: str | None = None,
    pose: Mapping[str, float] | None = None,
    gaps: bool = False,
) -> Checks:
    """Check one pose of an assembly.

    Args:
        meshes: By part, in the part's frame; parts without geometry are omitted and cannot overlap.
        poses: `T_ground_part` of all parts, also of those without geometry.
        joints: Joints of the mechanism.
        waivers: Overlaps that the plan allows.
        deflection: How far meshes are from their solids [mm], by part or the same for all.
        over: "rest" or "pose". Rigid groups, floating and fixed parts are checked at rest only.
        fits: By joint name; a declared gap enlarges the distance within which parts count as held.
        ground: The part that does not move; the first one by default.
        pose: Coordinates, for the findings [rad, mm].
        gaps: Whether to measure the distance of every pair whose boxes are near as well.
    """
    scene = Scene.of(meshes, joints, waivers=waivers, deflection=deflection, fits=fits)
    return check_scene(scene, poses, over=over, ground=ground, pose=pose, gaps=gaps)


def check_scene(
    scene: Scene,
    poses: Mapping[str, SE3],
    *,
    over: str = "rest",
    ground: str | None = None,
    pose: Mapping[str, float] | None = None,
    gaps: bool = False,
    known: Mapping[tuple[str, str], PairCheck] | None = None,
) -> Checks:
    """Check one pose of a scene; see `check_pose`. Verdicts in `known` are reused as they are, without findings."""
    # pairs whose boxes meet: oriented boxes, then radius and height about a common axis, then the Boolean intersection
    placed, coaxial = scene.at(poses), Coaxial.of(scene)
    findings = [broken_finding(name, reason) for name, reason in scene.broken.items()]
    pairs: dict[tuple[str, str], PairCheck] = {}
    for (a, b), T_a_b, apart in placed.near():
        if over != "rest" and scene.relations.rigid.together(a, b):
            continue
        if a in scene.broken or b in scene.broken:
            continue
        if known is not None and (a, b) in known:
            pairs[a, b] = known[a, b]
            continue
        found = NOTHING if apart or coaxial.apart(scene, a, b, T_a_b) else measured(scene.bodies[a], scene.bodies[b], T_a_b)
        gap = distance(scene.bodies[a], scene.bodies[b], se3_of(T_a_b)) if gaps and not found.volume else None
        pairs[a, b], finding = judge(scene, (a, b), found, over=over, pose=pose, gap=gap)
        findings += finding
    pairs.update(unknown_pairs(scene, over))
    if over == "rest":
        # what holds what: within rigid groups by contact, all others by nearness to the chain that leads to the ground
        holding = Holding(placed, pairs)
        findings += holding.fixed_apart()
        findings += holding.floating(ground or next(iter(poses), ""), [name for name in poses if name not in scene.bodies])
    bare = tuple(name for name in poses if name not in scene.bodies)
    order = {name: at for at, name in enumerate(scene.bodies)}
    ordered = sorted(pairs.values(), key=lambda pair: (order[pair.parts[0]], order[pair.parts[1]]))
    return Checks(Findings(findings), tuple(ordered), scene.deflection, over, tuple(scene.bodies), bare)


def broken_finding(name: str, reason: str) -> Finding:
    """Return the finding about a mesh that is not a solid."""
    return Finding(
        code="E_MESH_OPEN",
        where=f"parts.{name}",
        parts=(name,),
        message=f"Overlap with {name} cannot be measured: {reason}.",
        hint="Repair the mesh: every edge belongs to two triangles, and all triangles face outwards.",
    )


def unknown_pairs(scene: Scene, over: str | tuple[str, ...]) -> dict[tuple[str, str], PairCheck]:
    """Return a verdict "unknown" for every pair with a broken mesh: it never counts as free of interference."""
    if not scene.broken:
        return {}
    names = list(scene.bodies)
    unknown = {}
    for at, a in enumerate(names):
        for b in names[at + 1 :]:
            culprits = [name for name in (a, b) if name in scene.broken]
            if culprits:
                strength = Strength.not_checked("; ".join(f"{name}: {scene.broken[name]}" for name in culprits))
                unknown[a, b] = PairCheck(
                    (a, b), scene.relations.of(a, b), over, strength, allowed=scene.tolerated(a, b), verdict="unknown"
                )
    return unknown
