"""The scene of a check: bodies, how their parts are related, how exact their meshes are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from articad.connectors.se3 import SE3
from articad.geometry.mesh import TriMesh
from articad.interference.body import Body, body_of
from articad.interference.relations import FitLike, Relations, WaiverLike
from articad.kinematics.joints import Joint

FloatArray = NDArray[np.float64]

_BOX_MARGIN_MM = 1e-6  # boxes of touching faces must meet, however they round


@dataclass(frozen=True, eq=False)
class Scene:
    """The bodies of an assembly and how their parts are related: what all checks work on.

    Attributes:
        meshes: By part, in the part's frame; parts without geometry are left out.
        relations: Of the parts.
        deflections: By part [mm].
        fits: By joint name.
    """

    meshes: Mapping[str, TriMesh]
    relations: Relations
    deflections: Mapping[str, float]
    fits: Mapping[str, FitLike] = field(default_factory=dict)

    @classmethod
    def of(
        cls,
        meshes: Mapping[str, TriMesh],
        joints: Sequence[Joint],
        *,
        waivers: Sequence[WaiverLike] = (),
        deflection: Mapping[str, float] | float = 0.0,
        fits: Mapping[str, FitLike] | None = None,
    ) -> Scene:
        """Return the scene; `deflection` by part or the same for all [mm]."""
        deflections = {name: float(deflection if isinstance(deflection, int | float) else deflection.get(name, 0.0)) for name in meshes}
        return cls(dict(meshes), Relations(joints, waivers), deflections, dict(fits or {}))

    @cached_property
    def bodies(self) -> dict[str, Body]:
        """By part."""
        return {name: body_of(mesh) for name, mesh in self.meshes.items()}

    @cached_property
    def broken(self) -> dict[str, str]:
        """Parts whose meshes are no solids, with the reason."""
        return {name: body.fault for name, body in self.bodies.items() if body.fault is not None}

    @cached_property
    def deflection(self) -> float:
        """The largest of all [mm]."""
        return max(self.deflections.values(), default=0.0)

    def deflection_of(self, a: str, b: str) -> float:
        """Deflection of two meshes together [mm]."""
        return self.deflections[a] + self.deflections[b]

    def tolerated(self, a: str, b: str) -> float:
        """Depth that needs no waiver [mm]."""
        return self.relations.tolerated(a, b, self.deflection_of(a, b))

    @cached_property
    def local_boxes(self) -> tuple[FloatArray, FloatArray]:
        """Centres and half sides of the bodies' boxes in their own frames, `(N, 3)` each [mm]."""
        bounds = np.array([body.mesh.bounds if len(body.mesh.triangles) else np.zeros((2, 3)) for body in self.bodies.values()])
        bounds = bounds.reshape(-1, 2, 3)
        return (bounds[:, 0] + bounds[:, 1]) / 2, (bounds[:, 1] - bounds[:, 0]) / 2

    def boxes_at(self, poses: Mapping[str, SE3]) -> tuple[FloatArray, FloatArray]:
        """Return lower and upper corners of the parts' boxes in the ground frame, `(N, 3)` each [mm]."""
        centres, halves = self.local_boxes
        R = np.array([poses[name].rotation for name in self.bodies]).reshape(-1, 3, 3)
        t = np.array([poses[name].translation for name in self.bodies]).reshape(-1, 3)
        middle = np.einsum("nij,nj->ni", R, centres) + t
        reach = np.einsum("nij,nj->ni", np.abs(R), halves)
        return middle - reach, middle + reach

    def candidates(self, poses: Mapping[str, SE3], margin: float = _BOX_MARGIN_MM) -> list[tuple[str, str]]:
        """Return the pairs whose boxes are closer than `margin` [mm]."""
        low, high = self.boxes_at(poses)
        names = list(self.bodies)
        order = np.argsort(low[:, 0], kind="stable")
        pairs: list[tuple[int, int]] = []
        # along x the boxes are sorted, so that each is compared with those that begin before it ends: no N x N table
        starts = low[order, 0]
        ends = np.searchsorted(starts, high[order, 0] + margin, side="right")
        for at, (i, end) in enumerate(zip(order.tolist(), ends.tolist(), strict=True)):
            others = order[at + 1 : end]
            meet = ((low[others] <= high[i] + margin) & (low[i] <= high[others] + margin)).all(axis=1)
            pairs += [(min(i, j), max(i, j)) for j in others[meet].tolist()]
        return [(names[i], names[j]) for i, j in sorted(pairs)]
