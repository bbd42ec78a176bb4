"""Claims of a motion certificate: statements of which anybody can convince himself that two parts never meet.

A claim says: while the joints of `vary` move within their ranges, what follows a driver follows, and all others stand at rest, the
first part's surface, its vertices moved inwards by `shrink`, stays further than `clear` from the second part. How that was found is
its `Course`: what a checker needs to see the same, and computes anew from the meshes and the joints.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from articad.certificates.trail import Written


@dataclass(frozen=True, eq=False)
class Course:
    """How a claim was found.

    Attributes:
        moved: By how much vertices of the first part were moved, `(V, 3)` float32 [mm], None for not at all.
        orders: Of the triangles of both parts, in the trees that were cut.
        sizes: How many triangles each of the trees holds, of both parts.
        about: A point and the unit axis about which radii are, as the first part sees them, `(2, 3)` [mm]; the axis of a ball is 0, NaN: none.
        cuts: Across which coordinate each box was cut, −1 for none; boxes in the order in which they came from others.
        places: Where each was cut [rad or mm].
        rows: What became of each two pieces in a box.
    """

    moved: NDArray[np.float32] | None
    orders: tuple[NDArray[np.signedinteger[Any]], NDArray[np.signedinteger[Any]]]
    sizes: tuple[tuple[int, ...], tuple[int, ...]]
    about: NDArray[np.float64]
    cuts: NDArray[np.int64]
    places: NDArray[np.float64]
    rows: Written


@dataclass(frozen=True)
class Claim:
    """One proven statement.

    Attributes:
        parts: The part whose surface may be shrunk, and the other.
        via: Joints from the one to the other.
        vary: Range of each coordinate that moves [rad or mm]; of a driver, whatever follows it moves, too.
        start: Values of `vary` at which the overlap was measured; the motion is proven from there.
        overlap: Of the two solids at the start [mm³].
        shrink: By how much the first part's vertices were moved inwards: the depth up to which contact is allowed [mm].
        within: Only vertices within this radius about the joint were moved; None: all of them [mm].
        clear: The distance is larger than this throughout [mm]: the deflection of both meshes.
        course: How it was found.
    """

    parts: tuple[str, str]
    via: tuple[str, ...]
    vary: Mapping[str, tuple[float, float]]
    start: Mapping[str, float]
    overlap: float
    shrink: float = 0.0
    clear: float = 0.0
    course: Course | None = None

    def to_json(self) -> dict[str, Any]:
        """Return the JSON object of a certificate; numbers in full, for a checker computes with them."""
        return {
            "parts": list(self.parts),
            "via": list(self.via),
            "vary": {name: list(bounds) for name, bounds in self.vary.items()},
            "start": dict(self.start),
            "overlap_mm3": self.overlap,
            "shrink_mm": self.shrink,
            "clear_mm": self.clear,
        }
