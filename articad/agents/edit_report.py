"""The report of an edit: what has changed in the plan and in the parts, and the proof that nothing else has.

The proof compares bytes: the sha256 of every file of every part, before and after. Which parts an edit may change follows from the plans
alone, before anything is built: those whose script input differs.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Final, Literal

import numpy as np

from articad.agents.edit_base import Base
from articad.agents.evidence import Known
from articad.aliases import Json
from articad.findings import Finding, Findings
from articad.interference.check import Checks
from articad.plan.brief import brief, brief_digest
from articad.plan.resolve import ResolvedPart, ResolvedPlan
from articad.plan.schema import AssemblyPlan
from articad.runs.run import Run

Reach = Literal["new", "removed", "described anew", "other numbers", "follows its source", "mirrored anew"]

SCHEMA: Final = "articad.edit/1"
_DIGITS = 6  # decimals of mm in a sentence
_SHOWN = 60  # characters of a value in a sentence


# ---------------------------------------------------------------------- before anything is built


def reach(before: ResolvedPlan, after: ResolvedPlan) -> dict[str, Reach]:
    """Return the parts that another plan changes, and how; a part that only moves or changes its colour is not among them."""
    touched: dict[str, Reach] = {name: "removed" for name in before.parts if name not in after.parts}
    for name, part in after.parts.items():
        old = before.parts.get(name)
        if old is None:
            touched[name] = "new"
        elif part.derivation is None and old.derivation is None:
            if brief_digest(before, name) != brief_digest(after, name):
                touched[name] = "described anew"
            elif brief(before, name) != brief(after, name):
                touched[name] = "other numbers"
        elif not _derived_alike(old, part):
            touched[name] = "described anew"
        elif not _same_bits(old, part):
            touched[name] = "mirrored anew"
    following = True
    while following:  # copies of copies follow as well
        follows = [n for n, p in after.parts.items() if n not in touched and p.derivation is not None and p.derivation.source in touched]
        touched |= dict.fromkeys(follows, "follows its source")
        following = bool(follows)
    return touched


def told_otherwise(before: ResolvedPlan, after: ResolvedPlan, name: str) -> str:
    """Return in words how the input of a part's script differs."""
    if name not in before.parts or name not in after.parts or after.parts[name].derivation is not None:
        return ""
    changes = list(_compared("", brief(before, name), brief(after, name)))
    if not changes:
        return "its role, its orientation or its kernel"
    shown = [f"{change['where']} {_quoted(change['before'])} → {_quoted(change['after'])}" for change in changes[:3]]
    return "; ".join(shown) + ("; …" if len(changes) > len(shown) else "")


def _derived_alike(old: ResolvedPart, new: ResolvedPart) -> bool:
    if old.derivation is None or new.derivation is None or old.derivation.source != new.derivation.source:
        return False
    a, b = old.derivation.S, new.derivation.S
    return (a is None) == (b is None) and (a is None or b is None or bool(np.allclose(a, b, rtol=0.0, atol=1e-9)))


def _same_bits(old: ResolvedPart, new: ResolvedPart) -> bool:
    """Return whether two mirrored parts are equal to the last bit; a part at another place may be rounded differently when mirrored."""
    a, b = (part.derivation.S if part.derivation is not None else None for part in (old, new))
    return a is None or b is None or np.array_equal(a, b)


# ---------------------------------------------------------------------- what has changed in a plan


def changes(before: AssemblyPlan, after: AssemblyPlan) -> list[Json]:
    """Return the differences between two plans: address, and the value before and after, None where there is none."""
    return list(_compared("", before.to_json(), after.to_json()))


def _compared(where: str, before: Any, after: Any) -> Iterator[Json]:
    if before == after:
        return
    if isinstance(before, Mapping) and isinstance(after, Mapping):
        for key in dict.fromkeys((*before, *after)):
            yield from _compared(f"{where}.{key}" if where else str(key), before.get(key), after.get(key))
        return
    ours, theirs = _by_name(before), _by_name(after)
    if ours is not None and theirs is not None and (ours or theirs):
        for name in dict.fromkeys((*ours, *theirs)):
            yield from _compared(f"{where}.{name}", ours.get(name), theirs.get(name))
        return
    yield {"where": where, "before": before, "after": after}


