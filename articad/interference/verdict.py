"""The verdict on one pair: compares a measured overlap with what is allowed for it."""

from __future__ import annotations

from collections.abc import Mapping

from articad.findings import Finding
from articad.interference.overlap import Overlap
from articad.interference.relations import WaiverLike
from articad.interference.report import PairCheck, Strength, Verdict
from articad.interference.scene import Scene

UNRELATED_VOLUME_MM3 = 1e-3  # a smaller overlap is rounding of the model
STATIC_SHARE = 0.01  # of the smaller part: a larger overlap is not a fit but a missing hole …
STATIC_CAP_MM3 = 1000.0  # … and so is a cubic centimetre of any part, …
STATIC_CAP_MM = 1.0  # … or a depth of a millimetre
MOTION_VOLUME_MM3 = 1.0  # a collision in motion exceeds the permanent overlap by this, …
MOTION_SHARE = 1e-4  # … for large parts by this share of the smaller one, …
MOTION_SHARE_TINY = 1e-2  # … and for tiny parts by this share: a wire of 2 mm³ cannot overlap by much more


def judge(
    scene: Scene,
    parts: tuple[str, str],
    found: Overlap,
    *,
    over: str | tuple[str, ...] = "rest",
    strength: Strength | None = None,
    pose: Mapping[str, float] | None = None,
    gap: float | None = None,
    baseline: float | None = None,
) -> tuple[PairCheck, list[Finding]]:
    """Compare a measured overlap with what is allowed for the pair.

    Args:
        scene: The scene of the pair.
        parts: Names of the two parts.
        found: The measured overlap.
        over: "rest", "pose", or the joints that moved.
        strength: How strong the verdict is; by default sampled at this one pose.
        pose: Coordinates [rad, mm].
        gap: Distance of the surfaces, if measured [mm].
        baseline: Smallest overlap of a mating pair over the motion [mm³]; more than that is a collision. None: not a motion.

    Returns:
        The verdict, and the finding if there is one.
    """
    a, b = parts
    relation = scene.relations.of(a, b)
    allowed = scene.tolerated(a, b)
    strength = strength or Strength.sampled(1)
    beyond = found.depth > allowed and found.volume > UNRELATED_VOLUME_MM3
    verdict: Verdict = "overlap" if beyond else "contact" if found.volume > 0 else "clear"
    findings: list[Finding] = []
    if beyond:
        waiver = scene.relations.waiver(a, b)
        if waiver is not None and found.depth <= waiver.max_depth + scene.deflection_of(a, b):
            strength, allowed = Strength.waived(waiver.reason), waiver.max_depth
            findings.append(_waived_finding(scene, parts, found, waiver, pose))
        else:
            collides = over != "rest" and _is_motion(scene, parts, found, baseline)
            findings.append(_overlap_finding(scene, parts, found, collides=collides, pose=pose))
    check = PairCheck(parts, relation, over, strength, found.volume, found.depth, allowed, gap, verdict, None if over == "rest" else pose)
    return check, findings


def _is_motion(scene: Scene, parts: tuple[str, str], found: Overlap, baseline: float | None) -> bool:
    """Return whether an overlap comes from the motion; the smallest overlap of a mating pair is a static one."""
    if not scene.relations.between(*parts):
        return True
    smaller = min(scene.bodies[name].volume for name in parts)
    needed = max(min(MOTION_VOLUME_MM3, MOTION_SHARE_TINY * smaller), MOTION_SHARE * smaller)
    return baseline is not None and found.volume - baseline > needed


def _overlap_finding(scene: Scene, parts: tuple[str, str], found: Overlap, *, collides: bool, pose: Mapping[str, float] | None) -> Finding:
    a, b = parts
    allowed = scene.tolerated(a, b)
    smaller = min(scene.bodies[a].volume, scene.bodies[b].volume)
    waiver = scene.relations.waiver(a, b)
    measure = f"{a} and {b} overlap by {found.volume:.4g} mm³, {found.depth:.3g} mm deep (allowed {allowed:.3g} mm)"
    beyond_waiver = "" if waiver is None else f" The waiver covers only {waiver.max_depth:g} mm."
    if collides:
        code, message = "E_MOTION_COLLISION", f"{measure}{_at(pose)}."
        hint = f"Keep them apart there, or move one by {found.depth:.3g} mm."
    elif scene.relations.between(a, b):
        much = found.volume > min(STATIC_SHARE * smaller, STATIC_CAP_MM3) or found.depth > STATIC_CAP_MM
        code = "E_STATIC_OVERLAP" if much else "W_STATIC_OVERLAP"
        joint = scene.relations.between(a, b)[0]
        message = f"{measure}; joint {joint.name!r} connects them, and a fit needs at most {allowed:.3g} mm."
        hint = f"Remove {found.depth:.3g} mm from one of them where they meet: bore the hole, or cut the slot."
    else:
        code, message = "E_OVERLAP", f"{measure}."
        hint = f"Move one of them by {found.depth:.3g} mm, or shorten it."
    return Finding(
        code=code,
        where=scene.relations.where(a, b),
        parts=parts,
        message=message + beyond_waiver,
        hint=hint,
        value=found.depth,
        limit=allowed,
        unit="mm",
        pose=pose,
    )


def _waived_finding(scene: Scene, parts: tuple[str, str], found: Overlap, waiver: WaiverLike, pose: Mapping[str, float] | None) -> Finding:
    return Finding(
        code="I_WAIVED",
        where=scene.relations.where(*parts),
        parts=parts,
        message=f"{parts[0]} and {parts[1]} overlap {found.depth:.3g} mm deep ({found.volume:.4g} mm³), allowed up to {waiver.max_depth:g} mm: "
        f"{waiver.reason}.",
        hint="Nothing needs to be done as long as the reason holds.",
        value=found.depth,
        limit=waiver.max_depth,
        unit="mm",
        pose=pose,
    )


def _at(pose: Mapping[str, float] | None) -> str:
    return "" if not pose else " at " + ", ".join(f"{name} = {value:.6g}" for name, value in pose.items())
