"""Contacts that convex pieces have and the solids do not: at rest, and while each driver moves over its range."""

from __future__ import annotations

import contextlib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from itertools import product
from typing import TYPE_CHECKING, NamedTuple

import manifold3d
import numpy as np
from numpy.typing import NDArray

from articad.arrays import FloatArray
from articad.errors import KinematicsError
from articad.export.convex import manifold
from articad.export.hulls import HULL_DEPTH_MM, HULL_VOLUME_MM3, HullOverlap, Pair
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Shape
from articad.interference.body import body_of
from articad.interference.boxes import meeting_boxes
from articad.interference.overlap import se3_of, surfaces_touch
from articad.interference.scene import Scene
from articad.interference.sweep import MotionSampler

if TYPE_CHECKING:
    from articad.kinematics.mechanism import Mechanism


POSES_PER_FREEDOM = 13  # over its range or each of its turns, the others at rest
CONVEX_SHARE = 1e-9  # of its volume: rounding in the hull of a convex part
_KEY_DIGITS = 6  # of mm and rotation entries: relative poses that agree to this are checked once


def poses_in_motion(mechanism: Mechanism) -> FloatArray:
    """Return the poses of all parts at rest and along the range of every driver, matrices `(n, N, 4, 4)` [mm].

    These are the poses of a sweep: endless drivers move until all followers have returned, and poses that a loop or a limit of another
    joint excludes are omitted.
    """
    sweep = MotionSampler(Scene.of({}, mechanism.joints), mechanism)
    found = [mechanism.at_rest[None].matrix]
    for freedom in sweep.ranges():
        with contextlib.suppress(KinematicsError):  # a loop that is open at rest has only its rest pose
            found.append(sweep.placed([{freedom.name: value} for value in sweep.values(freedom, POSES_PER_FREEDOM).tolist()])[1])
    return np.concatenate(found)


class _Placed(NamedTuple):
    """A body in its part's frame, the corners of its bounding box and its vertices [mm]."""

    body: manifold3d.Manifold
    low: FloatArray
    high: FloatArray
    vertices: FloatArray


