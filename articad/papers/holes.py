"""The holes of a part, and what joints require of its holes and shafts."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from articad.arrays import FloatArray
from articad.geometry.faces import Face, faces_of
from articad.geometry.mesh import TriMesh
from articad.geometry.winding import winding_numbers
from articad.plan.iso286 import limits, parsed_fit
from articad.realisation.bores import bore_and_pin

if TYPE_CHECKING:
    from articad.assembly import Assembly

__all__ = ["Fitted", "Hole", "fits_of", "holes_of"]

_SAME: Final = 2e-3  # mm between cylinders that count as one: what their mesh is off
_CLOSED: Final = 0.05  # sum of normals over the area: 0 for a whole cylinder
_BEYOND: Final = 0.05  # mm beyond the end of a hole, where a through hole is empty


@dataclass(frozen=True, eq=False)
class Hole:
    """A whole cylinder, hollow or solid.

    Attributes:
        centre: Middle of its axis, `(3,)` [mm] in the part's frame.
        axis: Direction of its axis, with its largest component positive.
        radius: [mm].
        depth: Length of the cylinder [mm].
        through: Whether it is empty beyond both ends.
        hollow: False for a shaft.
        fit: What a joint requires of it, such as "25 H7 +0.021/0"; empty if nothing.
    """

    centre: FloatArray
    axis: FloatArray
    radius: float
    depth: float
    through: bool
    hollow: bool = True
    fit: str = ""

    @property
    def along(self) -> int | None:
        """The axis of the part's frame to which it is parallel."""
        found = np.flatnonzero(np.abs(np.abs(self.axis) - 1.0) < 1e-6)
        return int(found[0]) if len(found) else None


@dataclass(frozen=True, eq=False)
class Fitted:
    """A cylinder of a part on which a joint has a fit: a line in the part's frame, and what to write there."""

    point: FloatArray
    axis: FloatArray
    radius: float
    hollow: bool
    words: str


def fits_of(assembly: Assembly) -> dict[str, list[Fitted]]:
    """Return, by part, the cylinders that fits of joints concern."""
    found: defaultdict[str, list[Fitted]] = defaultdict(list)
    poses, scene = assembly.at(), assembly.scene()
    for joint in assembly.joints:
        fit = assembly.fits.get(joint.name)
        pair = None if fit is None else bore_and_pin(scene, joint)
        if fit is None or pair is None:
            continue
        T_joint = poses[joint.parent] @ joint.T_parent_connector
        iso = None if fit.name is None else parsed_fit(fit.name)
        nominal = fit.nominal if fit.nominal is not None else round(2 * pair[0].face.radius, 1)
        for one, other in (pair, pair[::-1]):
            T = np.linalg.inv(poses[one.part].matrix) @ T_joint.matrix
            if iso is not None:
                words = _limits_text(iso.hole if one.face.hollow else iso.shaft, nominal)
            else:
                low, high = fit.gap_min, fit.gap_max
                gap = " to ".join(f"{value:g}" for value in (low, high) if value is not None)
                words = f"{fit.name or 'gap'} {gap}: {other.part}".strip()
            face = one.face.moved(T)
            found[one.part].append(Fitted(face.point, face.axis, face.radius, face.hollow, words))
    return dict(found)


def holes_of(mesh: TriMesh, fits: Mapping[str, list[Fitted]] | None = None, part: str = "") -> tuple[Hole, ...]:
    """Return the holes of a part, and its shafts on which a joint has a fit, widest first, from one corner to the other.

    Args:
        mesh: Its surface in its own frame [mm].
        fits: From `fits_of`.
        part: Its name there.
    """
    fitted = (fits or {}).get(part, [])
    groups: list[list[Face]] = []
    for face in faces_of(mesh):
        if face.kind == "cylinder":
            for group in groups:
                if _one_cylinder(group[0], face):
                    group.append(face)
                    break
            else:
                groups.append([face])
    found = []
    for group in groups:
        hole = _hole(group, mesh)
        if hole is None:
            continue
        fit = next((one.words for one in fitted if _on(one, hole)), "")
        if hole.hollow or fit:
            found.append(Hole(hole.centre, hole.axis, hole.radius, hole.depth, hole.through, hole.hollow, fit))
    return tuple(sorted(found, key=lambda h: (not h.hollow, -round(h.radius, 3), -round(h.depth, 2), *np.round(h.centre, 2))))


def _limits_text(name: str, nominal: float) -> str:
    lower, upper = limits(name, nominal)
    return f"Ø{nominal:g} {name} ({_signed(upper)}/{_signed(lower)})"


def _signed(deviation: float) -> str:
    return "0" if abs(deviation) < 1e-9 else f"{deviation:+.3f}".rstrip("0")


def _one_cylinder(a: Face, b: Face) -> bool:
    """Return whether two faces lie on one cylinder and touch."""
    if a.hollow != b.hollow or abs(a.radius - b.radius) > _SAME or np.linalg.norm(np.cross(a.axis, b.axis)) > 1e-5:
        return False
    apart = b.point - a.point
    if np.linalg.norm(apart - (apart @ a.axis) * a.axis) > _SAME:
        return False
    (low, high), (start, end) = ((heights.min(), heights.max()) for heights in (f.corners.reshape(-1, 3) @ a.axis for f in (a, b)))
    return bool(min(high, end) > max(low, start) - _SAME)


def _hole(group: list[Face], mesh: TriMesh) -> Hole | None:
    """Return the cylinder of some faces, if it is whole."""
    corners = np.concatenate([face.corners for face in group])
    twice = np.concatenate([face.normals_of_twice_area for face in group])
    if np.linalg.norm(twice.sum(axis=0)) > _CLOSED * np.linalg.norm(twice, axis=1).sum():
        return None
    axis, point = group[0].axis, group[0].point
    axis = axis * np.sign(axis[np.abs(axis).argmax()])
    axis = np.where(np.abs(axis) < 1e-7, 0.0, axis)
    heights = corners.reshape(-1, 3) @ axis
    low, high = float(heights.min()), float(heights.max())
    middle = point + (0.5 * (low + high) - point @ axis) * axis
    ends = np.stack([middle + sign * (0.5 * (high - low) + _BEYOND) * axis for sign in (-1.0, 1.0)])
    empty = winding_numbers(ends, mesh.vertices[mesh.triangles]) < 0.5
    return Hole(middle, axis, group[0].radius, high - low, bool(empty.all()), group[0].hollow)


def _on(fitted: Fitted, hole: Hole) -> bool:
    if fitted.hollow != hole.hollow or abs(fitted.radius - hole.radius) > _SAME or np.linalg.norm(np.cross(fitted.axis, hole.axis)) > 1e-4:
        return False
    apart = fitted.point - hole.centre
    return bool(np.linalg.norm(apart - (apart @ hole.axis) * hole.axis) < _SAME)
