"""The table of planted faults: results as JSON, and the page that shows them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final

from articad_bench.fault_reasons import REASONS
from articad_bench.fault_trial import Row
from articad_bench.faulty import Kind

__all__ = ["SCHEMA", "alarms_line", "page", "report", "rows_of"]

SCHEMA: Final = "articad.bench-faults/1"
_STAGES: Final = ("plan", "build", "evidence", "sampled")
_COLUMNS: Final = ("cases", "same", "valid", *_STAGES, "escaped", "named", "addressed", "repaired", "healed")

_ABOUT: Final = """\
# Planted faults

<!-- Written by `articad bench faults --out docs/reference` from its results, faults.json. -->

A good product, one mistake made by rule, and what the pipeline finds of it without any model. Each kind of mistake is planted at most once in a product, at a
place drawn with a fixed seed. [The how-to](../how-to/benchmark.md#plant-faults) says how to run it.

- **found in**: the step that found something: the check of the *plan*, the *build* with the contract of each part, the *evidence* (overlaps and fits at rest,
  samples of each joint's range), or the full *sampled* check of `articad build --verify sampled`. An error ends the trial, as does a warning that a run sends back to its author; the *sampled* check follows if nothing was found before.
- **same**: nothing is found because the product is the same: parts, masses, places at rest and in motion, limits, couplings and fits. Such cases are not counted.
- **valid**: nothing is found about a faulty plan, and the product holds every check of its task, so that it is another answer to the same request. Such cases
  are not counted either; they are listed below.
- **escaped**: no error and no warning, although the product is another one.
- **named**: a finding names a part or joint of the mistake, and its code is one of those that state this cause. An escape is not named.
- **addressed**: all such findings of the highest severity go to whoever made the mistake, the author of the plan or of this script, without a model deciding it.
  Where a plan orders connectors or boxes elsewhere than the scripts build the features, a script departs from its order as well: either author is right.
- **repaired**: so many cases were repaired by somebody who only does what the hints say. Hints about plans are followed one after another, in the order of
  findings and alternatives, until the plan has no finding; what results is built and examined, at most three products. Whoever is asked about a faulty
  script writes what was ordered.
- **healed**: the repair ends without errors and warnings.
"""


def rows_of(stored: Mapping[str, Any]) -> list[Row]:
    """Return the rows of a stored report."""
    return [Row(**{**row, "findings": tuple(map(tuple, row["findings"]))}) for row in stored["rows"]]


def report(
    rows: Iterable[Row], alarms: Mapping[str, Sequence[str]], *, planned: int, examined_by: str = "", judged_by: str = ""
) -> dict[str, Any]:
    """Return the report of a run.

    Args:
        rows: One for each case that was tried.
        alarms: Findings above a note about each good product that was examined.
        planned: Number of cases of the run.
        examined_by: Digest of the programs that examined the good products.
        judged_by: Digest of the newest programs that judged a case.
    """
    rows = list(rows)
    return {
        "schema": SCHEMA,
        "ok": True,
        "findings": [],
        "planned": planned,
        "all": _counts(rows),
        "plan": _counts([row for row in rows if row.side == "plan"]),
        "script": _counts([row for row in rows if row.side == "script"]),
        "products": sorted({row.product for row in rows}),
        "alarms": {product: list(findings) for product, findings in alarms.items()},
        "examined_by": examined_by,
        "judged_by": judged_by,
        "rows": [row.to_json() for row in rows],
    }


def _counts(rows: Sequence[Row]) -> dict[str, int]:
    counted = [row for row in rows if row.counts]
    counts = {"cases": len(counted), "same": sum(row.equivalent for row in rows), "valid": sum(row.valid for row in rows)}
    counts |= {name: sum(row.stage == name for row in counted) for name in _STAGES}
    counts |= {name: sum(getattr(row, name) for row in counted) for name in ("escaped", "named", "addressed")}
    repaired = [row for row in counted if row.healed is not None]
    return counts | {"repaired": len(repaired), "healed": sum(bool(row.healed) for row in repaired)}


def alarms_line(told: Mapping[str, Any]) -> str:
    """Return how many false alarms a report has, and on how many good products."""
    if not told["alarms"]:
        return "False alarms: not measured; the good products were not examined."
    return f"False alarms: {sum(map(len, told['alarms'].values()))}, on {len(told['alarms'])} good products."


def page(told: Mapping[str, Any], kinds: Sequence[Kind]) -> str:
    """Return the page of a report.

    Args:
        told: As `report` returns it.
        kinds: All kinds, in the order of the table.
    """
    rows = rows_of(told)
    heads = ("", *_COLUMNS)
    newest = [row for row in rows if row.programs and row.programs == told.get("judged_by")]
    lines = [
        _ABOUT,
        f"{len(rows)} of {told['planned']} cases were tried, {len(newest)} of them by the newest programs and the others by earlier ones.",
        f"{len(told['products'])} products: {', '.join(told['products'])}.",
    ]
    lines += [alarms_line(told) + "".join(f"\n- {name}: {alarm}" for name, found in told["alarms"].items() for alarm in found), ""]
    lines += _table(heads, [_line(name, told[name]) for name in ("plan", "script", "all")])
    shares = {"Escaped": "escaped", "Named": "named", "Addressed": "addressed"}
    said = [f"{title}: {_share(told['all'], key)}." for title, key in shares.items()]
    repaired, cases = told["all"]["repaired"], told["all"]["cases"]
    some = "" if repaired == cases else "at least "
    lines += [" ".join([*said, f"Hints heal: {some}{_share(told['all'], 'healed')}; {repaired} cases were repaired."])]
    for side, title in (("plan", "Mistakes in plans"), ("script", "Mistakes in scripts")):
        of_side = [(kind, [row for row in rows if row.kind == kind.name]) for kind in kinds if kind.side == side]
        lines += ["", f"## {title}", ""]
        lines += _table(heads, [_line(f"`{kind.name}`: {kind.meaning}", _counts(mine)) for kind, mine in of_side if mine])
    lines += [
        "## Escapes",
        "",
        "No error and no warning.",
        "",
    ]
    lines += _table(("case", "mistake", "why"), [(f"`{row.case}`", row.said, REASONS.get(row.case, "")) for row in rows if row.escaped])
    lines += ["## Other valid answers", "", *_table(("case", "mistake"), [(f"`{row.case}`", row.said) for row in rows if row.valid])]
    elsewhere = [(f"`{row.case}`", row.said, _first(row)) for row in rows if row.named and not row.addressed]
    lines += ["## Named, but addressed to another", "", *_table(("case", "mistake", "first finding"), elsewhere)]
    defects = [(f"`{row.case}`", row.said, row.findings[0][3]) for row in rows if row.stage == "defect"]
    lines += ["## Defects of articad", "", *_table(("case", "mistake", "exception"), defects)]
    unnamed = [
        (f"`{row.case}`", row.said, _first(row)) for row in rows if row.counts and not (row.named or row.escaped or row.stage == "defect")
    ]
    lines += ["## Found, but not named", "", *_table(("case", "mistake", "first finding"), unnamed)]
    return "\n".join(lines).rstrip() + "\n"


def _first(row: Row) -> str:
    code, where, route, _ = row.findings[0]
    return f"`{code}` {where}" + (f" ({route})" if route else "")


def _line(name: str, counts: Mapping[str, int]) -> tuple[str, ...]:
    return (name, *(str(counts[key] or "") for key in _COLUMNS))


def _share(counts: Mapping[str, int], key: str) -> str:
    return f"{counts[key]} of {counts['cases']} ({100 * counts[key] / max(counts['cases'], 1):.1f} %)"


def _table(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    if not rows:
        return ["None.", ""]
    return [f"| {' | '.join(heads)} |", "|---" * len(heads) + "|", *(f"| {' | '.join(cells)} |" for cells in rows), ""]
