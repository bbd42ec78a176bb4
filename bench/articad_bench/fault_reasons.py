"""Why the checks find nothing of some planted faults, as a person found out."""

from __future__ import annotations

from typing import Final

__all__ = ["REASONS"]

REASONS: Final = {
    "rod_tie_two_balls:unit_inch": "The socket reaches 0.16 mm past the middle of the ball instead of 4, so that only weight keeps the ball in: that is no finding.",
    "corkscrew_wing:travel_long": "The wings' range still ends the spindle's stroke at 40 mm; its own limit is never reached.",
    "slide_dovetail_60:travel_long": "The saddle keeps 36 % of its guide at 90 mm, more than the quarter that is needed. Only the request says 30 mm.",
    "turnbuckle_open_m12:ratio_sign": "Threads are not modelled, so that no surface shows in which sense the second eye turns.",
    "screw_jack_bottle:bore_small": "The tommy bar is no part of the product: its hole is empty, and a dimension that shapes it with a factor has an effect.",
    "turnbuckle_open_m12:bore_off": "Nothing is in the frame's window, and no dimension states where it lies.",
    "four_bar:feature_missing": "The knob loses the spigot in its hole, but still touches the crank: what holds the faces of a fixed joint is not assessed.",
}
"""By case: product and kind."""
