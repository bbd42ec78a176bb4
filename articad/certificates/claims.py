"""Claims of a motion certificate: statements that two parts never meet, which anybody can check.

A claim says: while the joints of `vary` move within their ranges, followers follow their drivers, and all other joints stay at rest, the
first part's surface, its vertices moved inwards by `shrink`, stays farther than `clear` from the second part. How this was found is its
`Course`: the data with which a checker repeats it, computing everything else from the meshes and the joints.
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
        moved: Displacements of vertices of the first part, `(V, 3)` float32 [mm], None if there are none.
        orders: Orders of the triangles of both parts, in the trees that were cut.
        sizes: Number of triangles in each of the trees, of both parts.
        about: A point and the unit axis for radii, in the first part's frame, `(2, 3)` [mm]; the axis is 0 for a ball; NaN for none.
        cuts: The coordinate across which each box was cut, −1 for none; each box after the one that it was cut from.
        places: The value at which each was cut [rad or mm].
        rows: The result for each two pieces in a box.
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
        via: Joints from the first to the second.
        vary: Range of each coordinate that moves [rad or mm]; the followers of a driver move, too.
        start: Values of `vary` at which the overlap was measured; the motion is proven from there.
        overlap: Common volume of the two solids at the start [mm³].
        shrink: Distance by which the first part's vertices were moved inwards: the depth up to which contact is allowed [mm].
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
        """Return the JSON object of a certificate; numbers are unrounded, because a checker computes with them."""
        return {
            "parts": list(self.parts),
            "via": list(self.via),
            "vary": {name: list(bounds) for name, bounds in self.vary.items()},
            "start": dict(self.start),
            "overlap_mm3": self.overlap,
            "shrink_mm": self.shrink,
            "clear_mm": self.clear,
        }