def _by_name(value: Any) -> dict[str, Any] | None:
    """Return the entries of a list by their names, or None if the value is not such a list. A missing list is empty."""
    if value is None:
        return {}
    if not isinstance(value, list) or not all(isinstance(entry, dict) and "name" in entry for entry in value):
        return None
    return {entry["name"]: entry for entry in value}


def _quoted(value: Any) -> str:
    if value is None:
        return "nothing"
    text = str(value.get("name", "an entry")) if isinstance(value, Mapping) else str(_plain(value))
    return text if len(text) <= _SHOWN else f"{text[:_SHOWN]}…"


def _plain(value: Any) -> Any:
    """Return a value with its numbers rounded: the last bits differ between machines, and may be part of a prompt."""
    if isinstance(value, float):
        return int(value) if value.is_integer() else round(value, _DIGITS)
    return [_plain(one) for one in value] if isinstance(value, list) else value


# ---------------------------------------------------------------------- the proof


def report(base: Base, run: Run, after: ResolvedPlan, checks: Checks, known: Known, *, summary: str) -> Json:
    """Return the report `articad.edit/1` of a run whose parts are recorded.

    Args:
        base: The base of the edit.
        run: The edit's run.
        after: Its plan with numbers.
        checks: Findings about its assembly.
        known: The verdicts that were carried over.
        summary: What was changed, in a sentence.
    """
    touched = reach(base.resolved, after)
    told = changes(base.plan, after.plan)
    findings = [_edited(change) for change in told]
    parts: Json = {}
    for name in dict.fromkeys((*base.stored["files"], *after.parts)):
        before: Mapping[str, str] = base.stored["files"].get(name, {})
        now = run.part_files(name) if name in after.parts else {}
        different = {
            file: [before.get(file), now.get(file)] for file in dict.fromkeys((*before, *now)) if before.get(file) != now.get(file)
        }
        fate = _fate(base, run, name, touched, different)
        parts[name] = {
            "fate": fate,
            "why": touched.get(name, ""),
            "equal": len(set(before) & set(now)) - len(set(different) & set(before) & set(now)),
        }
        parts[name] |= {"files": len(now), "different": different}
        findings += _of_part(name, fate, parts[name], told_otherwise(base.resolved, after, name))
    carried = sum(pair in checks.pairs for pairs in (known.rest, *known.motion.values()) for pair in pairs.values())
    every = Findings(findings)
    return {
        "schema": SCHEMA,
        "ok": every.ok,
        "findings": [finding.to_json() for finding in every],
        "summary": summary,
        "base": base.mark,
        "changes": told,
        "parts": parts,
        "pairs": {"carried": carried, "checked": len(checks.pairs) - carried},
    }


def _fate(base: Base, run: Run, name: str, touched: Mapping[str, str], different: Mapping[str, Any]) -> str:
    """Return what became of a part according to the plans, or according to its files if these show more."""
    why = touched.get(name)
    if why in {"new", "removed"}:
        return str(why)
    if why is None and different:
        old, now = base.stored["digests"].get(name, {}), (run.part(name) or {}).get("digests", {})
        scripted = base.stored["scripts"].get(name, "").encode() != (run.script(name) or b"")
        return "rewritten" if scripted else "rebuilt" if old != now else "unequal"
    if why is None:
        return "untouched"
    if not different:
        return "equal"
    return "rewritten" if "script.py" in different else "rebuilt"


def _edited(change: Json) -> Finding:
    what = f"{_quoted(change['before'])} → {_quoted(change['after'])}"
    return Finding(code="I_EDITED", where=str(change["where"]), message=f"{what}.", hint="")


def _of_part(name: str, fate: str, row: Json, told: str) -> Iterator[Finding]:
    if fate in {"untouched", "equal"}:
        return
    files = ", ".join(row["different"])
    if fate == "unequal":
        message = f"{name} is not touched by the edit, but {files} differ from those before."
        hint = "Replay the run that was edited: it was made on another machine, or its files were changed by hand."
        yield Finding(code="E_EDIT_UNEQUAL", where=f"parts.{name}", parts=(name,), message=message, hint=hint)
        return
    because = f": {told}" if told else f": it {row['why']}" if row["why"].startswith("follows") else ""
    yield Finding(code="I_PART_EDITED", where=f"parts.{name}", parts=(name,), message=f"{name} is {fate}{because}.", hint="")
