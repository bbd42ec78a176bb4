"""The forms of a run's records: what their readers rely on. Whoever made a run may have written anything into it.

A form is `object` for anything, a type, None, a set of texts, a pattern of a text, a tuple of alternatives, a list with the form of its elements and perhaps their
number, a dict with the forms of its keys, of which those with `?` may be missing, or a dict with the key `str`: any names, each with a value
of that form. Keys that no form names are allowed. A number is finite, and small enough for a float.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import Any, Final

__all__ = ["FINDING", "FORMS", "misfit", "misfit_of"]

Form = Any

_TEXT: Form = (str, None)
_NUMBER: Form = (float, None)
_NAMES: Form = [str]
_POSE: Form = ({str: float}, None)
FINDING: Final[Form] = {
    "code": re.compile(r"[EWI]_[A-Z0-9_]{1,60}"),
    "severity": frozenset({"error", "warning", "info"}),
    "message": str,
    "where": str,
    "hint": str,
    "cause?": _TEXT,
    "unit?": _TEXT,
    "value?": _NUMBER,
    "limit?": _NUMBER,
    "parts?": _NAMES,
    "pose?": _POSE,
}
_STRENGTH: Form = {
    "kind": frozenset({"certified", "sampled", "waived", "not_checked"}),
    "poses?": (int, None),
    "epsilon_mm?": _NUMBER,
    "reason?": _TEXT,
}
_PAIR: Form = {
    "parts": [str, 2],
    "relation": str,
    "over": (str, _NAMES),
    "strength": _STRENGTH,
    "volume_mm3": float,
    "depth_mm": float,
    "allowed_mm": float,
    "gap_mm": _NUMBER,
    "verdict": frozenset({"clear", "contact", "overlap", "unknown"}),
    "pose?": _POSE,
}
_FIT: Form = {"joint": str, "verdict": str, "least_mm?": _NUMBER, "play_mm?": _NUMBER}
_RANGE: Form = {"joint": str, "free": [float, 2], "declared": [float, 2]}
_CLEARANCE: Form = {"parts": [str, 2], "relation": str, "gap_mm": float, "pose": {str: float}, "strength": _STRENGTH}
_FOLLOWS: Form = {"driver": str, "units": {str: str}, "values": [float], "followers": {str: [float]}}
_JOINT: Form = {"freedoms": [{"name": str, "turn": [float]}]}
_REPORT: Form = {"ok": bool, "findings": [FINDING]}
_DRIVER: Form = {"name": str, "unit": str, "lower": _NUMBER, "upper": _NUMBER}
_PART: Form = {"material": _TEXT, "volume_mm3": _NUMBER, "mass_kg": _NUMBER, "derived_from": _TEXT}
_CHANGE: Form = {"where": str, "before": object, "after": object}

FORMS: Final[Mapping[str, Form]] = {
    "request": {
        "prompt": str,
        "images": [{"file": str, "part?": _TEXT}],
        "options": {
            "task?": _TEXT,
            "kernel?": _TEXT,
            "parameters?": ({str: float}, None),
            "set?": ({str: float}, None),
            "changes?": ({str: object}, None),
        },
        "articad?": str,
    },
    "assembly": {
        **_REPORT,
        "name": str,
        "freedoms": int,
        "mass_kg": float,
        "parts": {str: _PART},
        "joints": {str: {"type": str, "parent": str, "child": str}},
        "drivers": [_DRIVER],
    },
    "checks": {**_REPORT, "pairs": [_PAIR], "fits?": [_FIT]},
    "certificate": {
        **_REPORT,
        "schema": str,
        "covers": str,
        "epsilon_mm": float,
        "mechanism?": {"joints?": [_JOINT]},
        "pairs": [_PAIR],
        "ranges": [_RANGE],
        "clearances?": [_CLEARANCE],
        "follows?": [_FOLLOWS],
        "fits?": [_FIT],
    },
    "verdict": {**_REPORT, "schema": str, "by": str, "round": int, "rulings": {str: {"ok": bool, "reason": str}}},
    "edit": {**_REPORT, "changes": [_CHANGE], "parts": {str: {"fate": str, "why": str}}},
    "review": {"ok": bool, "findings": [FINDING], "model?": ({str: {"score": float}}, None), "lessons?": _NAMES},
    "losses": {**_REPORT, "files": {str: int}, "rows": [{"where": str, "kept": str, "lost": str}]},
    "reply": {
        "key": str,
        "step": str,
        "messages": [{"role": str, "content": (str, [{"type?": str, "text?": _TEXT}])}],
        "reply": {
            "text?": str,
            "model?": _TEXT,
            "usage?": ({"input_tokens?": (int, None), "output_tokens?": (int, None)}, None),
            "cost?": _NUMBER,
        },
    },
    "alternatives": {"chosen": int, "by": str, "alternatives?": [object]},
    "requirements": {"summary?": str},
    "part": {"shape?": {"mesh_sha256": str}, "digests?": {str: str}},
    "attempt": {"findings?": [FINDING]},
    "base": {
        "prompt": str,
        "kernel": str,
        "plan": str,
        "scripts": {str: str},
        "files": {str: {str: str}},
        "digests": {str: {str: str}},
        "meshes": {str: str},
        "checks": {"findings": [FINDING], "pairs": [_PAIR], "fits?": [_FIT]},
        "requirements": ({}, None),
        "task?": _TEXT,
    },
}
"""Form by the name of a record."""


def misfit_of(record: Mapping[str, Any], kind: str) -> str:
    """Return where a record does not have the form of its kind; empty if it has it."""
    wrong = misfit(record, FORMS[kind])
    if wrong or kind != "certificate":
        return wrong
    tables = enumerate(record.get("follows", ()))
    return next((f"follows[{number}]" for number, table in tables if not _is_whole(table)), "")


def _is_whole(table: Mapping[str, Any]) -> bool:
    """Whether a table has a unit for each of its columns, and as many values in each."""
    followers: Mapping[str, list[float]] = table["followers"]
    return {table["driver"], *followers} <= set(table["units"]) and all(len(each) == len(table["values"]) for each in followers.values())


def misfit(value: Any, form: Form, at: str = "") -> str:
    """Return where a JSON value does not have a form, such as `pairs[3].over`; empty if it has it.

    Args:
        value: The value.
        form: The form.
        at: What leads to the value.
    """
    if isinstance(form, tuple):
        places = [misfit(value, each, at) for each in form]
        return "" if "" in places else max(places, key=len)
    if isinstance(form, list):
        return _misfit_of_list(value, form, at)
    if isinstance(form, dict):
        return _misfit_of_object(value, form, at)
    return "" if _fits(value, form) else at or "."


def _misfit_of_list(value: Any, form: list[Form], at: str) -> str:
    if not isinstance(value, list) or form[1:] not in ([], [len(value)]):
        return at or "."
    return next((place for number, each in enumerate(value) if (place := misfit(each, form[0], f"{at}[{number}]"))), "")


def _misfit_of_object(value: Any, form: Mapping[Any, Form], at: str) -> str:
    if not isinstance(value, dict):
        return at or "."
    before = f"{at}." if at else ""
    if str in form:
        return next((place for name, each in value.items() if (place := misfit(each, form[str], f"{before}{name}"))), "")
    missing = [key for key in form if not key.endswith("?") and key not in value]
    if missing:
        return f"{before}{missing[0]}"
    keys = ((key.removesuffix("?"), each) for key, each in form.items())
    return next((place for key, each in keys if key in value and (place := misfit(value[key], each, f"{before}{key}"))), "")


def _fits(value: Any, form: Form) -> bool:
    """Whether a value that is neither a list nor an object in its form is what the form says."""
    if form is object or form is None:
        return form is object or value is None
    if isinstance(form, frozenset):
        return isinstance(value, str) and value in form
    if isinstance(form, re.Pattern):
        return isinstance(value, str) and form.fullmatch(value) is not None
    if form is float:
        return isinstance(value, int | float) and not isinstance(value, bool) and _is_finite(value)
    if form is int:
        return isinstance(value, int) and not isinstance(value, bool) and _is_finite(value)
    return isinstance(value, form)


def _is_finite(value: float) -> bool:
    try:
        return math.isfinite(value)
    except OverflowError:  # a whole number beyond all floats
        return False
