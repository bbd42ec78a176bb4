"""How far the partner of a joint lets its child move in a straight line: exact for the triangles of both, whatever their surfaces."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import Final

import numpy as np
from scipy.optimize import linprog

from articad.arrays import FloatArray
from articad.interference.freedoms import freedoms
from articad.interference.gauge import fixed_with, placed
from articad.interference.scene import Scene
from articad.interference.surface import inset_vertices
from articad.interference.travel import Outline, first_contacts
from articad.kinematics.joints import Joint
from articad.realisation.contacts import Pair

__all__ = ["Stops", "travel_past"]

_ASIDE: Final = 1e-3  # of the travel along the axis: what a way to the side costs
_SAME: Final = 1e-6  # of a unit vector
_FACING: Final = 1e-3  # cosine of a normal and the way, from which a triangle faces forwards
_INSETS: Final = 4.0  # depths of the inset surface by which its travel may be longer


class Stops:
    """The straight ways of a joint's child past its parent, each with the parts that are fixed to it, in the joint's frame.

    Args:
        scene: Parts and relations.
        joint: The joint.
        values: Of its `freedoms` [rad, mm]; at rest by default.
    """

    def __init__(self, scene: Scene, joint: Joint, values: Sequence[float] | None = None) -> None:
        self.scene, self.joint = scene, joint
        self.values = [freedom.rest for freedom in freedoms(joint)] if values is None else list(values)

    def travel(self, way: FloatArray) -> float:
        """Return how far the child moves along a unit vector `(3,)` before it meets its parent [mm]; infinity if it never does.

        Parts that overlap where they are by more than is allowed stop nothing: nothing is known about their surfaces.
        """
        least = math.inf
        for (a, T_a), (b, T_b) in itertools.product(self._places[0].items(), self._places[1].items()):
            depth = self.scene.passable(a, b)
            moving, inset, parent = self._corners(b, T_b, 0.0), self._corners(b, T_b, depth), self._corners(a, T_a, 0.0)
            least = min(least, travel_past(moving, inset, parent, way, depth))
        return least

    def room(self, column: int, sign: float, found: Sequence[Pair], own: FloatArray, least: float) -> tuple[float, FloatArray]:
        """Return how far the child moves along an axis, straight or aslant past the faces that stop it [mm], and on which way, `(3,)`.

        Args:
            column: Number of the axis.
            sign: 1 or -1.
            found: Pairs of faces that face each other.
            own: Which of the axes the joint itself moves along, `(3,)`.
            least: If it moves by no more straight, four further ways aslant are tried [mm].
        """
        axis = sign * np.eye(3)[column]
        far, best = self.travel(axis), axis
        if math.isfinite(far):
            for way in (*_past(axis, found, own), *(_aslant(axis, own) if far <= least else ())):
                travel = self.travel(way) * float(way @ axis)
                if travel > far:
                    far, best = travel, way
                if math.isinf(far):
                    break
        return far, best

    def weight(self) -> FloatArray:
        """Return the centre of volume of the child with all that is fixed to it, `(3,)` [mm]."""
        bodies = [(self.scene.bodies[name], T) for name, T in self._places[1].items()]
        volumes = np.array([max(body.volume, 1e-9) for body, _ in bodies])
        return np.asarray(volumes @ np.array([T[:3, :3] @ body.mesh.centroid + T[:3, 3] for body, T in bodies]) / volumes.sum())

    @cached_property
    def _places(self) -> tuple[dict[str, FloatArray], dict[str, FloatArray]]:
        """The poses in the joint's frame of the parts on both sides that are valid solids, `(4, 4)` each."""
        back = np.asarray(np.linalg.inv(self.joint.T_parent_connector.matrix))
        ends = {self.joint.parent: back, self.joint.child: np.asarray(back @ placed(self.joint, self.values))}
        first, second = (
            {
                name: np.asarray(T @ T_name)
                for name, T_name in fixed_with(self.scene, self.joint, end).items()
                if name not in self.scene.broken
            }
            for end, T in ends.items()
        )
        return first, second

    def _corners(self, name: str, T: FloatArray, depth: float) -> FloatArray:
        mesh = self.scene.bodies[name].mesh
        return np.asarray(inset_vertices(mesh, depth) @ T[:3, :3].T + T[:3, 3])[mesh.triangles]


def travel_past(moving: FloatArray, inset: FloatArray, standing: FloatArray, way: FloatArray, depth: float) -> float:
    """Return how far a surface moves along a unit vector `(3,)` before it meets another one [mm]; infinity if it never does, or overlaps where it is.

    Args:
        moving: Its triangles, `(T, 3, 3)` [mm].
        inset: The same moved inwards by `depth`.
        standing: Those of the other surface.
        way: The direction.
        depth: By which the two may overlap [mm].
    """
    forwards, backwards = first_contacts(Outline.of(inset, way), Outline.of(standing, way))
    if math.isinf(forwards) or not (forwards > 0 or backwards > 0):
        return math.inf
    return _met(moving, standing, way, forwards, depth)


def _met(moving: FloatArray, standing: FloatArray, way: FloatArray, inset: float, depth: float) -> float:
    """Return after what travel triangles that face each other meet `(T, 3, 3)`, given that of the inset surface and its depth [mm].

    Faces along which the child slides are in contact all the way, and face neither forwards nor backwards.
    """
    front, back = (corners[sign * (_normals(corners) @ way) > _FACING] for corners, sign in ((moving, 1.0), (standing, -1.0)))
    if not len(front) or not len(back):
        return inset
    travel = first_contacts(Outline.of(front, way), Outline.of(back, way))[0]
    return travel if inset - _INSETS * depth <= travel <= inset else inset


def _normals(corners: FloatArray) -> FloatArray:
    """Return the unit normals of triangles `(T, 3, 3)`, `(T, 3)`; 0 for one without area."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.asarray(normals / np.where(lengths > 0, lengths, 1.0))


def _past(axis: FloatArray, found: Sequence[Pair], own: FloatArray) -> Iterator[FloatArray]:
    """Yield the way of least deviation from an axis that pairs of faces leave open, if there is one and it is not the axis.

    With v = v⁺ - v⁻, the linear program maximises the travel along the axis less a small share of all travel.
    """
    if not found:
        return
    normals = np.concatenate([pair.normals for pair in found])
    goal = np.concatenate([-axis, axis]) + _ASIDE
    bounds = [(0.0, 0.0 if fixed else 1.0) for fixed in (*own, *own)]
    result = linprog(goal, A_ub=np.hstack([normals, -normals]), b_ub=np.zeros(len(normals)), bounds=bounds, method="highs")
    way = result.x[:3] - result.x[3:]
    length = float(np.linalg.norm(way))
    if length > _SAME and float(way @ axis) > _SAME and float(np.linalg.norm(way / length - axis)) > _SAME:
        yield way / length


def _aslant(axis: FloatArray, own: FloatArray) -> Iterator[FloatArray]:
    """Yield the ways between an axis and those across it that the joint should hold."""
    for column in np.flatnonzero(~own.astype(bool) & (np.abs(axis) < _SAME)):
        for sign in (1.0, -1.0):
            yield (axis + sign * np.eye(3)[column]) / math.sqrt(2.0)
