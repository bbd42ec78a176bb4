"""Summaries: what commands print about their reports, for people."""

from __future__ import annotations

import math
import shlex
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from articad.files import is_file

if TYPE_CHECKING:
    from articad.commands.terminal import Report, Terminal
    from articad.findings import Findings

PAGE_FILE = "report.html"  # of a run
_CELL = 60  # characters of a value in a table
_SAME = 1e-6  # of components of unit vectors
_WAYS = {
    "down (-z)": (0.0, 0.0, -1.0),
    "up (+z)": (0.0, 0.0, 1.0),
    "along +x": (1.0, 0.0, 0.0),
    "along -x": (-1.0, 0.0, 0.0),
    "along +y": (0.0, 1.0, 0.0),
    "along -y": (0.0, -1.0, 0.0),
}
_MOST_FOUND = 4  # findings of a complete build that are shown, of two lines each
_NEAREST = 3  # pairs, or coordinates that follow, that are shown without -v


def print_run(report: Report, terminal: Terminal) -> None:
    """Print a finished run: what was made, what is proven, its findings, its files, and what to open."""
    print_assembly(report["assembly"], terminal)
    run, moves = report["run"], bool(report["assembly"]["drivers"])
    print_statements(report["checks"], report.get("certificate"), terminal, moves=moves, certify=f"articad certify {shlex.quote(run)}")
    if "certificate" in report:
        print_proof(report["certificate"], terminal)
    print_findings([*report["assembly"]["findings"], *report["checks"]["findings"], *report["findings"]], terminal)
    if "certificate" in report:
        print_findings(report["certificate"]["findings"], terminal)
    if "verdict" in report:
        print_verdict(report["verdict"], report["checks"], terminal)
    print_exports(report["exports"], terminal)
    terminal.say(f"Run: {run}")
    page = Path(run) / PAGE_FILE
    if is_file(page, root=page.parent):
        terminal.say(f"Open: articad show {shlex.quote(run)} ({page}, {page.stat().st_size / 1e6:.2f} MB)")
    else:
        terminal.say(f"Open: articad show {shlex.quote(run)}")


def print_complete(report: Report, terminal: Terminal, *, stood: Sequence[str] = ()) -> None:
    """Print a complete build in at most 15 lines: what holds, the findings that matter most, and where the files are.

    Args:
        report: `articad.build/1`, with `verification`.
        terminal: Where it is printed.
        stood: Formats whose files were loaded and held at rest in MuJoCo, without an objection.
    """
    from articad.interference.statements import statements

    assembly, run = report["assembly"], Path(report["run"])
    print_counts(assembly, terminal)
    for each in statements(
        report["checks"], report.get("certificate"), moves=bool(assembly["drivers"]), certify="first correct the errors"
    ):
        terminal.say(each.sentence)
    holders = (assembly, report["checks"], report, report.get("certificate", {}), *report["exports"].values())
    alike: dict[str, list[Report]] = {}
    for finding in (finding for holder in holders for finding in holder.get("findings", ()) if finding["severity"] != "info"):
        alike.setdefault(finding["code"], []).append(finding)
    groups = sorted(alike.values(), key=lambda group: group[0]["severity"] != "error")
    for group in groups[:_MOST_FOUND]:
        terminal.finding(group[0])
    if more := sum(map(len, groups)) - len(groups[:_MOST_FOUND]):
        places = f"{run / 'checks.json'} and {run / 'export'}/*/losses.json"
        terminal.say(f"  … and {more} more ({places}): {_counts(finding['code'] for group in groups for finding in group)}")
    if "verification" in report:
        verified = report["verification"]
        said = (
            "accepted by its checker" if verified["ok"] else "refuted by its checker" if verified["checked"] else "not read by its checker"
        )
        terminal.say(f"Certificate: {run / 'certificate.json'}, {': '.join([said, *verified['faults'][:1]])}.")
    files = [str(Path(export["main"]).relative_to(run)) for export in report["exports"].values()]
    held = f" ({' and '.join(stood)}: loaded and held at rest in MuJoCo)" if stood else ""
    terminal.say(
        f"Files in {run}: {', '.join(files)}{held}" if files else "Nothing is certified or exported before the checks at rest hold."
    )


def print_statements(
    checks: Report | None, certificate: Report | None, terminal: Terminal, *, moves: bool = True, certify: str = "articad certify RUN"
) -> None:
    """Print what is clear, proven, sampled or not checked."""
    from articad.interference.statements import statements

    said = statements(checks, certificate, moves=moves, certify=certify)
    together = 1 if checks is None else 2  # rest and motion are one line
    terminal.say(" ".join(each.sentence for each in said[:together]))
    for each in said[together:]:
        terminal.say(each.sentence)


