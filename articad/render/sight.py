"""Sight: whether a series of pictures shows a motion, judged by pixels, and what is done until it does.

A view is taken in which the moving parts are seen. If there is none, what hides them is drawn as if it were of glass. If even then nothing
changes, because a round part turns about its own axis, its joint gets a hand that turns with it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from articad.arrays import FloatArray
from articad.render.camera import Camera
from articad.render.raycast import BACKGROUND, cast
from articad.render.scene import DrawnScene

PROBE_SIZE: Final = 160  # pixels of the pictures that are judged
LEAST_SHARE: Final = 0.25  # of the area that the moving parts would have if nothing hid them, in each picture
LEAST_PIXELS: Final = 12  # of the moving parts, in each picture
LEAST_CHANGE: Final = 8  # pixels that differ between two successive pictures
_SAME_NORMAL: Final = 0.98  # cosine: a surface that is bent more has changed its shade
_LONGEST_HAND: Final = 0.2  # of the picture's box
_BEYOND: Final = 1.25  # length of a hand, relative to the reach of what turns


@dataclass
class Sight:
    """What a series of pictures shows of the moving parts.

    Attributes:
        seen: Pixels of the moving parts, for each picture.
        alone: Pixels they would have if nothing hid them, for each picture.
        changed: Pixels of moving parts that differ from the picture before, for each picture but the first.
        hiding: Pixels of the moving parts that each part covers, summed over the pictures, by name.
    """

    seen: list[int] = field(default_factory=list)
    alone: list[int] = field(default_factory=list)
    changed: list[int] = field(default_factory=list)
    hiding: dict[str, int] = field(default_factory=dict)

    @property
    def is_seen(self) -> bool:
        """Whether every picture shows enough of the moving parts."""
        return all(seen >= max(LEAST_PIXELS, LEAST_SHARE * alone) for seen, alone in zip(self.seen, self.alone, strict=True))

    @property
    def shows(self) -> bool:
        """Whether every picture shows the moving parts, and another side or place of them than the picture before."""
        return self.is_seen and all(changed >= LEAST_CHANGE for changed in self.changed)


def sights(scenes: Sequence[DrawnScene], views: Sequence[str], bounds: FloatArray) -> dict[str, Sight]:
    """Return by view what pictures show of the items whose manner is "solid".

    Args:
        scenes: The same items in different places.
        views: Keys of `articad.render.VIEWS`.
        bounds: The box that the pictures show [mm], `(2, 3)`.
    """
    found = {view: Sight() for view in views}
    before: dict[str, _Shown] = {}
    for scene in scenes:  # all views of a scene together: its tree is built once
        solid = np.array([item.manner == "solid" for item in scene.items] + [False])  # the last stands for the background
        alone = replace(scene, items=tuple(item for item in scene.items if item.manner == "solid"))
        for view, one in found.items():
            camera = Camera.fit(view, bounds, width=PROBE_SIZE, height=PROBE_SIZE)
            shown, free = cast(scene, camera), cast(alone, camera).item != BACKGROUND
            now = _Shown(solid[shown.item], shown.item, shown.normal)
            for index, count in zip(*np.unique(shown.item[free & ~now.own], return_counts=True), strict=True):
                name = scene.items[index].name
                one.hiding[name] = one.hiding.get(name, 0) + int(count)
            one.seen.append(int(now.own.sum()))
            one.alone.append(int(free.sum()))
            if view in before:
                one.changed.append(now.differing(before[view]))
            before[view] = now
    return found


def cleared(scenes: Sequence[DrawnScene], view: str, bounds: FloatArray) -> tuple[str, ...]:
    """Return the parts that must be of glass for the moving parts to be seen from a view: those first that hide most."""
    names: list[str] = []
    while not (found := sights(of_glass(scenes, names), [view], bounds)[view]).is_seen and found.hiding:
        names.append(max(found.hiding, key=lambda name: found.hiding[name]))
    return tuple(names)


def of_glass(scenes: Sequence[DrawnScene], names: Sequence[str]) -> list[DrawnScene]:
    """Return scenes with the named parts of glass: they hide nothing."""
    return [
        replace(scene, items=tuple(replace(item, manner="glass") if item.name in names else item for item in scene.items))
        for scene in scenes
    ]


def with_hands(scenes: Sequence[DrawnScene], bounds: FloatArray) -> list[DrawnScene]:
    """Return scenes in which each turning axis has a hand, as long as the moving parts reach out from it."""
    most = _LONGEST_HAND * float(np.ptp(bounds, axis=0).max())

    def reach(scene: DrawnScene, point: FloatArray, direction: FloatArray) -> float:
        away = [np.cross(item.vertices - point, direction) for item in scene.items if item.manner == "solid" and len(item.vertices)]
        return min(_BEYOND * max((float(np.linalg.norm(one, axis=1).max()) for one in away), default=most), most)

    return [
        replace(
            scene,
            axes=tuple(replace(axis, hand=reach(scene, np.array(axis.point), np.array(axis.direction))) for axis in scene.axes),
        )
        for scene in scenes
    ]


@dataclass(frozen=True, eq=False)
class _Shown:
    own: NDArray[np.bool_]
    item: NDArray[np.int32]
    normal: NDArray[np.float32]

    def differing(self, before: _Shown) -> int:
        """Return how many pixels show another item, or another side of it, where either picture shows a moving part."""
        same = (self.item == before.item) & ((self.normal * before.normal).sum(axis=-1) > _SAME_NORMAL)
        return int(((self.own | before.own) & ~same).sum())
