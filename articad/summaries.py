"""Summaries: what commands print of assemblies, checks and exports, for people to read."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from articad.assembly import Assembly
    from articad.findings import Findings
    from articad.interference.check import Checks
    from articad.terminal import Report, Terminal


def print_assembly(assembly: Assembly, terminal: Terminal) -> None:
    """Print the parts with their measures, then what moves."""
    rows = []
    for name, part in assembly.parts.items():
        volume = "" if part.solid is None else f"{part.solid.volume:.1f}"
        mass = "" if part.mass is None else f"{part.mass.mass:.4g}"
        rows.append((name, part.material or "", volume, mass, _made(assembly, name)))
    terminal.table(["part", "material", "volume mm³", "mass kg", "made"], rows, right=(2, 3))
    joints = [(joint.name, joint.type, joint.parent, joint.child) for joint in assembly.joints]
    terminal.say()
    terminal.table(["joint", "type", "parent", "child"], joints)
    terminal.say()
    total = f", {assembly.mass().mass:.4g} kg" if any(part.mass is not None for part in assembly.parts.values()) else ""
    terminal.say(f"{assembly.name}: {len(rows)} parts, {len(joints)} joints, {assembly.mechanism.mobility} freedoms{total}.")


def print_checks(checks: Checks, terminal: Terminal) -> None:
    """Print how the pairs of parts fared, how that is known, and the deepest overlap."""
    verdicts = Counter(pair.verdict for pair in checks.pairs)
    strengths = Counter(pair.strength.kind.replace("_", " ") for pair in checks.pairs)
    told = ", ".join(f"{count} {verdict}" for verdict, count in sorted(verdicts.items()))
    known = ", ".join(f"{count} {kind}" for kind, count in sorted(strengths.items()))
    over = checks.over if isinstance(checks.over, str) else " and ".join(checks.over)
    pairs = f"{len(checks.pairs)} pairs are near each other ({told}; {known})" if checks.pairs else "no two parts are near each other"
    terminal.say(f"Check at {over}: {'ok' if checks.ok else 'NOT ok'}; {pairs}.")
    deepest = max(checks.pairs, key=lambda pair: pair.depth, default=None)
    if deepest is not None and deepest.depth > 0:
        names = " and ".join(deepest.parts)
        terminal.say(f"Largest overlap depth: {deepest.depth:.6g} mm ({names}; {deepest.allowed:.6g} mm allowed).")
    else:
        terminal.say("Largest overlap depth: 0 mm.")


def print_exports(exports: Mapping[str, Report], terminal: Terminal) -> None:
    """Print each export's main file, and everything that was lost in it."""
    for name, export in exports.items():
        terminal.say(
            f"{name.upper()}: {export['main']} ({len(export['files'])} files, {counted_things(len(export['rows']), 'loss', 'losses')})"
        )
        for row in export["rows"]:
            terminal.say(f"  {row['where']}: {row['kept']}; lost: {row['lost']}")


def counted(findings: Findings) -> str:
    """Return `2 errors, 1 warning`, or `no findings`."""
    count = Counter(str(finding.severity) for finding in findings)
    names = (("error", "errors"), ("warning", "warnings"), ("info", "notes"))
    told = [counted_things(count[one], "note" if one == "info" else one, many) for one, many in names if count[one]]
    return ", ".join(told) or "no findings"


def counted_things(count: int, one: str, many: str) -> str:
    """Return `1 loss`, `2 losses`."""
    return f"{count} {one if count == 1 else many}"


def _made(assembly: Assembly, name: str) -> str:
    realised = assembly.realised.get(name)
    if realised is None:
        return ""
    if realised.derived_from is not None:
        return f"from {realised.derived_from}"
    return "kept" if realised.cached else "built"
