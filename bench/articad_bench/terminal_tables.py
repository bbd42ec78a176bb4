"""Tables of the benchmark in a terminal: every mean with the ends of its 95 % interval."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from articad.commands.terminal import Report, Terminal
    from articad_bench.sentences import Number, Sentences

_WORDS: Final = 44  # characters of what failed


def print_table(report: Report, terminal: Terminal) -> Report:
    """Print the table of a benchmark, and return its report."""
    rows = [
        (
            row["task"],
            "yes" if row["passed"] else "no",
            _short(row["error"] or row["edit_error"] or ", ".join(row["failed"])),
            row["iterations"],
            row["calls"],
            row["tokens"],
            _money(row["cost_usd"]),
        )
        for row in report["rows"]
    ]
    terminal.table(["task", "passed", "failed checks", "iterations", "calls", "tokens", "US$"], rows)
    for name, group in {"all": report["all"], **report["by_kind"], **report["by_modality"]}.items():
        terminal.say(f"{name}: {told(group['passed'], percent=True)} of {group['tasks']} passed (95 %)")
    whole = report["all"]
    terminal.say(
        f"made: {told(whole['made'], percent=True)}; checks that hold, by task: {told(whole['checks'], percent=True)}"
        + (f"; edits: {told(whole['edited'], percent=True)} of {whole['edited']['n']}" if whole["edited"]["n"] else "")
    )
    if whole["calls"]["mean"]:
        terminal.say(effort(whole))
    return report


def print_judged(report: Report, terminal: Terminal) -> Report:
    """Print the table of judges, and return its report."""
    rows = []
    for name, group in {"all judges": report["all"], **report["by_judge"], **report["by_kind"]}.items():
        scores = [told(group[dimension]) for dimension in ("geometry", "detail", "motion", "motion_still_as_5")]
        rows.append((name, group["tasks"], told(group["success"], percent=True), *scores))
    terminal.table(["", "tasks", "success", "geometry", "detail", "motion", "motion, still as 5"], rows)
    for dimension, row in report["agreement"].items():
        alpha, icc = (_interval(row[name]["value"], row[name]["interval"]) for name in ("krippendorff_alpha", "icc_2k"))
        terminal.say(f"{dimension}: Krippendorff's alpha {alpha}, ICC(2,{row['judges']}) {icc}, over {row['tasks']} tasks")
    spent = report["spent"]
    cost = "of unknown price" if spent["cost_usd"] is None else f"${told(spent['cost_usd'])}"
    terminal.say(f"each opinion: {told(spent['calls'])} calls, {told(spent['tokens'])} tokens, {cost}")
    for row in report["rows"]:
        if row["error"]:
            terminal.say(f"{row['task']}: {row['error']}")
    return report


def print_data(report: Report, terminal: Terminal) -> Report:
    """Print the table of scores on public data, and return its report."""
    names = list(report["ours"])
    lines = [(who, how) for who in ("ours", "floor", "box") for how in ("mean", "median")]
    rows = [(f"{who}, {how}", *(told(report[who][name][how]) for name in names)) for who, how in lines]
    for who in ("ours", "floor", "box"):
        spreads = [report[who][name]["spread"] for name in names]
        rows.append((f"{who}, ± over {len(report['seeds'])} seeds", *("–" if spread is None else f"{spread:.2g}" for spread in spreads)))
    terminal.table(["", *(name.replace("_", " ") for name in names)], rows)
    terminal.say(f"{report['samples']} samples; compile rate: {told(report['made'], percent=True)}")
    if report["calls"]["n"]:
        terminal.say(effort(report))
    for row in report["left_out"]:
        terminal.say(f"{row['name']} is left out: {row['error']}")
    for row in report["rows"]:
        if row["error"]:
            terminal.say(f"{row['name']}: {row['error']}")
    return report


def print_sentences(tables: Mapping[str, Sentences], terminal: Terminal) -> Report:
    """Print the table of sentences of tasks, by name, and return it: it is in order if every number is held and every check stated."""
    numbers = [(name, row) for name, table in tables.items() for row in table.numbers]
    checks = [(name, row) for name, table in tables.items() for row in table.checks]
    terminal.table(
        ["task", "number", "sentence", "held by"],
        [
            (name, _in_unit(row.number), _short(row.number.sentence), "; ".join(row.checks) or row.reason or "NOTHING")
            for name, row in numbers
        ],
    )
    terminal.table(["task", "check", "stated by"], [(name, f"{row.kind}: {row.check}", row.stated or "NOTHING") for name, row in checks])
    held, marked = sum(bool(row.checks) for _, row in numbers), sum(not row.checks and row.held for _, row in numbers)
    unstated = sum(row.stated is None for _, row in checks)
    terminal.say(
        f"{len(numbers)} numbers: checks hold {held}, {marked} have a reason, {len(numbers) - held - marked} have neither. "
        f"{len(checks)} checks: {unstated} are stated nowhere."
    )
    return {
        "schema": "articad.bench-sentences/1",
        "ok": held + marked == len(numbers) and not unstated,
        "findings": [],
        "tasks": [{"task": name} | table.to_json() for name, table in tables.items()],
    }


def _in_unit(number: Number) -> str:
    return f"{number.value:g}" if number.unit == "count" else f"{number.value:g} {number.unit}"


def effort(group: Mapping[str, Any]) -> str:
    """Return what a task took, in words."""
    cost = "of unknown price" if group["cost_usd"] is None else f"${told(group['cost_usd'])}"
    return f"each task: {told(group['iterations'])} iterations, {told(group['calls'])} calls, {told(group['tokens'])} tokens, {cost}"


def told(number: Mapping[str, Any], *, percent: bool = False) -> str:
    """Return a mean or median with its interval, `3.21 [2.90, 3.50]`."""
    return _interval(number.get("mean", number.get("median")), number["interval"], percent=percent)


def _interval(value: float | None, interval: Any, *, percent: bool = False) -> str:
    if value is None:
        return "none"
    factor, unit = (100, " %") if percent else (1, "")
    low, high = (value if end is None else end for end in interval)
    return f"{_digits(factor * value)}{unit} [{_digits(factor * low)}, {_digits(factor * high)}]"


def _digits(value: float) -> str:
    return f"{value:.0f}" if abs(value) >= 1000 else f"{value:.4g}" if abs(value) >= 100 else f"{value:.3g}"


def _money(cost: float | None) -> str:
    return "?" if cost is None else f"{cost:.4f}"


def _short(text: str) -> str:
    return text if len(text) <= _WORDS else text[: _WORDS - 1] + "…"
