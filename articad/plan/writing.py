"""Writing: the canonical text of a form, so that equal plans have equal bytes."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from articad.plan.fields import PlanObject
from articad.processes import scratch

_LINE = 140  # a value that fits in a line is written on one line
_WHOLE = 2.0**53  # above this, a float cannot represent every whole number


def to_json(form: PlanObject) -> dict[str, Any]:
    """Return the JSON object of a form: defaults left out, whole numbers as integers."""
    plain: dict[str, Any] = _plain(form.model_dump(mode="python", by_alias=True, exclude_defaults=True))
    return plain


def dumps(form: PlanObject) -> str:
    """Return the canonical text of a form, ending in a newline."""
    return _laid_out(to_json(form), 0, 0) + "\n"


def save(form: PlanObject, path: Path, default_name: str) -> Path:
    """Write the canonical text to a file, or to the default name in an existing folder; a reader never sees half of it."""
    file = path / default_name if path.is_dir() else path
    scratch.write(file, dumps(form).encode())
    return file


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    if isinstance(value, float) and value.is_integer() and abs(value) < _WHOLE:
        return int(value)
    return value


def _laid_out(value: Any, indent: int, column: int) -> str:
    """Return JSON text in which only values that are too long for a line are broken, one item per line."""
    flat = json.dumps(value, ensure_ascii=False, allow_nan=False)
    if not isinstance(value, (dict, list)) or not value or (indent > 0 and column + len(flat) <= _LINE):
        return flat
    pad = " " * (indent + 1)
    if isinstance(value, dict):
        keys = [json.dumps(key, ensure_ascii=False) for key in value]
        items = [
            f"{pad}{key}: {_laid_out(item, indent + 1, indent + len(key) + 4)}" for key, item in zip(keys, value.values(), strict=True)
        ]
        return "{\n" + ",\n".join(items) + "\n" + " " * indent + "}"
    items = [pad + _laid_out(item, indent + 1, indent + 2) for item in value]
    return "[\n" + ",\n".join(items) + "\n" + " " * indent + "]"
