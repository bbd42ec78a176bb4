"""Sentences about reports: what is clear at rest, what is proven of the motion, which fits hold, and what was not checked.

The terminal and the page say the same, from the same reports. A statement covers what its words cover and no more: one pose is never
called free of interference without "at rest", and a motion without a certificate is never called proven.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any, Literal, NamedTuple

__all__ = ["Statement", "about_fits", "about_motion", "about_rest", "statements"]

Json = Mapping[str, Any]
State = Literal["good", "warn", "bad"]
_AT_ONCE = "proven while all of these joints move at once"  # how `covers` begins when no combination of joints is left out


class Statement(NamedTuple):
    """A statement: a few words for a badge, a sentence for a terminal, and whether it is good news."""

    badge: str
    sentence: str
    state: State


def statements(
    checks: Json | None, certificate: Json | None, *, moves: bool = True, certify: str = "articad certify RUN"
) -> list[Statement]:
    """Return all statements about reports, in reading order.

    Args:
        checks: Report `articad.checks/1`, or None.
        certificate: Report `articad.certificate/2`, or None.
        moves: Whether any joint can move.
        certify: The command that proves the motion.
    """
    found = []
    if checks is not None:
        found.append(about_rest(checks))
    if checks is not None or certificate is not None:
        found.append(about_motion(checks, certificate, moves=moves, certify=certify))
    # A certificate knows more about the same fits than the check of one pose.
    rows = (certificate or {}).get("fits") or (checks or {}).get("fits") or ()
    if rows:
        found.append(about_fits(rows))
    return found


def about_rest(checks: Json) -> Statement:
    """Return the statement about the pose at rest."""
    pairs = [pair for pair in checks["pairs"] if pair["over"] == "rest"]
    overlaps = [pair for pair in pairs if pair["verdict"] == "overlap" and pair["strength"]["kind"] != "waived"]
    waived = sum(pair["verdict"] == "overlap" for pair in pairs) - len(overlaps)
    unknown = sum(pair["verdict"] == "unknown" for pair in pairs)
    # Parts that a joint connects touch by design; other contacts are within the tolerance of the meshes.
    joined = sum(pair["verdict"] == "contact" and pair["relation"] != "unrelated" for pair in pairs)
    touching = sum(pair["verdict"] == "contact" for pair in pairs) - joined
    parts = [
        (len(overlaps), "overlapping"),
        (unknown, "not checked"),
        (sum(pair["verdict"] == "clear" for pair in pairs), "clear"),
        (joined, "touching by design"),
        (touching, "touching, with no joint between them"),
        (waived, "overlapping as the plan allows"),
    ]
    listed = ", ".join(f"{count} {what}" for count, what in parts if count)
    near = f"{_counted(len(pairs), 'nearby pair')}: {listed}" if pairs else "no two parts are near each other"
    if overlaps:
        worst = max(overlaps, key=lambda pair: float(pair["depth_mm"]))
        deepest = f"deepest {worst['depth_mm']:.3g} mm: {' and '.join(worst['parts'])}, {worst['allowed_mm']:.3g} mm allowed"
        return Statement(f"{_counted(len(overlaps), 'overlap')} at rest", f"Interference at rest ({near}; {deepest}).", "bad")
    if unknown:
        return Statement(
            f"{_counted(unknown, 'pair')} not checked at rest",
            f"No interference found at rest, but not every pair was checked ({near}).",
            "warn",
        )
    return Statement("clear at rest", f"No interference at rest ({near}).", "good")


def about_motion(checks: Json | None, certificate: Json | None, *, moves: bool = True, certify: str = "articad certify RUN") -> Statement:
    """Return the statement about the motion: proven, sampled, or neither."""
    if certificate is not None:
        return _certified(certificate)
    if not moves:
        return Statement("nothing moves", "Nothing moves.", "good")
    pairs = [pair for pair in (checks or {}).get("pairs", ()) if pair["over"] not in ("rest", "pose")]
    if not pairs:
        return Statement("motion not proven", f"Motion not proven: {certify}.", "warn")
    colliding = [pair for pair in pairs if pair["verdict"] == "overlap" and pair["strength"]["kind"] != "waived"]
    cases = f"{_counted(len(pairs), 'case')} of pairs and joints"
    if colliding:
        names = {tuple(pair["parts"]) for pair in colliding}
        return Statement(
            f"{_counted(len(names), 'pair')} collide in motion" if len(names) > 1 else "1 pair collides in motion",
            f"Collision in motion ({len(colliding)} of {cases}).",
            "bad",
        )
    unknown = sum(pair["verdict"] == "unknown" for pair in pairs)
    if unknown:
        return Statement(
            f"motion sampled, {unknown} not checked",
            f"Motion sampled and not proven ({unknown} of {cases} not checked): {certify}.",
            "warn",
        )
    poses = max(int(pair["strength"].get("poses") or 0) for pair in pairs)
    return Statement("motion sampled", f"No collision at up to {poses} sampled poses of {cases}. Motion not proven: {certify}.", "warn")


def _certified(certificate: Json) -> Statement:
    pairs = certificate["pairs"]
    kinds = Counter(pair["strength"]["kind"] for pair in pairs)
    proven, waived = kinds["certified"], kinds["waived"]
    colliding = sum(pair["verdict"] == "overlap" and pair["strength"]["kind"] != "waived" for pair in pairs)
    whole = f"{proven} of {len(pairs)}"
    allowed = f", {waived} allowed by the plan" if waived else ""
    covers = str(certificate.get("covers", ""))
    loose = [finding for finding in certificate.get("findings", ()) if finding["code"] == "E_TOLERANCE"]
    if loose and not colliding:
        return Statement(
            f"{_counted(len(loose), 'pair')} can meet within tolerance",
            f"Motion NOT proven within tolerance: {_counted(len(loose), 'pair')} can meet. As modelled, {whole} cases certified{allowed}.",
            "bad",
        )
    if certificate["ok"]:
        if not pairs:
            return Statement("motion certified", f"Motion certified: no two parts come near each other; {covers}", "good")
        limit = "" if covers.startswith(_AT_ONCE) else ", not all joints at once"
        limit += ", free joints at rest" if "free joints stay at rest" in covers else ""
        return Statement(f"motion certified {whole}{allowed}{limit}", f"Motion certified: {whole} cases{allowed}; {covers}", "good")
    if colliding:
        return Statement(
            f"motion collides in {colliding} of {_counted(len(pairs), 'case')}",
            f"Motion NOT free: {colliding} of {_counted(len(pairs), 'case')} collide, {proven} certified{allowed}.",
            "bad",
        )
    return Statement(
        f"motion certified {whole} only{allowed}", f"Motion NOT fully proven: {whole} cases certified{allowed}; {covers}", "bad"
    )


def about_fits(rows: Sequence[Json]) -> Statement:
    """Return the statement about declared fits; `rows` is not empty."""
    verdicts = Counter(row["verdict"] for row in rows)
    held = [row for row in rows if row["verdict"] == "ok"]
    certified = sum(row["strength"]["kind"] == "certified" for row in held)
    unchecked = verdicts["not_checked"]
    wrong = len(rows) - len(held) - unchecked
    fits = _counted(len(rows), "fit")
    how = f"{certified or 'none'} certified while {'its joint moves' if certified == 1 else 'their own joints move'}"
    if wrong:
        kinds = ", ".join(f"{count} {verdict}" for verdict, count in sorted(verdicts.items()) if verdict not in ("ok", "not_checked"))
        return Statement(f"{wrong} of {fits} wrong", f"Fits: {wrong} of {len(rows)} wrong ({kinds}).", "bad")
    if unchecked:
        return Statement(
            f"{unchecked} of {fits} not checked", f"Fits: {len(held)} of {len(rows)} hold ({how}), {unchecked} not checked.", "warn"
        )
    measured = "certified" if certified == len(rows) else "measured"
    return Statement(f"{fits} {measured}", f"Fits: {'it holds' if len(rows) == 1 else f'all {len(rows)} hold'} ({how}).", "good")


def _counted(count: int, thing: str) -> str:
    return f"{count} {thing}{'' if count == 1 else 's'}"
