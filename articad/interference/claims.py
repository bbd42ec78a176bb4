"""Claims of a motion certificate: numbers from which anybody can check that two parts never meet.

A claim says: while the joints of `vary` move within their ranges and those of `hold` stand still, a piece of the first part's
surface does not meet the second part. Claims of one pair and range belong together when the surface was cut into pieces.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

from articad.interference.cover import CoverBox

Piece = Literal["whole", "in", "seam", "out"]
Separation = Literal["along", "radial"]


@dataclass(frozen=True)
class Claim:
    """One proven statement.

    Attributes:
        parts: The part whose surface is looked at, and the other.
        vary: Range of each coordinate that moves [rad or mm].
        hold: Values of the other coordinates between the two parts.
        start: Values of `vary` at which the overlap was measured; the motion is proven from there.
        overlap: Of the two solids at the start [mm³].
        reach: Speed of the fastest point per unit of each coordinate [mm/rad or 1].
        tube: Deviation of dependent joints that is not in `reach` [mm].
        shrink: By how much the first part's vertices were moved inwards: the depth up to which contact is allowed [mm].
        piece: The whole surface, or the part within `radius` of the joint's axis, the seam, or what reaches outside.
        radius: Of the cylinder or sphere at which the surface was cut [mm]; 0 for the whole.
        edge: Longest edge of a triangle that crosses it [mm].
        clear: Distance that is required beyond everything else: at a seam, the shrinking of its neighbour [mm].
        separation: "along" when the two keep apart along the common axis, "radial" when by their radii; then there are no boxes.
        gap: Of such a separation [mm].
        boxes: They cover `vary`, else.
        spans: Along a driver of loops: its values in each box, whose centre and half sides are those of the joints in `reach`.
    """

    parts: tuple[str, str]
    vary: Mapping[str, tuple[float, float]]
    hold: Mapping[str, float]
    start: Mapping[str, float]
    overlap: float
    reach: Mapping[str, float]
    tube: float = 0.0
    shrink: float = 0.0
    piece: Piece = "whole"
    radius: float = 0.0
    edge: float = 0.0
    clear: float = 0.0
    separation: Separation | None = None
    gap: float = 0.0
    boxes: tuple[CoverBox, ...] = ()
    spans: tuple[tuple[float, float], ...] = ()

    def to_json(self) -> dict[str, Any]:
        """Return the JSON object of a certificate; numbers in full, for a checker computes with them."""
        document = {
            "parts": list(self.parts),
            "vary": {name: list(bounds) for name, bounds in self.vary.items()},
            "hold": dict(self.hold),
            "start": dict(self.start),
            "overlap_mm3": self.overlap,
            "reach": dict(self.reach),
            "tube_mm": self.tube,
            "shrink_mm": self.shrink,
            "piece": self.piece,
            "radius_mm": self.radius,
            "edge_mm": self.edge,
            "clear_mm": self.clear,
            "separation": self.separation,
            "gap_mm": self.gap,
            "boxes": [[*box.centre, *box.half, box.distance] for box in self.boxes],
        }
        if self.spans:
            document["spans"] = [list(span) for span in self.spans]
        return document
