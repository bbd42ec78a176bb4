"""Numbers in prompts: rounded, so that a request's key does not depend on the last bits of a machine."""

from __future__ import annotations

from collections.abc import Iterable


def short(number: float) -> str:
    """Return a measured number with 3 significant digits, usually without an exponent."""
    return f"{float(f'{number:.3g}') + 0.0:.10g}"


def listed_numbers(values: Iterable[float]) -> str:
    """Return `(1, 2.5, 3)`; values below 1e-6 are 0."""
    return f"({', '.join(short(0.0 if abs(value) < 1e-6 else value) for value in values)})"


def placed(values: Iterable[float]) -> str:
    """Return positions in mm `(-579.5, 0, 1837.5)` with one decimal: three digits would move a door into its frame."""
    return f"({', '.join(f'{round(value, 1) + 0.0:g}' for value in values)})"
