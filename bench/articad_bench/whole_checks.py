"""Checks of the whole that no picture is needed for: how large it is, and which hand its threads have."""

from __future__ import annotations

from typing import Final, Literal

import numpy as np

from articad.kinematics.joints import JointType
from articad_bench.check import Bounds, Check, in_words, within
from articad_bench.subject import Subject

_SIDES: Final = {"x": 0, "y": 1, "z": 2}


class Extent(Check):
    """A side of the box at rest, or its longest one, lies within bounds [mm]: for sizes that a text gives as from and to."""

    kind: Literal["extent"] = "extent"
    side: Literal["x", "y", "z", "longest"]
    mm: Bounds

    @property
    def wanted(self) -> str:
        name = "the longest side" if self.side == "longest" else f"the side along {self.side}"
        return f"{name} of its box is {in_words(self.mm)} mm"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        size = subject.size
        side = float(np.max(size)) if self.side == "longest" else float(size[_SIDES[self.side]])
        return within(side, self.mm), f"{side:.4g} mm"


class Threads(Check):
    """The number of left-handed threads; all others are right-handed, as threads are where nothing is said."""

    kind: Literal["threads"] = "threads"
    left: int = 0

    @property
    def wanted(self) -> str:
        return f"{self.left or 'no'} left-handed threads"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        leads = [joint.lead for joint in subject.assembly.joints if joint.type is JointType.SCREW]
        left = sum(lead < 0 for lead in leads)
        return bool(leads) and left == self.left, f"{left} of {len(leads)}"
