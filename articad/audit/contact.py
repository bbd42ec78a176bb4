"""Parts in each other's way: at rest, over each joint's range, with two joints at once; and parts that nothing holds.

All measuring is that of `articad.interference`. This module chooses which shapes stand for the bodies, keeps to a budget, finds
where contact begins, and says more softly what the simplified shapes of simulators share by design.
"""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations, product

import numpy as np

from articad.assembly import Assembly
from articad.audit.declared import Declared
from articad.audit.wording import counted, listed
from articad.connectors.se3 import SE3
from articad.errors import ArticadError
from articad.findings import Finding, Findings
from articad.geometry.mesh import TriMesh, merged
from articad.geometry.part import Part
from articad.interference.body import body_of, relative
from articad.interference.certificate import Certificate, certify
from articad.interference.check import check_scene
from articad.interference.diagnosis import diagnose
from articad.interference.holding import Holding
from articad.interference.motion import Freedom, freedoms
from articad.interference.overlap import measured, volume
from articad.interference.relations import Groups, Relations
from articad.interference.report import Checks, PairCheck
from articad.interference.scene import Scene
from articad.interference.sweep import Sweep
from articad.interference.verdict import STATIC_SHARE, judge
from articad.kinematics.joints import JointType

FOREIGN = ("urdf", "mjcf")  # formats whose shapes stand for bodies without being them
STEPS = 25  # poses of a joint: every 15° of a full turn
FEWEST_STEPS = 9  # … and so many where a pose takes long
SIDE = 7  # poses of each of two joints
SCAN = 24  # poses between rest and a collision, among which the first contact is looked for
BISECTIONS = 30
CONTACT_MM3 = 1e-6  # shared volume at which contact begins: an edge 10 mm long is then 0.3 µm deep
MOST_DIAGNOSED = 20
FOREIGN_GAP_MM = 1.0  # by which shapes of foreign files may miss each other where they are fixed: they are drawn, not made
MOST_UNION = 24  # shapes of one link that are united; more are taken as they are
SIMPLE = ("box", "cylinder", "sphere", "capsule", "geom")
MOTION = "E_MOTION_COLLISION"


@dataclass
class Contacts:
    """What was found about contact.

    Attributes:
        pairs: Of the rest pose, with every pair.
        findings: All of them.
        undone: What was not checked, in words.
        strength: "sampled" or "certified", of the motion.
        certificate: Of the motion, if it was to be proven.
    """

    pairs: Checks
    findings: list[Finding] = field(default_factory=list)
    undone: list[str] = field(default_factory=list)
    strength: str = "sampled"
    certificate: Certificate | None = None


@dataclass(frozen=True, eq=False)
class _Case:
    """What is checked.

    Attributes:
        assembly: Of the file.
        foreign: True for URDF and MJCF.
        simple: Parts of whose colliding shapes at least one is a box, cylinder, sphere or capsule.
        filtered: Pairs that the file's own engine never lets collide.
        scene: With the shapes that collide.
        neighbours: Pairs that one joint lies between.
        shared: What such pairs have in common, to be told in one note.
    """

    assembly: Assembly
    foreign: bool
    simple: frozenset[str]
    filtered: frozenset[frozenset[str]]
    scene: Scene
    neighbours: frozenset[frozenset[str]]
    shared: list[Finding] = field(default_factory=list)

    def by_design(self, parts: Sequence[str]) -> bool:
        """True when these parts may share space in a simulator's model: neighbours of simple shapes, rigid ones, filtered ones."""
        if not self.foreign or len(parts) != 2:
            return False
        a, b = parts
        pair = frozenset(parts)
        near = pair in self.neighbours and bool(pair & self.simple)
        return near or self.scene.relations.rigid.together(a, b) or pair in self.filtered


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
        assembly: Of the file.
        declared: What the file says of its shapes.
        budget: Seconds for sampling the motion.
        certified: Seconds for proving it instead; None samples.
        simple: Parts that collide with simple shapes, where the file itself does not tell.
        filtered: Pairs of parts that the file keeps from colliding.
    """
    foreign = declared.format in FOREIGN and all(part.solid is None for part in assembly.parts.values())  # ours come back whole
    meshes = {name: mesh for name, part in assembly.parts.items() if (mesh := colliding(part)) is not None}
    deflections = {name: part.deflection for name, part in assembly.parts.items()}
    scene = Scene.of(meshes, assembly.joints, waivers=assembly.waivers, deflection=deflections, fits=assembly.fits)
    case = _Case(assembly, foreign, simple | _simple_parts(declared), filtered, scene, _neighbours(assembly, meshes))
    poses = dict(zip(assembly.mechanism.parts, assembly.poses(assembly.mechanism.rest), strict=True))
    found = Contacts(pairs=_at_rest(case, poses))
    found.findings += _explained(case, found.pairs.findings)
    found.findings += _held(case, declared, poses, found.pairs)
    found.undone += [f"overlap with {name}: {reason}" for name, reason in scene.broken.items()]
    if scene.bodies and assembly.drivers:
        if certified is None:
            _sampled(case, found, budget)
        else:
            _certified(case, found, certified)
    if case.shared:
        found.findings.append(_shared_note(case.shared))
    return found


# ---------------------------------------------------------------------- which shapes


def colliding(part: Part) -> TriMesh | None:
    """Return what stands for a part: its solid, else what collides, else what is drawn; shapes that overlap are united."""
    if part.solid is not None:
        return part.solid.mesh
    shapes = part.collisions or part.visuals
    return united([shape.placed for shape in shapes]) if shapes else None


def united(meshes: list[TriMesh]) -> TriMesh:
    """Return one mesh of what several fill together; side by side where they are no solids."""
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


def _neighbours(assembly: Assembly, meshes: Mapping[str, TriMesh]) -> frozenset[frozenset[str]]:
    """Return the pairs of parts that one joint lies between, rigid groups taken as one body and bare carriers left out."""
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


def _at_rest(case: _Case, poses: Mapping[str, SE3]) -> Checks:
    """Check the rest pose. In simulators' formats holding is judged by what is drawn, elsewhere: see `_held`."""
    if not case.foreign:
        return check_scene(case.scene, poses, ground=case.assembly.ground)
    scene, findings, pairs = case.scene, list[Finding](), list[PairCheck]()
    for a, b in scene.candidates(poses):
        if a not in scene.broken and b not in scene.broken:
            check, found = judge(scene, (a, b), measured(scene.bodies[a], scene.bodies[b], relative(poses[a], poses[b])))
            pairs.append(check)
            findings += found
    return Checks(Findings(findings), tuple(pairs), scene.deflection, "rest", tuple(scene.bodies))