def print_assembly(report: Report, terminal: Terminal) -> None:
    """Print the parts with their measurements, the joints, and the drivers."""
    parts, joints = report["parts"], report["joints"]
    rows = [
        (name, part["material"] or "", _number(part["volume_mm3"], ".1f"), _number(part["mass_kg"], ".4g"), part["derived_from"] or "")
        for name, part in parts.items()
    ]
    terminal.table(["part", "material", "volume mm³", "mass kg", "derived from"], rows, right=(2, 3))
    terminal.say()
    terminal.table(["joint", "type", "parent", "child"], [(name, j["type"], j["parent"], j["child"]) for name, j in joints.items()])
    terminal.say()
    print_counts(report, terminal)


def print_counts(report: Report, terminal: Terminal) -> None:
    """Print how many parts, joints and freedoms an assembly has, and its mass."""
    parts, joints = report["parts"], report["joints"]
    terminal.say(
        f"{report['name']}: {counted_things(len(parts), 'part', 'parts')}, {counted_things(len(joints), 'joint', 'joints')}, "
        f"{counted_things(report['freedoms'], 'freedom', 'freedoms')}, {report['mass_kg']:.4g} kg."
    )


def print_joints(rows: list[Report], terminal: Terminal) -> None:
    """Print for each joint its verdict, the surfaces that make it, and what they leave free."""
    terminal.say(
        f"Joints: {_counts(row['verdict'] for row in rows)}; examined at rest and, if no others hold them, at the ends of their ranges."
    )
    for row in rows:
        made = [f"{pair['kind']} ({' and '.join(pair['parts'])}, {pair['play_mm']:.3g} mm)" for pair in row["made_by"]]
        told = [", ".join(made) or "no surfaces found", *([row["reason"]] if row["reason"] else [])]
        if row["free"]:
            told.append("free: " + ", ".join(_free(way) for way in row["free"]))
        told += [f"held by {', which is held by '.join(chain)}" for chain in row["held_by"]]
        if row["engaged_share"] is not None:
            told.append(f"{100 * row['engaged_share']:.0f} % of the guide engaged at the ends")
        terminal.say(f"  {row['joint']}: {row['type']}, {row['verdict']}; {'; '.join(told)}")


def print_support(report: Report, terminal: Terminal) -> None:
    """Print how the product stands, what carries each body, and what keeps it in when the product is turned over."""
    if report["stances"]:
        least = min(report["stances"], key=lambda row: row["tip_deg"])
        at = ", ".join(f"{name} = {value:.4g}" for name, value in least["at"].items()) or "rest"
        stands = "stands" if all(row["stands"] for row in report["stances"]) else "does NOT stand"
        terminal.say(
            f"The product {stands} on a level floor; it tips over at {least['tip_deg']:.1f}° at the least, at {at} "
            f"({counted_things(len(report['stances']), 'pose', 'poses')}, drivers held)."
        )
    for row in report["bodies"]:
        on = [*row["rests_on"], *(f"joint {name}" for name in row["joints"])]
        told = [f"carried by {', '.join(on)}" if row["carried"] and on else "carried" if row["carried"] else "NOT carried"]
        if row["falls_out_turned_over"]:
            told.append("falls out when turned over")
        elif row["kept_by"]:
            told.append(f"kept in by {row['kept_by']}")
        ways = ", ".join(_way(way) for way in row["ways_out"])
        told.append(f"without joints it leaves {ways}" if ways else "captive: no straight way out")
        terminal.say(f"  {', '.join(row['parts'])}: {'; '.join(told)}")


def print_order(report: Report, terminal: Terminal) -> None:
    """Print the steps of an order of assembly, each with its path."""
    from articad.disassembly.steps import ENDED, beside_words, turned_over

    for step in report["steps"]:
        what = f"{step['subassembly']} ({', '.join(step['parts'])})" if step["subassembly"] else ", ".join(step["parts"])
        if not step["moves"]:
            terminal.say(f"{step['number']:3}. {step['assembly']}: start with {what}")
            continue
        path = ", then ".join(f"{_way(move['direction'])} by {move['length_mm']:.4g} mm{_turned(move['turns'])}" for move in step["moves"])
        forced = "".join(f", {a} and {b} by {how}" for a, b, how in step["permitted"])
        forced += turned_over(step["at"]) if step["opened"] else ""
        if step["slides"]:
            what += ", from beside its place,"
        elif step["parts"][0] in step["beside"]:
            path += f", to {beside_words(step['beside'][step['parts'][0]])}"
        terminal.say(f"{step['number']:3}. {step['assembly']}: {what} {path}; {step['strength']}{forced}")
    for blocked in report["blocked"]:
        terminal.say(f"No order was found that puts these together: {', '.join(blocked['parts'])}.{ENDED if blocked['ended'] else ''}")
    if report["left_out"]:
        terminal.say(f"Not considered, without a valid solid: {', '.join(report['left_out'])}.")
    terminal.say(f"{len(report['steps'])} steps. Not checked: {report['not_checked'][0].lower()}{report['not_checked'][1:]}")


