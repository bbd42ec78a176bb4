"""The tongue in the slot of a slider: widths between parallel planes, exact where a B-rep has planes."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from typing import Final, NamedTuple

import numpy as np

from articad.arrays import FloatArray
from articad.geometry.faces import Face
from articad.realisation.bores import TILT
from articad.realisation.sides import PartFace, Sides

__all__ = ["Between", "Slot", "slots_of"]

_Z: Final = np.array([0.0, 0.0, 1.0])
_ALIKE: Final = 0.3  # difference of widths, as a share of the larger
_PLANES: Final = 200  # of one side: beyond, as on a rack with many teeth, nothing is measured


class Between(NamedTuple):
    """What is between two parallel planes of a part along a joint's axis.

    Attributes:
        part: Its part.
        width: Distance of the planes [mm].
        middle: Distance of their middle from the axis, along `across` [mm].
        across: Their common normal, `(3,)`, in the joint's frame.
        off: How far the planes' vertices miss them [mm].
        box: Lower and upper bounds of the planes in both other directions, `(2, 2)` [mm].
    """

    part: str
    width: float
    middle: float
    across: FloatArray
    off: float
    box: FloatArray


class Slot(NamedTuple):
    """A slot of one part and the tongue of another that slides in it."""

    slot: Between
    tongue: Between

    @property
    def play(self) -> float:
        """Half the difference of the widths [mm]; negative if the tongue is too thick."""
        return (self.slot.width - self.tongue.width) / 2

    @property
    def shift(self) -> float:
        """How far the middles are apart [mm]."""
        return abs(self.slot.middle - self.tongue.middle)


def slots_of(both: Sides) -> Iterator[Slot]:
    """Yield, for each two parts and each direction across a joint's axis, the slot and tongue whose widths differ least.

    Both have planes along the axis, nearly the same width, and a common extent.
    """
    if max(len(both.parent), len(both.child)) > _PLANES:
        return
    best: dict[tuple[str, str, tuple[float, ...]], Slot] = {}
    for outer, inner in ((both.parent, both.child), (both.child, both.parent)):
        slots, tongues = list(_between(outer, hollow=True)), list(_between(inner, hollow=False))
        for slot, tongue in itertools.product(slots, tongues):
            if not _takes(slot, tongue):
                continue
            key = (slot.part, tongue.part, tuple(np.round(slot.across, 3) + 0.0))
            if key not in best or abs(Slot(slot, tongue).play) < abs(best[key].play):
                best[key] = Slot(slot, tongue)
    yield from best.values()


def _takes(slot: Between, tongue: Between) -> bool:
    if np.linalg.norm(np.cross(slot.across, tongue.across)) > TILT:
        return False
    is_alike = abs(slot.width - tongue.width) <= _ALIKE * max(slot.width, tongue.width)
    is_within = abs(slot.middle - tongue.middle) < (slot.width + tongue.width) / 4
    return bool(is_alike and is_within and _overlap(slot.box, tongue.box))


def _between(faces: Sequence[PartFace], *, hollow: bool) -> Iterator[Between]:
    """Yield the pairs of planes of one part between which there is material, or none."""
    planes = [one for one in faces if one.face.kind == "plane" and abs(one.face.axis @ _Z) < TILT]
    for one, other in itertools.combinations(planes, 2):
        if one.part != other.part or one.face.axis @ other.face.axis > TILT - 1.0:
            continue
        across = _upright(one.face.axis)
        heights = sorted((float(each.face.point @ across), float(each.face.axis @ across)) for each in (one, other))
        (low, outwards), (high, _) = heights
        boxes = [_box(each.face, across) for each in (one, other)]
        if high - low > 0.0 and (outwards > 0.0) == hollow and _overlap(*boxes):
            common = np.array([np.maximum(boxes[0][0], boxes[1][0]), np.minimum(boxes[0][1], boxes[1][1])])
            yield Between(one.part, high - low, (low + high) / 2, across, max(one.face.off, other.face.off), common)


def _upright(axis: FloatArray) -> FloatArray:
    """Return an axis or its opposite, whichever has its first notable component positive."""
    first = next((value for value in axis if abs(value) > TILT), 1.0)
    return axis if first > 0.0 else -axis


def _box(face: Face, across: FloatArray) -> FloatArray:
    points = face.corners.reshape(-1, 3) @ np.stack([_Z, np.cross(_Z, across)], axis=1)
    return np.array([points.min(axis=0), points.max(axis=0)])


def _overlap(one: FloatArray, other: FloatArray) -> bool:
    return bool((np.minimum(one[1], other[1]) > np.maximum(one[0], other[0])).all())
