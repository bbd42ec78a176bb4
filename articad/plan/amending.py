"""Amendments: change a plan at the addresses that findings name, so that an agent need not write all of it again."""

from __future__ import annotations

import copy
import re
from collections.abc import Mapping
from typing import Any, Final, NoReturn

from articad.aliases import Json
from articad.errors import ReadError, did_you_mean

_INDEX: Final = re.compile(r"\[(\d+)\]")
_DIGITS: Final = 9  # of the number of an entry: no list is longer, and Python reads no number of thousands of digits
_OPTIONAL: Final = ("rest_pose", "fit", "dimensions")  # objects that a plan may leave out


def amended(plan: Json, changes: Mapping[str, Any]) -> Json:
    """Return a plan with some of its values replaced.

    Args:
        plan: As in `plan.json`; it is not modified.
        changes: New values by address: `{"joints.lid.angle_deg": [0, 90]}`. Entries of lists are addressed by their names, or
            by number where they have none, as `o.2` or `o[2]`. A value of None removes; a name that a list does not have adds an entry. An
            optional object that is left out, such as `rest_pose`, is begun. A number for a parameter becomes its value.

    Raises:
        ReadError: If there is nothing at an address, or an object that a number or a text cannot replace.
    """
    plan = copy.deepcopy(plan)
    for address, value in changes.items():
        steps = _INDEX.sub(r".\1", address).split(".")
        holder: Any = plan
        for depth, step in enumerate(steps[:-1]):
            holder = _entered(holder, step, ".".join(steps[: depth + 1]))
        _put(holder, steps[-1], value, address)
    return plan


def _entered(holder: Any, step: str, address: str) -> Any:
    if isinstance(holder, list):
        return holder[_index(holder, step, address)]
    if isinstance(holder, dict) and (step in holder or step in _OPTIONAL):
        return holder.setdefault(step, {})
    raise _lost(address, step, list(holder) if isinstance(holder, dict) else [])


def _put(holder: Any, step: str, value: Any, address: str) -> None:
    if isinstance(holder, dict):
        if value is None:
            holder.pop(step, None)
        else:
            held = holder.get(step)
            if isinstance(held, dict) and "value" in held and not isinstance(value, dict):  # a parameter of the short form
                value = held | {"value": value}
            holder[step] = value
    elif isinstance(holder, list) and isinstance(value, dict) and step not in _names(holder) and not step.isdigit():
        holder.append({"name": step} | value)
    elif isinstance(holder, list):
        index = _index(holder, step, address)
        held = holder[index]
        if isinstance(value, dict) and step in _names(holder):
            value = {"name": step} | value
        elif isinstance(held, dict) and value is not None and not isinstance(value, dict):
            value = held | {"value": value} if "value" in held else _not_a_value(held, value, address)
        holder[index : index + 1] = [] if value is None else [value]
    else:
        raise _lost(address, step, [])


def _not_a_value(held: Json, value: Any, address: str) -> NoReturn:
    fields = ", ".join(f"{address}.{name}" for name in held if name != "name")
    raise ReadError.at(address, f"{address} is an object; it cannot be {value!r}.", f"Change one of its fields: {fields}.")


def _index(holder: list[Any], step: str, address: str) -> int:
    names = _names(holder)
    if step in names:
        return names.index(step)
    if step.isdecimal() and len(step) <= _DIGITS and int(step) < len(holder):
        return int(step)
    raise _lost(address, step, [name for name in names if name])


def _names(holder: list[Any]) -> list[str]:
    return [str(entry.get("name", "")) if isinstance(entry, dict) else "" for entry in holder]


def _lost(address: str, step: str, known: list[str]) -> ReadError:
    message = f"The plan has nothing at {address}."
    hint = did_you_mean(step, known).strip() or (f"There are {', '.join(known[:20])}." if known else "A number or a text has no fields.")
    return ReadError.at(address, message, hint)