def _turned(turns: float) -> str:
    """Return how often a part turns in its thread, such as `, 4 turns`; empty if it does not."""
    return f", {turns:g} turns" if turns else ""


def _free(way: Report) -> str:
    """Return a freedom that a joint leaves, such as `+z (2 mm)`."""
    unit = "rad" if way["way"].startswith("about") else "mm"
    told = [*([] if way["room"] is None else [f"{way['room']:.3g} {unit}"]), *(["against its weight"] if way["by_weight"] else [])]
    told += [f"held by {', which is held by '.join(way['held_by'])}"] if way["held_by"] else []
    return f"{way['way']} ({', '.join(told)})" if told else str(way["way"])


def _way(direction: list[float]) -> str:
    """Return a direction in words, such as `down (-z)`."""
    for name, axis in _WAYS.items():
        if max(abs(a - b) for a, b in zip(direction, axis, strict=True)) < _SAME:
            return name
    return f"along ({', '.join(f'{x:.3g}' for x in direction)})"


def print_certificate(report: Report, terminal: Terminal) -> None:
    """Print what is proven, what is not, and the free range of each joint."""
    print_statements(None, report, terminal)
    print_proof(report, terminal)
    print_findings(report["findings"], terminal)


def print_proof(report: Report, terminal: Terminal) -> None:
    """Print the numbers of a certificate: free ranges, least clearances, and how followers move."""
    for free in report["ranges"]:
        if free["free"] != free["declared"]:
            terminal.say(
                f"  {free['joint']}: free in [{free['free'][0]:.6g}, {free['free'][1]:.6g}], declared {free['declared']} (rad, mm)"
            )
    print_clearances(report.get("clearances", []), terminal)
    print_follows(report.get("follows", []), terminal)


def print_clearances(rows: list[Report], terminal: Terminal) -> None:
    """Print where parts that no joint connects come closest to each other; all pairs with -v."""
    shown = rows if terminal.verbose else [row for row in rows if row["relation"] != "mating"][:_NEAREST]
    if not shown:
        return
    terminal.say("Least clearances, sampled and not proven (rad, mm):")
    for row in shown:
        pose = ", ".join(f"{name} = {value:.4g}" for name, value in row["pose"].items()) or "rest"
        terminal.say(f"  {' and '.join(row['parts'])}: {row['gap_mm']:.4g} mm at {pose} ({row['strength']['poses']} poses)")
    if len(shown) < len(rows):
        terminal.say(f"  … and {len(rows) - len(shown)} more pairs (-v lists them)")


def print_follows(tables: list[Report], terminal: Terminal) -> None:
    """Print the values of followers at both ends of each driver's range; whole tables with -v."""
    for table in tables:
        names, units = list(table["followers"]), table["units"]
        rows = [
            [_in_degrees(value, units[table["driver"]]), *(_in_degrees(table["followers"][name][at], units[name]) for name in names)]
            for at, value in enumerate(table["values"])
        ]
        if terminal.verbose:
            terminal.say()
            terminal.table([table["driver"], *names], rows, right=tuple(range(len(names) + 1)))
            continue
        more = f" and {len(names) - _NEAREST} more (-v lists them)" if len(names) > _NEAREST else ""
        for row in (rows[0], rows[-1]):
            told = ", ".join(f"{name} {value}" for name, value in zip(names[:_NEAREST], row[1:], strict=False))
            terminal.say(f"  {table['driver']} {row[0]} → {told}{more}")


def _in_degrees(value: float, unit: str) -> str:
    return f"{math.degrees(value):.4g}°" if unit == "rad" else f"{value:.4g} {unit}"


def print_verdict(report: Report, checks: Report, terminal: Terminal) -> None:
    """Print the judge's rulings, and those of its findings that the checks have not already reported."""
    known = {finding["message"] for finding in checks["findings"]}
    terminal.say(f"Inspection, round {report['round']}: {'ok' if report['ok'] else 'NOT ok'}, decided by {report['by']}.")
    for aspect, ruling in report["rulings"].items():
        terminal.say(f"  {aspect}: {'ok' if ruling['ok'] else 'NOT ok'}. {ruling['reason']}")
    print_findings([finding for finding in report["findings"] if finding["message"] not in known], terminal)


