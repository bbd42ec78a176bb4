"""Excerpts: what of a plan, of its rules and of the analysis a designer is told who mends findings by changes.

Every number, frame, limit and material of the plan is told. Left out are the orders of parts that no finding is about, and the sections of the
rules that bear on none of the findings.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final

from articad.agents.prompts import prompt_section
from articad.aliases import Json
from articad.findings import Finding

ORDERS: Final = ("description", "orientation", "role")  # of a part, in words: what its author builds from
STATED: Final = ("relations", "motions", "constraints", "dimensions")  # of the analysis: what a change must still keep
_FORM: Final = ("# 1. Units", "# 3. Parts")  # first heading of a stretch of the rules, and the heading after it
_PARTS: Final = ("# 3. Parts", "# 4. Connectors")
_JOINTS: Final = ("# 4. Connectors", "# 6. Room")
_ROOM: Final = ("# 6. Room", "# 7. Example")
_WRITING: Final = frozenset({"E_NAME", "E_DUP_NAME", "E_EXPRESSION", "E_EXPRESSION_CYCLE", "E_NONFINITE"})
"""What is found of how a name or a number is written: no other rule bears on it, wherever it stands."""
_FORMS: Final = {"joints": ("joint:", "|", "derived joint", "fit:"), "couplings": ("coupling:",), "allow": ("allow ",)}
"""By field of a plan, the first words of the lines that state the forms of its entries; all others are told always."""


def rules(findings: Iterable[Finding]) -> str:
    """Return the rules that bear on findings: always how numbers and fields are written, and all of them on what was found of built parts."""
    told, fields = {_FORM}, set[str]()
    for finding in findings:
        field = re.split(r"\W", finding.where)[0]
        if finding.stage != "plan":
            told, fields = {_FORM, _PARTS, _JOINTS, _ROOM}, set(_FORMS)
            break
        if finding.code in _WRITING:
            fields |= {field} & set(_FORMS)
        elif field == "parts":
            told |= {_PARTS, _JOINTS} if "connectors" in finding.where or "rest_pose" in finding.where else {_PARTS}
        elif field not in {"parameters", "materials"}:
            told |= {_JOINTS}
            fields |= {field} if field in _FORMS else set(_FORMS)
    unused = tuple(start for field, starts in _FORMS.items() if field not in fields for start in starts)
    lines = [line for line in prompt_section("design.md", *_FORM).splitlines() if not line.startswith(unused)]
    others = [prompt_section("design.md", *stretch) for stretch in (_PARTS, _JOINTS, _ROOM) if stretch in told]
    return "\n\n".join(["\n".join(lines), *others])


def concerned(plan: Json, findings: Sequence[Finding]) -> set[str]:
    """Return the parts that findings are about: those that they name, and those of joints that they name; for built parts also what joins these.

    Args:
        plan: As in `plan.json`; it may break every rule of its form.
        findings: What was found.
    """
    joints = [(str(joint.get("name")), _joined(joint)) for joint in _entries(plan, "joints")]
    about, built = _words(findings), _words(finding for finding in findings if finding.stage != "plan")
    named = {str(part["name"]) for part in _entries(plan, "parts") if part.get("name") in about}
    named |= {part for joint, parts in joints if joint in about for part in parts}
    named |= {part for _, parts in joints if any(one in built for one in parts) for part in parts}
    return named | {str(part["derive"].get("from")) for part in _entries(plan, "parts") if part.get("name") in named and _is_copy(part)}


def excerpt(plan: Json, parts: Iterable[str]) -> tuple[Json, list[str]]:
    """Return a plan in which only some parts have their orders, and the names of the others."""
    if not isinstance(plan.get("parts"), list):
        return plan, []
    kept = set(parts)
    short = [part for part in _entries(plan, "parts") if part.get("name") not in kept and not _is_copy(part)]
    shown = [
        {field: value for field, value in part.items() if field not in ORDERS} if any(part is one for one in short) else part
        for part in plan["parts"]
    ]
    return plan | {"parts": shown}, [str(part.get("name")) for part in short]


def with_orders(changes: Mapping[str, Any], plan: Json, unseen: Iterable[str]) -> dict[str, Any]:
    """Return changes in which a part whose orders were not shown, and that is replaced whole, keeps those it does not state.

    Args:
        changes: New values by address.
        plan: The whole plan.
        unseen: Parts whose orders were left out of an excerpt.
    """
    entries = {str(part.get("name")): part for part in _entries(plan, "parts")}
    orders = {f"parts.{name}": {field: entries[name][field] for field in ORDERS if field in entries[name]} for name in unseen}
    return {
        address: orders[address] | value if address in orders and isinstance(value, dict) else value for address, value in changes.items()
    }


def compact(document: Json) -> str:
    """Return JSON without spaces."""
    return json.dumps(document, separators=(",", ":"), ensure_ascii=False)


def is_of_model(findings: Iterable[Finding]) -> bool:
    """Return whether one of the findings is a judgement about what was asked for, which only the whole analysis and plan answer."""
    return any(finding.stage == "model" for finding in findings)


def _words(findings: Iterable[Finding]) -> set[str]:
    return {word for finding in findings for word in (*finding.parts, *re.findall(r"\w+", str(finding)))}


def _entries(plan: Json, field: str) -> list[Json]:
    held = plan.get(field)
    return [entry for entry in held if isinstance(entry, dict) and isinstance(entry.get("name"), str)] if isinstance(held, list) else []


def _is_copy(part: Json) -> bool:
    return isinstance(part.get("derive"), dict)


def _joined(joint: Json) -> list[str]:
    return [str(joint.get(side, "")).split(".", maxsplit=1)[0] for side in ("parent", "child")]
