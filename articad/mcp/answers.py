"""Answers: a command's report, shortened for an agent that pays for each byte, in the units of its plan."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from typing import Any, Final

from articad.aliases import Json
from articad.mcp.workbench import condensed, gathered

_DIGITS: Final = 6  # of a measured number
_SHOWN: Final = 3  # places that are listed for a loss
_NOTES: Final = 300  # characters of the notes on a plan


def compact(answer: Any) -> str:
    """Return JSON without spaces, with numbers of 6 digits and without null values."""
    return json.dumps(_spare(answer), ensure_ascii=False, separators=(",", ":"))


def verdict(report: Json) -> Json:
    """Return the verdict on a plan: errors and warnings in full, notes as one line each, in at most 300 characters together."""
    found = gathered(report)
    grave = [finding for finding in found if finding.get("severity") != "info"]
    answer = condensed(report | {"findings": grave}, detail=False)
    for finding in answer.get("findings", ()):
        finding.pop("route", None)  # it is always the plan's
    if not answer.get("findings"):
        answer.pop("findings", None)
    notes = [f"{finding['code']} {finding['where']}" for finding in found if finding.get("severity") == "info"]
    while sum(len(note) + 3 for note in notes) > _NOTES and len(notes) > 1:
        notes = [*notes[:-2], "… (detail: all)"] if notes[-1].startswith("…") else [*notes[:-1], "… (detail: all)"]
    return answer | ({"notes": notes} if notes else {})


def changed(before: Sequence[Json], report: Json) -> Json:
    """Return the verdict on a plan after a change: findings that were not there before, and how many are gone and remain."""
    known = {_key(finding) for finding in before}
    after = gathered(report)
    new = [finding for finding in after if _key(finding) not in known]
    old = [finding for finding in after if _key(finding) in known]
    remaining = [f"{finding['code']} {finding['where']}" for finding in old if finding.get("severity") != "info"]
    answer = verdict(report | {"findings": new})
    gone = len(known - {_key(finding) for finding in after})
    return answer | {"gone": gone} | ({"remaining": remaining} if remaining else {})


def _key(finding: Json) -> str:
    return json.dumps([finding.get(key) for key in ("code", "where", "message")])


def tidied(report: Json) -> Json:
    """Return the report of a part with its bounding box in steps of 0.0001 mm: without the dust of arithmetic."""
    if "bbox_mm" not in report:
        return report
    return report | {"bbox_mm": [[round(value, 4) + 0.0 for value in corner] for corner in report["bbox_mm"]]}


def solids(report: Json) -> Json:
    """Return a line for each part that was built: its mass and the size of its bounding box."""
    rows = report.get("parts") or ({report["part"]: report} if "part" in report else {})
    return {name: _solid(row) for name, row in rows.items()}


def _solid(row: Json) -> str:
    if "bbox_mm" not in row:
        return "failed"
    lower, upper = row["bbox_mm"]
    size = " x ".join(f"{high - low:.5g}" for low, high in zip(lower, upper, strict=True))
    mass = "" if row.get("mass_kg") is None else f", {row['mass_kg']:.4g} kg"
    return f"{size} mm{mass}"


def drivers(rows: Sequence[Json]) -> list[Json]:
    """Return the drivers: name, range and rest value in degrees and mm; an endless joint has no range."""
    return [
        {
            "name": row["name"],
            "unit": "deg" if row.get("unit") == "rad" else row.get("unit"),
            "range": None if row.get("lower") is None else [_shown(row["lower"], row), _shown(row["upper"], row)],
            "rest": _shown(row.get("rest"), row),
        }
        for row in rows
    ]


def proof(report: Json) -> Json:
    """Return the coverage of a certificate, and the free ranges that differ from the declared ones."""
    freedoms = [freedom for joint in report.get("mechanism", {}).get("joints", ()) for freedom in joint["freedoms"]]
    turning = {freedom["name"] for freedom in freedoms if any(freedom["turn"])}
    narrower = {
        row["joint"]: [_in_units(end, row["joint"] in turning) for end in row["free"]]
        for row in report.get("ranges", ())
        if row["free"] != row["declared"] and row["free"] is not None
    }
    return {
        "claims": len(report.get("claims", ())),
        "joints": report.get("asked"),
        "clearance_of_at_least_mm": report.get("epsilon_mm"),
        "free_only_in": narrower or None,
    }


def steps(order: Json) -> list[str] | None:
    """Return a line for each step of an order of assembly: what is put on, and its moves with their lengths in mm."""
    return [_step(row) for row in order.get("steps", ())] or None


def _step(row: Json) -> str:
    what = row.get("subassembly") or ", ".join(row["parts"])
    moves = [f"({', '.join(f'{part:.3g}' for part in move['direction'])}) {move['length_mm']:.4g}" for move in row["moves"]]
    return f"{what}: {', then '.join(moves) or 'start'}{'' if row['strength'] == 'proven' else ', by force'}"


def trials(report: Json) -> list[str]:
    """Return a line for each simulator: whether it loads and stays at rest, and what its joints reached."""
    return [_trial(row) for row in report.get("engines", ())]


def engines(report: Json) -> str:
    """Return which simulators load the file, and the messages of the others."""
    rows = report.get("engines", ())
    loading = sorted({row["engine"] for row in rows if row.get("loads")})
    failing = [f"not in {row['engine']}: {row['message']}" for row in rows if row.get("loads") is False]
    return "; ".join([f"loads in {', '.join(loading)}", *failing]) if rows else "not asked"


def losses(rows: Sequence[Json]) -> list[str]:
    """Return what a format cannot hold, each item once with its number and places."""
    grouped: dict[str, list[str]] = {}
    for row in rows:
        grouped.setdefault(row["lost"], []).append(row["where"])
    return [f"{lost} ({len(where)}: {', '.join(where[:_SHOWN])}{' …' if len(where) > _SHOWN else ''})" for lost, where in grouped.items()]


def _trial(row: Json) -> str:
    if row.get("loads") is None:
        return f"{row['engine']}: not installed"
    if not row["loads"]:
        return f"{row['engine']}: does not load: {row['message']}"
    reaches = row.get("reaches", ())
    reached = sum(reach["share"] > _REACHED for reach in reaches)
    speed, residual = row.get("speed_at_rest", 0.0), 1e3 * row.get("residual", 0.0)
    open_by = f", loops open by {residual:.2g} mm" if residual else ""
    return f"{row['engine']}: loads, {speed:.2g} rad/s or m/s at rest, {reached} of {len(reaches)} driven joints reach their ends{open_by}"


_REACHED: Final = 0.95  # of its range, as the verdict has it


def _shown(value: float | None, row: Json) -> float | None:
    return None if value is None else _in_units(value, row.get("unit") == "rad")


def _in_units(value: float, turns: bool) -> float:
    return math.degrees(value) if turns else value


def _spare(value: Any) -> Any:
    if isinstance(value, float):
        return float(f"{value:.{_DIGITS}g}") if math.isfinite(value) else str(value)
    if isinstance(value, dict):
        return {key: _spare(entry) for key, entry in value.items() if entry is not None}
    if isinstance(value, list | tuple):
        return [_spare(entry) for entry in value]
    return value
