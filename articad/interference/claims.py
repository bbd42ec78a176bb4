"""Claims of a motion certificate: statements of which anybody can convince himself that two parts never meet.

A claim says: while the joints of `vary` move within their ranges and those of `hold` stand still, the first part's surface, its
vertices moved inwards by `shrink`, stays further than `clear` from the second part. It says neither how that was found nor with
which numbers: a checker finds its own proof from the meshes and the joints.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Claim:
    """One proven statement.

    Attributes:
        parts: The part whose surface may be shrunk, and the other.
        via: Joints from the one to the other.
        vary: Range of each coordinate that moves [rad or mm]; of a driver, whatever follows it moves, too.
        hold: Values of the other coordinates between the two parts.
        start: Values of `vary` at which the overlap was measured; the motion is proven from there.
        overlap: Of the two solids at the start [mm³].
        shrink: By how much the first part's vertices were moved inwards: the depth up to which contact is allowed [mm].
        within: Only vertices within this radius about the joint were moved; None: all of them [mm].
        clear: The distance is larger than this throughout [mm]: the deflection of both meshes.
    """

    parts: tuple[str, str]
    via: tuple[str, ...]
    vary: Mapping[str, tuple[float, float]]
    hold: Mapping[str, float]
    start: Mapping[str, float]
    overlap: float
    shrink: float = 0.0
    within: float | None = None
    clear: float = 0.0

    def to_json(self) -> dict[str, Any]:
        """Return the JSON object of a certificate; numbers in full, for a checker computes with them."""
        return {
            "parts": list(self.parts),
            "via": list(self.via),
            "vary": {name: list(bounds) for name, bounds in self.vary.items()},
            "hold": dict(self.hold),
            "start": dict(self.start),
            "overlap_mm3": self.overlap,
            "shrink_mm": self.shrink,
            "within_mm": self.within,
            "clear_mm": self.clear,
        }
