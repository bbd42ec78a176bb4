"""Evidence: what can be measured of an assembly before anybody is asked how it looks.

The rest pose first; when it is right, every joint on its own through its range, the others at rest. Every verdict says how
strong it is.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from articad.assembly import Assembly
from articad.findings import Finding, Findings
from articad.interference.report import Checks, PairCheck, Strength
from articad.render.pictures import motion_frames

POSES: Final = 9  # of each joint's range: enough for a flap that digs in, quick enough for every round


def examine(assembly: Assembly) -> Checks:
    """Check an assembly at rest and, if that holds, at samples of each joint's range.

    Returns:
        The checks of the rest pose, and with them a sampled verdict for every pair that meets in motion.
    """
    checks = assembly.check()
    if not checks.ok:
        return checks  # what overlaps at rest overlaps in motion too: one thing at a time
    for joint in dict.fromkeys(driver.joint for driver in assembly.drivers):
        checks = _with_motion(checks, assembly, joint)
    return checks


def _with_motion(checks: Checks, assembly: Assembly, joint: str) -> Checks:
    captions, configurations = motion_frames(assembly, joint, POSES)
    worst: dict[tuple[str, str], tuple[PairCheck, str]] = {}
    for caption, q in zip(captions, configurations, strict=True):
        for pair in assembly.check(q).pairs:
            known = worst.get(pair.parts)
            if known is None or pair.depth > known[0].depth:
                names = (driver.name for driver in assembly.drivers)
                pose = {name: float(value) for name, value in zip(names, q, strict=True)}
                worst[pair.parts] = replace(pair, over=(joint,), strength=_sampled(pair, len(captions)), pose=pose), caption
    collisions = [_collision(pair, joint, caption) for pair, caption in worst.values() if pair.verdict == "overlap" and not _waived(pair)]
    return replace(checks, findings=Findings([*checks.findings, *collisions]), pairs=(*checks.pairs, *(pair for pair, _ in worst.values())))


def _sampled(pair: PairCheck, poses: int) -> Strength:
    return pair.strength if _waived(pair) else Strength.sampled(poses)


def _waived(pair: PairCheck) -> bool:
    return pair.strength.kind == "waived"


def _collision(pair: PairCheck, joint: str, caption: str) -> Finding:
    a, b = pair.parts
    return Finding(
        code="E_MOTION_COLLISION",
        where=f"joints.{joint}",
        parts=pair.parts,
        message=f"{a} and {b} collide in motion: at {caption} they overlap by {_short(pair.volume)} mm³, {_short(pair.depth)} mm deep "
        f"(allowed {_short(pair.allowed)} mm).",
        hint="Make room for the motion (a recess, more clearance, an axis farther out), or narrow the limits.",
        value=pair.depth,
        limit=pair.allowed,
        unit="mm",
        pose=pair.pose,
    )


def _short(number: float) -> str:
    """Round to 3 significant digits: a measured number enters a prompt."""
    return f"{float(f'{number:.3g}'):.10g}"
