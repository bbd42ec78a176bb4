"""Names of fits: ISO 286 (`H7/g6`) and classes for parts printed by fused filament (`loose`, `sliding`, `press`).

A name stands for a range of play, half the difference of the diameters of bore and pin. Geometry holds no interference: where the shaft
may be larger than the bore, both are modelled with the nominal diameter, so the least play is 0.
"""

from __future__ import annotations

from typing import Final, NamedTuple

from articad.errors import PlanError, did_you_mean
from articad.plan.iso286 import fit_limits, parsed_fit

__all__ = ["PRINTED_MM", "NamedGap", "named_gap", "nominal_in"]

PRINTED_MM: Final = {"loose": (0.2, 0.4), "sliding": (0.1, 0.2), "press": (0.0, 0.05)}
"""Play of parts printed by fused filament [mm], least and largest, whatever their diameter."""

_FORMS: Final = "an ISO 286 fit such as 'H7/g6', or 'loose', 'sliding' or 'press' for printed parts"


class NamedGap(NamedTuple):
    """The play that a name stands for.

    Attributes:
        least: [mm].
        largest: [mm].
        holds: Whether the parts cannot move: the shaft is larger than the bore, or the name is "press".
    """

    least: float
    largest: float
    holds: bool


def nominal_in(name: str) -> float | None:
    """Return the nominal diameter that a name states, as in "25 H7/g6" [mm]; None if it states none.

    Raises:
        PlanError: If it is not the name of a fit.
    """
    if name in PRINTED_MM:
        return None
    fit = parsed_fit(name)
    if fit is None:
        raise PlanError(f"{name!r} is not the name of a fit.{did_you_mean(name, PRINTED_MM)} Give {_FORMS}.")
    return fit.nominal


def named_gap(name: str, nominal: float | None) -> NamedGap:
    """Return the play that a name stands for.

    Args:
        name: Such as "H7/g6" or "sliding".
        nominal: Nominal diameter [mm]; not used by the printing classes.

    Raises:
        PlanError: If there is no such fit, or no diameter for an ISO 286 fit.
    """
    if name in PRINTED_MM:
        return NamedGap(*PRINTED_MM[name], name == "press")
    if nominal is None:
        raise PlanError(f"The fit {name!r} needs a nominal diameter, as in '25 H7/g6'.")
    least, largest = fit_limits(name, nominal)
    return NamedGap(max(least, 0.0) / 2, max(largest, 0.0) / 2, largest <= 0.0)
