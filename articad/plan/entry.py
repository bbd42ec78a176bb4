"""A part's entry in the plan as its author reads it: what is asked of a model, and what a store of experience compares."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from articad.connectors.connector import Connector
from articad.plan.brief import brief
from articad.plan.resolve import ResolvedPlan

__all__ = ["order", "specification"]

_DIGITS: Final = 6  # decimals of mm in a prompt: the last bits of a cosine differ between machines


def order(resolved: ResolvedPlan, name: str) -> str:
    """Return what a part's solid must look like, without its material and connectors: what its pictures can be held against."""
    target, told = resolved.parts[name], brief(resolved, name)
    lines = [f"{field}: {text}" for field, text in (("role", target.role), ("orientation", target.orientation)) if text]
    lines.append(f"description: {target.description}")
    if told["dimensions"]:
        lines.append(f"dimensions: {', '.join(f'{dimension} = {_number(value)}' for dimension, value in told['dimensions'].items())}")
    return "\n".join(lines)


def specification(resolved: ResolvedPlan, name: str) -> str:
    """Return a part's entry in the plan as its author reads it, with numbers; other parts are not named."""
    target, told = resolved.parts[name], brief(resolved, name)
    lines = [f"name: {name}", f"material: {target.material.name}"]
    lines += [f"{field}: {text}" for field, text in (("role", target.role), ("orientation", target.orientation)) if text]
    lines += ["", "description:", target.description, "", "dimensions:" if told["dimensions"] else "dimensions: none"]
    lines += [f"- {dimension} = {_number(value)}" for dimension, value in told["dimensions"].items()]
    envelope = told["envelope_mm"]
    lines += ["", f"envelope_mm: {'not given' if envelope is None else ' x '.join(map(_number, envelope))}", "", "connectors:"]
    for connector, frame in told["connectors"].items():
        lines.append(_connector_line(target.connectors[connector], frame))
    return "\n".join(lines)


def _connector_line(connector: Connector, frame: Mapping[str, Any]) -> str:
    axes = [f"{axis} = {_vector(frame[axis])}" for axis in ("o", "z", "x") if axis != "x" or not connector.roll_free]
    line = f"- {connector.name} ({connector.kind}): {', '.join(axes)}{'; x is free' if connector.roll_free else ''}; {connector.label}"
    for joint in frame["joints"]:
        limits = ", ".join(
            f"{field} {bounds if isinstance(bounds, str) else _vector(bounds)}" for field, bounds in joint["limits"].items() if bounds
        )
        fit = f", fit {joint['fit']}" if joint["fit"] else ""
        side = "the part moves" if joint["side"] == "child" else "the other part moves"
        line += f"\n  {joint['type']} joint{f', {side}' if limits else ''}{f': {limits}' if limits else ''}{fit}"
    return line


def _vector(values: Any) -> str:
    return f"({', '.join(map(_number, values))})" if isinstance(values, (list, tuple)) else _number(values)


def _number(value: float) -> str:
    rounded = round(value, _DIGITS)
    return str(int(rounded)) if rounded == int(rounded) else repr(rounded)