def _held(case: _Case, declared: Declared, poses: Mapping[str, SE3], rest: Checks) -> list[Finding]:
    """Find parts that touch nothing, or not what they are fixed to: by everything that is drawn or collides, open meshes too."""
    if not case.foreign:
        return []  # `check_scene` has judged it
    assembly = case.assembly
    unread = {link.name for link in declared.links if any(shape.mesh is None for shape in link.shapes)}
    skipped = unread | ({assembly.ground} | case.simple if declared.format == "mjcf" else set())  # a world is no body, a capsule no limb
    meshes = {
        name: merged([shape.placed for shape in (*part.visuals, *part.collisions)])
        for name, part in assembly.parts.items()
        if name not in skipped and (part.visuals or part.collisions)
    }
    if len(meshes) < 2:
        return []
    scene = Scene.of(meshes, assembly.joints, deflection=FOREIGN_GAP_MM / 2)
    pairs = {pair.parts: pair for pair in rest.pairs if set(pair.parts) <= set(meshes)}
    holding = Holding(scene, {name: poses[name] for name in assembly.parts}, pairs)
    return [*holding.fixed_apart(), *holding.floating(assembly.ground, [name for name in assembly.parts if name not in meshes])]


# ---------------------------------------------------------------------- moving


class _Quiet(Relations):
    """Relations for motion: pairs that may share space by design are not looked at."""

    def __init__(self, case: _Case) -> None:
        super().__init__(case.assembly.joints, case.assembly.waivers)
        self.rigid = _Together(self.rigid, case)


class _Together(Groups):
    def __init__(self, rigid: Groups, case: _Case) -> None:
        super().__init__()
        self._rigid, self._case = rigid, case

    def together(self, a: str, b: str) -> bool:
        """Return whether two parts are not to be looked at."""
        return self._rigid.together(a, b) or self._case.by_design((a, b))


def _sampled(case: _Case, found: Contacts, budget: float) -> None:
    """Move each joint over its range, then two at a time, until the time is spent."""
    end = time.monotonic() + budget
    sweep = Sweep(replace(case.scene, relations=_Quiet(case)), case.assembly.mechanism)
    ranges = [freedom for joint in sweep.driving for freedom in freedoms(joint)]
    guilty = {frozenset(finding.parts) for finding in found.findings}
    late: list[str] = []
    steps = FEWEST_STEPS if case.assembly.mechanism.loop_joints else STEPS  # to close loops takes long: the first joint tells how long
    for at, freedom in enumerate(ranges):
        if time.monotonic() > end:
            late.append(freedom.name)
            continue
        start = time.monotonic()
        values = np.linspace(freedom.lower, freedom.upper, steps).tolist()
        checks = sweep.sampled([{freedom.name: value} for value in values], (freedom.name,), values[1] - values[0])
        left, cost = len(ranges) - at - 1, (time.monotonic() - start) / steps
        steps = max(FEWEST_STEPS, min(STEPS, int((end - time.monotonic()) / max(cost * left, 1e-9)))) if left else steps
        fresh = [finding for finding in checks.findings if finding.code == MOTION or frozenset(finding.parts) not in guilty]
        found.findings += _collisions(case, sweep, freedom, fresh, end)
        guilty |= {frozenset(finding.parts) for finding in fresh}
    if late:
        found.findings.append(_unfinished(late, len(ranges), budget))
    undone = _pairs(case, found, sweep, ranges, guilty, end)
    if undone:
        found.undone.append(f"{undone} of {math.comb(len(ranges), 2)} pairs of joints together: the time was spent")


