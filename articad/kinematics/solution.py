"""Solution: which rows of a batch of drivers' values are reached, and why the others are not."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from articad.arrays import FloatArray
from articad.connectors import SE3
from articad.findings import Findings


@dataclass(frozen=True, eq=False)
class Solution:
    """Poses for a batch of drivers' values, where they are reached.

    Attributes:
        q: Requested values `(*batch, nq)` [rad, mm].
        reached: Which are reached `(*batch,)`.
        columns: Coordinates of all joints `(*batch, n_columns)`; NaN where not reached.
        poses: `T_ground_part` of all parts `(*batch, N, 7)` [mm, quaternion xyzw]; NaN where not reached.
        findings: E_DEAD_POINT, E_SINGULAR or E_NOT_FOLLOWED, naming the rows that are not reached; empty if all are.
    """

    q: FloatArray
    reached: npt.NDArray[np.bool_]
    columns: FloatArray
    poses: SE3
    findings: Findings

    @property
    def ok(self) -> bool:
        """True when every row is reached."""
        return bool(self.reached.all())