def print_edit(report: Report, terminal: Terminal) -> None:
    """Print what an edit has changed, and what became of each part."""
    terminal.say()
    terminal.say(f"Edit: {report['summary']}" if report["summary"] else "Edit:")
    changed = [(change["where"], _shortly(change["before"]), _shortly(change["after"])) for change in report["changes"]]
    terminal.table(["in the plan", "before", "after"], changed)
    terminal.say()
    rows = [
        (name, row["fate"], row["why"], f"{row['equal']} of {row['files']}", ", ".join(row["different"]))
        for name, row in report["parts"].items()
    ]
    terminal.table(["part", "fate", "why", "files equal", "files that differ"], rows)
    untouched = [row for row in report["parts"].values() if row["fate"] == "untouched"]
    terminal.say(
        f"Untouched: {counted_things(len(untouched), 'part', 'parts')}, {counted_things(sum(row['files'] for row in untouched), 'file', 'files')} "
        f"equal by sha256. Pairs of parts: {report['pairs']['checked']} checked, {report['pairs']['carried']} carried over."
    )


def print_review(report: Report, terminal: Terminal) -> None:
    """Print the scores of a review."""
    rules = ", ".join(f"{name.replace('_', ' ')} {score:.2f}" for name, score in report["rules"].items())
    terminal.say(f"Review by rules (0 to 1): {rules}.")
    for aspect, scored in (report["model"] or {}).items():
        terminal.say(f"  {aspect}: {scored['score']} of 5. {scored['reason']}")


def print_exports(exports: Mapping[str, Report], terminal: Terminal) -> None:
    """Print each export's main file, its size, one line for each kind of loss (all rows with -v), and the writers' findings, each once."""
    for name, export in exports.items():
        meshes = sum(size for path, size in export["files"].items() if path.endswith((".stl", ".obj")))
        weight = f", {sum(export['files'].values()) / 1e6:.2f} MB" + (f" with {meshes / 1e6:.2f} MB of meshes" if meshes else "")
        terminal.say(f"{name.upper()}: {export['main']} ({counted_things(len(export['files']), 'file', 'files')}{weight})")
        alike: dict[str, list[Report]] = {}
        for row in export["rows"]:
            alike.setdefault(row["lost"], []).append(row)
        for lost, rows in alike.items():
            if terminal.verbose:
                for row in rows:
                    terminal.say(f"  {row['where']}: written as {row['kept']}; lost: {lost}")
                continue
            others = f" and {len(rows) - 1} more, -v lists them" if len(rows) > 1 else ""
            terminal.say(f"  lost: {lost} ({rows[0]['where']}{others})")
    findings: list[Report] = []
    for export in exports.values():
        findings += [finding for finding in export.get("findings", []) if finding not in findings]
    print_findings(findings, terminal)


def print_findings(findings: list[Report], terminal: Terminal) -> None:
    """Print the findings of a report; for the same fault of the same parts at several poses only the worst, unless -v is given."""
    groups: dict[tuple[Any, ...], list[Report]] = {}
    for number, finding in enumerate(findings):
        parts = tuple(finding.get("parts") or ())
        groups.setdefault((finding["code"], parts) if parts and not terminal.verbose else (number,), []).append(finding)
    for group in groups.values():
        terminal.finding(max(group, key=lambda finding: abs(finding.get("value") or 0.0)))
        if len(group) > 1 and not (terminal.quiet and group[0]["severity"] != "error"):
            terminal.say(f"    … and {len(group) - 1} more of these parts (-v lists them)")


def counted(findings: Findings) -> str:
    """Return `2 errors, 1 warning`, or `no findings`."""
    count = Counter(str(finding.severity) for finding in findings)
    names = {"error": ("error", "errors"), "warning": ("warning", "warnings"), "info": ("note", "notes")}
    return ", ".join(counted_things(count[severity], *words) for severity, words in names.items() if count[severity]) or "no findings"


def counted_things(count: int, one: str, many: str) -> str:
    """Return `1 loss`, `2 losses`."""
    return f"{count} {one if count == 1 else many}"


def _counts(words: Iterable[str]) -> str:
    counter = Counter(words)
    return ", ".join(f"{count} {word}" for word, count in sorted(counter.items()))


def _shortly(value: object) -> str:
    text = "" if value is None else str(value.get("name", "an entry")) if isinstance(value, dict) else str(value)
    return text if len(text) <= _CELL else f"{text[: _CELL - 1]}…"


def _number(value: float | None, form: str) -> str:
    return "" if value is None else format(value, form)
