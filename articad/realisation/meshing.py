"""Couplings that parts make by contact, such as gears and racks: whether these parts still meet elsewhere in the range."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from articad.connectors.se3 import SE3
from articad.findings import Finding
from articad.interference.overlap import distance
from articad.interference.scene import Scene
from articad.interference.sweep import MotionSampler
from articad.kinematics.mechanism import Mechanism

__all__ = ["lost_meshes"]

MESH_MM: Final = 1.0  # coupled parts at most this far apart at rest drive each other by contact; others by a belt or a shaft
_LEFT: Final = 3.0  # times that distance: teeth that have left each other
_POSES: Final = 9  # of the range of each driver


def lost_meshes(scene: Scene, mechanism: Mechanism) -> Iterator[Finding]:
    """Yield W_JOINT_LEAVES for each coupling whose parts nearly touch at rest, but not where a driver takes them.

    The range of each driver is sampled, with the others at rest. A driver that separates the parts without moving them by the coupling,
    such as a lever that disengages gears, is not reported.

    Args:
        scene: Bodies of the parts.
        mechanism: Joints and couplings, closed at rest.
    """
    children = {joint.name: joint.child for joint in mechanism.joints}
    columns = [coordinate.name for coordinate in mechanism.coordinates]
    meshing = []
    resting = mechanism.at_rest
    for coupling in mechanism.couplings:
        a, b = (children[name.split(".")[0]] for name in (coupling.a, coupling.b))
        if a != b and a in scene.bodies and b in scene.bodies:
            T = [resting[mechanism.part_index(name)] for name in (a, b)]
            gap = distance(scene.bodies[a], scene.bodies[b], T[0].inverse() @ T[1])
            if gap <= MESH_MM:
                meshing.append((coupling, a, b, gap))
    if not meshing:
        return
    sampler = MotionSampler(scene, mechanism)
    left: set[str] = set()
    for freedom in sampler.ranges():
        values = np.linspace(freedom.lower, freedom.upper, _POSES).tolist()
        kept, poses, solution = sampler.placed([{freedom.name: value} for value in values])
        for coupling, a, b, gap in meshing:
            moved = np.ptp(solution.columns[kept][:, columns.index(coupling.a)]) if len(kept) else 0.0
            if coupling.name in left or moved < 1e-9:
                continue
            for row, at in enumerate(kept):
                A, B = (SE3.from_matrix(poses[row, mechanism.part_index(name)]) for name in (a, b))
                apart = distance(scene.bodies[a], scene.bodies[b], A.inverse() @ B)
                if apart > max(_LEFT * MESH_MM, _LEFT * gap):
                    left.add(coupling.name)
                    yield _finding(coupling.name, (a, b), apart, gap, freedom.name, values[at])
                    break


def _finding(coupling: str, parts: tuple[str, str], apart: float, gap: float, freedom: str, value: float) -> Finding:
    a, b = parts
    return Finding(
        code="W_JOINT_LEAVES",
        where=f"couplings.{coupling}",
        parts=parts,
        message=f"{a} and {b} are coupled by {coupling!r} and {gap:.3g} mm apart at rest, but {apart:.4g} mm at {freedom} = {value:.4g}.",
        hint="Lengthen the teeth or the thread, or shorten the range.",
        value=apart,
        limit=_LEFT * MESH_MM,
        unit="mm",
        pose={freedom: value},
        stage="fit",
    )