def _collisions(case: _Case, sweep: Sweep, freedom: Freedom, findings: list[Finding], end: float) -> list[Finding]:
    """Say where each collision begins. In simulators' formats the first one of each joint stands for the others."""
    met = [_first_contact(case, sweep, freedom, finding) if time.monotonic() < end else (finding, None) for finding in findings]
    if not case.foreign or len(met) < 2:
        return [_beginning(case, freedom, explained, value) for finding, value in met for explained in _explained(case, [finding])]
    known = [(abs(value - freedom.rest), at) for at, (_, value) in enumerate(met) if value is not None]
    finding, value = met[min(known)[1]] if known else met[0]
    others = [" and ".join(other.parts) for other, _ in met if other is not finding]
    return [
        _beginning(case, freedom, replace(explained, message=f"{explained.message} So do {listed(others)} later on."), value)
        for explained in _explained(case, [finding])
    ]


def _pairs(case: _Case, found: Contacts, sweep: Sweep, ranges: list[Freedom], guilty: set[frozenset[str]], end: float) -> int:
    """Move two joints at a time on a grid; return how many pairs there was no time for."""
    undone, together = 0, list[Finding]()
    for first, second in combinations(ranges, 2):
        if time.monotonic() > end:
            undone += 1
            continue
        names = (first.name, second.name)
        grid = [*product(*(np.linspace(freedom.lower, freedom.upper, SIDE).tolist() for freedom in (first, second)))]
        if {name.partition(".")[2] for name in names} == {"sx", "sy"} and names[0].partition(".")[0] == names[1].partition(".")[0]:
            grid = [point for point in grid if math.hypot(*point) <= first.upper]  # a ball swings within a cone, not within a square
        checks = sweep.sampled([dict(zip(names, point, strict=True)) for point in grid], names, None)
        for finding in checks.findings:
            parts = frozenset(finding.parts)
            if finding.code == MOTION and parts not in guilty:
                guilty.add(parts)
                together.append(_together(finding, names))
    if case.foreign and len(together) > 1:
        deepest = max(together, key=lambda finding: finding.value or 0.0)
        others = [" and ".join(finding.parts) for finding in together if finding is not deepest]
        together = [
            replace(deepest, message=f"{deepest.message} {counted(len(others), 'other pair')} of parts collide likewise: {listed(others)}.")
        ]
    found.findings += together
    return undone


def _certified(case: _Case, found: Contacts, budget: float) -> None:
    """Prove the motion free, or say where it is not."""
    scene = case.scene
    certificate = certify(
        scene.meshes, case.assembly.mechanism, budget=budget, deflection=scene.deflections, waivers=case.assembly.waivers, fits=scene.fits
    )
    found.strength = "certified"
    found.certificate = certificate
    guilty = {frozenset(finding.parts) for finding in found.findings}
    fresh = [finding for finding in certificate.findings if finding.code == MOTION or frozenset(finding.parts) not in guilty]
    found.findings += _explained(case, fresh)


def _together(finding: Finding, names: tuple[str, str]) -> Finding:
    return replace(
        finding,
        code="W_AUDIT_PAIR_COLLISION",
        route=None,
        stage=None,
        message=f"{finding.message} Neither of {names[0]} and {names[1]} does that alone.",
        hint="Narrow one of the ranges, keep the two from moving so together, or make room.",
    )


def _first_contact(case: _Case, sweep: Sweep, freedom: Freedom, finding: Finding) -> tuple[Finding, float | None]:
    """Return the value at which, on the way from rest, two parts first meet; None where that cannot be said."""
    if finding.code != MOTION or finding.pose is None or freedom.name not in finding.pose:
        return finding, None
    a, b = finding.parts

    def shared(value: float) -> float:
        poses = case.assembly.poses(np.array(sweep.columns({freedom.name: value})))
        T = relative(*(poses[case.assembly.mechanism.part_index(name)] for name in (a, b)))
        return volume(case.scene.bodies[a], case.scene.bodies[b], T.matrix[:3])

    try:
        least = shared(freedom.rest) + CONTACT_MM3
        values = np.linspace(freedom.rest, finding.pose[freedom.name], SCAN).tolist()
        hit = next((at for at, value in enumerate(values) if shared(value) > least), None)
        if not hit:
            return finding, None
        clear, met = values[hit - 1], values[hit]
        for _ in range(BISECTIONS):
            middle = (clear + met) / 2
            clear, met = (clear, middle) if shared(middle) > least else (middle, met)
    except ArticadError:  # a linkage that does not reach a pose between two that it reaches
        return finding, None
    return finding, met


