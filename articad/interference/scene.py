"""The scene of a check: bodies, the relations of their parts, and the accuracy of their meshes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from articad.arrays import BoolArray, FloatArray, IntArray
from articad.connectors.se3 import SE3
from articad.geometry.mesh import TriMesh
from articad.interference.body import Body, body_of
from articad.interference.relations import FitLike, Relations, WaiverLike
from articad.kinematics.joints import Joint

_PARALLEL = 1e-12  # added to the cosines between edges
_NEXT, _LAST = [1, 2, 0], [2, 0, 1]
_PAIRS_AT_ONCE = 1 << 16  # of boxes that are compared: 10 MB
_BOX_MARGIN_MM = 1e-6  # boxes of touching faces must meet, whatever the rounding


@dataclass(frozen=True, eq=False)
class Scene:
    """The bodies of an assembly and the relations of their parts: the input of all checks.

    Attributes:
        meshes: By part, in the part's frame; parts without geometry are omitted.
        relations: Relations of the parts.
        deflections: By part [mm].
        fits: By joint name.
        environment: Parts that hold nothing and need not be held: they are only kept clear of.
    """

    meshes: Mapping[str, TriMesh]
    relations: Relations
    deflections: Mapping[str, float]
    fits: Mapping[str, FitLike] = field(default_factory=dict)
    environment: frozenset[str] = frozenset()

    @classmethod
    def of(
        cls,
        meshes: Mapping[str, TriMesh],
        joints: Sequence[Joint],
        *,
        waivers: Sequence[WaiverLike] = (),
        deflection: Mapping[str, float] | float = 0.0,
        fits: Mapping[str, FitLike] | None = None,
        environment: frozenset[str] = frozenset(),
    ) -> Scene:
        """Return the scene; `deflection` by part or the same for all [mm]."""
        deflections = {name: float(deflection if isinstance(deflection, int | float) else deflection.get(name, 0.0)) for name in meshes}
        return cls(dict(meshes), Relations(joints, waivers), deflections, dict(fits or {}), environment)

    @cached_property
    def bodies(self) -> dict[str, Body]:
        """Bodies by part."""
        return {name: body_of(mesh) for name, mesh in self.meshes.items()}

    @cached_property
    def index(self) -> dict[str, int]:
        """Index of each part among the bodies."""
        return {name: at for at, name in enumerate(self.bodies)}

    @cached_property
    def broken(self) -> dict[str, str]:
        """Parts whose meshes are not solids, with the reason."""
        return {name: body.fault for name, body in self.bodies.items() if body.fault is not None}

    @cached_property
    def deflection(self) -> float:
        """The largest deflection of all [mm]."""
        return max(self.deflections.values(), default=0.0)

    def deflection_of(self, a: str, b: str) -> float:
        """Sum of the deflections of two meshes [mm]."""
        return self.deflections[a] + self.deflections[b]

    def tolerated(self, a: str, b: str) -> float:
        """Depth that needs no waiver [mm]."""
        return self.relations.tolerated(a, b, self.deflection_of(a, b))

    def passable(self, a: str, b: str) -> float:
        """Depth by which two parts may enter each other while they move past each other: that of their waiver, if they have one [mm]."""
        waiver, allowed = self.relations.waiver(a, b), self.tolerated(a, b)
        return allowed if waiver is None else max(allowed, waiver.max_depth + self.deflection_of(a, b))

    @cached_property
    def local_boxes(self) -> tuple[FloatArray, FloatArray]:
        """Centres and half sides of the bodies' boxes in their own frames, `(N, 3)` each [mm]."""
        bounds = np.array([body.mesh.bounds if len(body.mesh.triangles) else np.zeros((2, 3)) for body in self.bodies.values()])
        bounds = bounds.reshape(-1, 2, 3)
        return (bounds[:, 0] + bounds[:, 1]) / 2, (bounds[:, 1] - bounds[:, 0]) / 2

    def at(self, poses: Mapping[str, SE3]) -> Placement:
        """Return the bodies at these poses of the parts."""
        data = np.array([poses[name].data for name in self.bodies]).reshape(-1, 7)
        return Placement(self, np.asarray(SE3.from_unit_array(data).matrix)[:, :3])

    def boxes(self, matrices: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return lower and upper corners of the bodies' boxes for matrices `(*batch, N, 3, 4)`: `(*batch, N, 3)` each [mm]."""
        centres, halves = self.local_boxes
        R = matrices[..., :3]
        middle = np.einsum("...nij,nj->...ni", R, centres) + matrices[..., 3]
        reach = np.einsum("...nij,nj->...ni", np.abs(R), halves)
        return middle - reach, middle + reach

    def apart(self, i: int | IntArray, j: int | IntArray, T_i_j: FloatArray) -> BoolArray:
        """Return at which relative poses the oriented boxes of two bodies are apart, `(n,)`.

        Args:
            i: Index of a body, or one for each pose.
            j: Index of the other body.
            T_i_j: Pose of the second in the frame of the first, `(n, 3, 4)` [mm].
        """
        centres, halves = self.local_boxes
        return boxes_apart((centres[i], halves[i]), (centres[j], halves[j]), T_i_j)

    def boxes_gap(self, i: int, j: int, T_i_j: FloatArray) -> FloatArray:
        """Return a lower bound of the distance of two bodies, `(n,)` [mm]: the largest gap of their oriented boxes along a box axis.

        Args:
            i: Index of a body.
            j: Index of the other body.
            T_i_j: Pose of the second in the frame of the first, `(n, 3, 4)` [mm].
        """
        (c, d), (h, g) = ((sides[i], sides[j]) for sides in self.local_boxes)
        R = T_i_j[..., :3]
        away = R @ d + T_i_j[..., 3] - c
        size = np.abs(R)
        beyond = np.concatenate([np.abs(away) - h - size @ g, np.abs((R * away[:, :, None]).sum(axis=1)) - g - h @ size], axis=1)
        return np.asarray(np.maximum(beyond.max(axis=1), 0.0))


def relatives(A: FloatArray, B: FloatArray) -> FloatArray:
    """Return the poses of bodies at `B` in the frames of those at `A`, all `(n, 3, 4)` [mm]."""
    back = A[..., :3].transpose(0, 2, 1)
    return np.concatenate([back @ B[..., :3], back @ (B[..., 3:] - A[..., 3:])], axis=2)


def boxes_apart(a: tuple[FloatArray, FloatArray], b: tuple[FloatArray, FloatArray], T_a_b: FloatArray) -> BoolArray:
    """Return at which relative poses `(n, 3, 4)` two boxes are apart, `(n,)`.

    Fifteen directions decide: three axes of each box, and the cross products of an edge of each (Gottschalk, Lin and Manocha 1996).

    Args:
        a: Centre and half sides in its own frame, `(3,)` each [mm], or `(n, 3)`.
        b: The same for the other box.
        T_a_b: Pose of the second in the frame of the first [mm].
    """
    R, h, g = T_a_b[..., :3], np.atleast_2d(a[1]), np.atleast_2d(b[1])
    d = np.einsum("nij,nj->ni", R, np.broadcast_to(b[0], (len(R), 3))) + T_a_b[..., 3] - a[0]
    size = np.abs(R) + _PARALLEL  # two parallel edges have no cross product
    beyond = np.abs(d) - h - (size * g[:, None]).sum(axis=2)
    beyond = np.concatenate([beyond, np.abs((R * d[:, :, None]).sum(axis=1)) - g - (size * h[:, :, None]).sum(axis=1)], axis=1)
    found = (beyond > _BOX_MARGIN_MM).any(axis=1)
    for k, after, last in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):  # along the cross products of edge k of a and each edge of b
        across = np.abs(d[:, last, None] * R[:, after] - d[:, after, None] * R[:, last])
        reach = h[:, after, None] * size[:, last] + h[:, last, None] * size[:, after]
        reach = reach + g[:, _NEXT] * size[:, k][:, _LAST] + g[:, _LAST] * size[:, k][:, _NEXT]
        found |= (across > reach + _BOX_MARGIN_MM).any(axis=1)
    return np.asarray(found)