@dataclass
class ContactSearch:
    """Finds new contacts between parts, and repeats the search only for parts whose pieces have changed.

    Attributes:
        order: Names of the parts, in the order of the poses.
        poses: `(n, N, 4, 4)` [mm]; the first is the rest pose.
        solids: Collision shapes of each part.
        surfaces: Whether open shapes, which are no solids, count as apart only where their surfaces do not meet; otherwise, they always do.
    """

    order: tuple[str, ...]
    poses: FloatArray
    solids: Mapping[str, tuple[Shape, ...]]
    surfaces: bool = False
    _bodies: dict[tuple[str, bool], manifold3d.Manifold] = field(default_factory=dict)
    _pieces: dict[str, tuple[Shape, ...]] = field(default_factory=dict)
    _found: dict[Pair, HullOverlap | None] = field(default_factory=dict)
    _ready: dict[tuple[str, bool], list[_Placed]] = field(default_factory=dict)

    @cached_property
    def _place(self) -> dict[str, int]:
        return {part: index for index, part in enumerate(self.order)}

    def update(self, part: str, pieces: Iterable[Shape]) -> None:
        """Replace the pieces of a part."""
        self._pieces[part] = tuple(pieces)
        self._ready.pop((part, True), None)
        self._found = {pair: found for pair, found in self._found.items() if part not in pair}

    def contacts(self, skip: set[Pair]) -> list[HullOverlap]:
        """Return the pairs whose pieces meet at rest, or at a pose where the solids do not, in the order in which they are declared.

        Args:
            skip: Pairs that engines do not check.
        """
        parts = [part for part in self.order if self._pieces.get(part)]
        boxes = [self._boxes(part) for part in parts]
        # Boxes about all poses of a part: only parts whose boxes meet can meet at a pose.
        whole = np.array([[low.min(axis=0), high.max(axis=0)] for low, high in boxes]).reshape(-1, 2, 3)
        for i, j in meeting_boxes(whole[:, 0], whole[:, 1]).tolist():
            a, b = parts[i], parts[j]
            if (a, b) in skip or (b, a) in skip or (a, b) in self._found:
                continue
            low, high = (np.maximum(boxes[i][0], boxes[j][0]), np.minimum(boxes[i][1], boxes[j][1]))
            near = np.flatnonzero((low < high).all(axis=1))
            if near.any() and self._is_convex(a) and self._is_convex(b):
                near = near[near == 0]  # in motion, such pieces meet only where the solids do
            self._found[a, b] = self._first_contact(a, b, near)
        found = sorted(self._found, key=lambda pair: (self._place[pair[0]], self._place[pair[1]]))
        contacts = (self._found[a, b] for a, b in found if (a, b) not in skip and (b, a) not in skip)
        return [contact for contact in contacts if contact is not None]

    @property
    def is_convex(self) -> bool:
        """Whether, for each part with solids, one piece equals its only solid."""
        return all(self._is_convex(part) for part, pieces in self._pieces.items() if pieces)

    def _boxes(self, part: str) -> tuple[FloatArray, FloatArray]:
        """Return the corners of the part's bounding box in every pose, `(n, 3)` each."""
        bounds = np.array([shape.placed.bounds for shape in self._pieces[part]])
        low, high = bounds[:, 0].min(axis=0), bounds[:, 1].max(axis=0)
        T = self.poses[:, self._place[part]]
        centre = T[:, :3, :3] @ ((low + high) / 2) + T[:, :3, 3]
        half = np.abs(T[:, :3, :3]) @ ((high - low) / 2)
        return centre - half, centre + half

    def _first_contact(self, a: str, b: str, near: NDArray[np.intp]) -> HullOverlap | None:
        first, second = (self.poses[near, self._place[part]] for part in (a, b))
        relative = _inverse(first) @ second
        seen: set[bytes] = set()
        for index, T in zip(near.tolist(), relative, strict=True):
            key = (np.round(T[:3], _KEY_DIGITS) + 0.0).tobytes()
            if key not in seen:
                seen.add(key)
                volume, depth = _overlap(self._bodies_of(a, convex=True), self._bodies_of(b, convex=True), T)
                if depth > HULL_DEPTH_MM:
                    solids = self._solids_meet(a, b, T)
                    if index == 0 or not solids:
                        return HullOverlap((a, b), volume, depth, solids)
        return None

    def _solids_meet(self, a: str, b: str, T: FloatArray) -> bool:
        if _overlap(self._bodies_of(a, convex=False), self._bodies_of(b, convex=False), T)[1] > HULL_DEPTH_MM:
            return True
        return self.surfaces and any(
            surfaces_touch(body_of(one.mesh), body_of(other.mesh), one.frame.inverse() @ se3_of(T[:3]) @ other.frame)
            for one, other in product(self.solids[a], self.solids[b])
            if not (one.mesh.is_closed and other.mesh.is_closed)
        )

    def _is_convex(self, part: str) -> bool:
        """True if one piece equals the part's only solid."""
        if len(self._pieces[part]) != 1 or len(self.solids[part]) != 1:
            return False
        pieces, solids = self._bodies_of(part, convex=True), self._bodies_of(part, convex=False)
        return len(pieces) == len(solids) == 1 and pieces[0].body.volume() <= solids[0].body.volume() * (1 + CONVEX_SHARE)

    def _bodies_of(self, part: str, *, convex: bool) -> list[_Placed]:
        """Return the bodies of a part's pieces, or of its solids; they are made when they are first compared."""
        if (part, convex) not in self._ready:
            self._ready[part, convex] = self._placed(self._pieces[part] if convex else self.solids[part], convex=convex)
        return self._ready[part, convex]

    def _placed(self, shapes: Iterable[Shape], *, convex: bool) -> list[_Placed]:
        """Return the shapes' bodies in the part's frame; an open or flat shape has no body."""
        found = []
        for shape in shapes:
            body = self._body(shape.mesh, convex=convex).transform(shape.frame.matrix[:3])
            if not body.is_empty():
                corners = body.bounding_box()
                vertices = np.ascontiguousarray(body.to_mesh64().vert_properties[:, :3])
                found.append(_Placed(body, np.array(corners[:3]), np.array(corners[3:]), vertices))
        return found

    def _body(self, mesh: TriMesh, *, convex: bool) -> manifold3d.Manifold:
        """Return the body of a mesh, or its hull; equal meshes share it."""
        key = mesh.digest, convex
        if key not in self._bodies:
            hull = manifold3d.Manifold.hull_points(mesh.vertices).simplify(HULL_DEPTH_MM / 10) if convex else None
            self._bodies[key] = manifold(mesh) if hull is None else hull
        return self._bodies[key]


def _overlap(first: list[_Placed], second: list[_Placed], T: FloatArray) -> tuple[float, float]:
    """Return the common volume of two lists of bodies [mm³], the second ones moved by T, and its mean depth [mm]."""
    volume = area = 0.0
    for other in second:
        centre = T[:3, :3] @ ((other.low + other.high) / 2) + T[:3, 3]
        half = np.abs(T[:3, :3]) @ ((other.high - other.low) / 2)
        near = [one for one in first if (one.low < centre + half).all() and (centre - half < one.high).all()]
        if near:
            vertices = other.vertices @ T[:3, :3].T + T[:3, 3]
            near = [one for one in near if not _are_apart(one.vertices, vertices, T[:3, :3])]
        if near:
            moved = other.body.transform(T[:3])
            for one in near:
                shared = one.body ^ moved
                volume += float(shared.volume())
                area += float(shared.surface_area())
    return (volume, 2 * volume / area) if volume > HULL_VOLUME_MM3 else (0.0, 0.0)


def _are_apart(first: FloatArray, second: FloatArray, R: FloatArray) -> bool:
    """True if a plane between two sets of points is found: normal to an axis of either frame, to two of them, or to the line of centres."""
    across = np.cross(np.eye(3)[:, None], R.T[None]).reshape(-1, 3)
    axes = np.vstack([np.eye(3), R.T, across, second.mean(axis=0) - first.mean(axis=0)])
    mine, theirs = first @ axes.T, second @ axes.T
    return bool(((mine.max(axis=0) < theirs.min(axis=0)) | (theirs.max(axis=0) < mine.min(axis=0))).any())


def _inverse(T: FloatArray) -> FloatArray:
    found = np.zeros_like(T)
    R = np.swapaxes(T[:, :3, :3], 1, 2)
    found[:, :3, :3] = R
    found[:, :3, 3] = -np.einsum("nij,nj->ni", R, T[:, :3, 3])
    found[:, 3, 3] = 1.0
    return found