def _beginning(case: _Case, freedom: Freedom, finding: Finding, met: float | None) -> Finding:
    """Return the finding with the value at which contact begins."""
    if met is None:
        return finding
    value, bound, unit = met, freedom.upper if met >= freedom.rest else freedom.lower, "mm"
    if _turns(case, freedom):
        value, bound, unit = math.degrees(value), math.degrees(bound), "deg"
    return replace(
        finding,
        message=f"{finding.message} On the way from rest they first meet at {freedom.name} = {value:.5g} {unit}.",
        value=value,
        limit=bound,
        unit=unit,
    )


def _turns(case: _Case, freedom: Freedom) -> bool:
    name, _, coordinate = freedom.name.partition(".")
    joint = next(joint for joint in case.assembly.joints if joint.name in {freedom.name, name})
    if joint.name == freedom.name or joint.type is JointType.BALL:
        return joint.type is not JointType.SLIDER
    return joint.type.units[joint.type.coordinates.index(coordinate)] == "rad"


# ---------------------------------------------------------------------- saying it


def _explained(case: _Case, findings: Sequence[Finding]) -> list[Finding]:
    """Add causes; put aside what simulators' shapes share by design."""
    measured_ones = [finding for finding in findings if finding.code != "E_MESH_OPEN"]  # `shapes` tells of open meshes
    case.shared.extend(finding for finding in measured_ones if case.by_design(finding.parts))
    kept = [_by_share(case, finding) for finding in measured_ones if not case.by_design(finding.parts)]
    depths = {(finding.code, finding.parts, str(finding.pose)): finding for finding in kept}
    named = []
    for finding in (*diagnose(case.scene, case.assembly.mechanism.tree, kept[:MOST_DIAGNOSED]), *kept[MOST_DIAGNOSED:]):
        depth = depths.get((finding.code, finding.parts, str(finding.pose)))
        if depth is not None and finding.cause == "pitch" and _one_carries_the_other(case, finding.parts):
            finding = depth  # noqa: PLW2901 - the pitch of two axes says nothing of parts that one chain carries
        # the cause names its own numbers in the message; the finding's number stays the depth that was measured
        named.append(finding if depth is None else replace(finding, value=depth.value, limit=depth.limit, unit=depth.unit))
    return [finding for finding in named if finding.code != "E_NOT_ONE_SOLID"]  # `shapes` tells of pieces, once for each file


def _one_carries_the_other(case: _Case, parts: Sequence[str]) -> bool:
    a, b = (case.assembly.mechanism.tree.path(case.assembly.ground, name) for name in parts)
    return a[-1] in b or b[-1] in a


def _by_share(case: _Case, finding: Finding) -> Finding:
    """In simulators' formats let an overlap of neighbours be an error only when it is much of the smaller one."""
    if not case.foreign or finding.code != "E_STATIC_OVERLAP":
        return finding
    a, b = (case.scene.bodies[name] for name in finding.parts)
    poses = case.assembly.poses(case.assembly.mechanism.rest)
    T = relative(*(poses[case.assembly.mechanism.part_index(name)] for name in finding.parts))
    much = volume(a, b, T.matrix[:3]) > STATIC_SHARE * min(a.volume, b.volume)
    return finding if much else replace(finding, code="W_STATIC_OVERLAP")


def _shared_note(shared: Sequence[Finding]) -> Finding:
    deepest = max(shared, key=lambda finding: finding.value or 0.0)
    return Finding(
        code="I_AUDIT_SHARED",
        where=deepest.where,
        parts=tuple(dict.fromkeys(name for finding in shared for name in finding.parts)),
        message=f"{counted(len(shared), 'pair')} of parts that engines do not let collide share space at rest, the deepest {listed(deepest.parts)}, "
        f"{deepest.value or 0.0:.4g} mm.",
        hint="Nothing, if the shapes stand for bodies that fit.",
        value=deepest.value,
        limit=deepest.limit,
        unit=deepest.unit,
    )


def _unfinished(late: list[str], count: int, budget: float) -> Finding:
    return Finding(
        code="W_AUDIT_NOT_CHECKED",
        where=f"joints.{late[0]}",
        message=f"The motion of {len(late)} of {counted(count, 'freedom')} was not looked at, for {budget:g} s were spent: {listed(late)}.",
        hint="Give it more time with --budget.",
        value=len(late),
        limit=0,
    )