def box_about(corners: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return centre and half sides of the box about triangles `(T, 3, 3)`, `(3,)` each [mm], in the form that `boxes_apart` takes."""
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    return (low + high) / 2, (high - low) / 2


@dataclass(frozen=True, eq=False)
class Placement:
    """The bodies of a scene at one pose.

    Attributes:
        scene: The scene of the bodies.
        matrices: `T_ground_part` of each, `(N, 3, 4)` [mm].
    """

    scene: Scene
    matrices: FloatArray

    def relative(self, a: str, b: str) -> FloatArray:
        """Return the pose of b in the frame of a, `(3, 4)` [mm]."""
        A, B = self.matrices[self.scene.index[a]], self.matrices[self.scene.index[b]]
        T = A[:, :3].T @ B
        T[:, 3] -= A[:, :3].T @ A[:, 3]
        return np.asarray(T)

    def near(self) -> Iterator[tuple[tuple[str, str], FloatArray, bool]]:
        """Yield the pairs whose boxes meet, the pose of the second in the frame of the first, and whether the oriented boxes are apart."""
        pairs = self.candidates()
        i, j = np.array([[self.scene.index[name] for name in pair] for pair in pairs], dtype=np.int64).reshape(-1, 2).T
        relative = relatives(self.matrices[i], self.matrices[j])
        return zip(pairs, relative, self.scene.apart(i, j, relative).tolist(), strict=True)

    def candidates(self, margin: float = _BOX_MARGIN_MM) -> list[tuple[str, str]]:
        """Return the pairs whose boxes, along the axes of the ground, are closer than `margin` [mm]."""
        low, high = self.scene.boxes(self.matrices)
        names = list(self.scene.bodies)
        order = np.argsort(low[:, 0], kind="stable")
        # the boxes are sorted along x, so that each is compared with those that begin before it ends: no N x N table
        ends = np.searchsorted(low[order, 0], high[order, 0] + margin, side="right")
        least, most = low[order] - margin, high[order]
        pairs: list[tuple[int, int]] = []
        for rows, others in _runs(ends):
            meet = ((least[others] <= most[rows]) & (least[rows] <= most[others])).all(axis=1)
            pairs += zip(order[rows[meet]].tolist(), order[others[meet]].tolist(), strict=True)
        return [(names[i], names[j]) for i, j in sorted((min(pair), max(pair)) for pair in pairs)]


def _runs(ends: IntArray) -> Iterator[tuple[IntArray, IntArray]]:
    """Yield each row with each of the later rows that begin before its end, in chunks that limit memory."""
    counts = np.maximum(ends - np.arange(len(ends)) - 1, 0)
    before = np.concatenate([[0], np.cumsum(counts)])
    start = 0
    while start < len(ends):
        stop = max(start + 1, int(np.searchsorted(before, before[start] + _PAIRS_AT_ONCE, side="right")) - 1)
        rows = np.repeat(np.arange(start, stop), counts[start:stop])
        yield rows, rows + 1 + np.arange(len(rows)) - (before[rows] - before[start])
        start = stop
