"""Bodies: meshes prepared for collision queries, once each, and refused when they are not solids."""

from __future__ import annotations

from functools import cached_property
from typing import Any, cast

import fcl
import manifold3d
import numpy as np
from numpy.typing import NDArray

from articad.arrays import FloatArray
from articad.connectors.se3 import SE3
from articad.geometry.mesh import TriMesh

_EXTREME_DIRECTIONS = np.array([[x, y, z] for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1) if x or y or z], dtype=np.float64)
_SCATTERED = 600
_FEW_TRIANGLES = 200  # triangles; smaller meshes are used as they are
_WORTH_THINNING = 0.75  # share of the triangles that may remain; otherwise the mesh is used as it is
_AREA_SLACK = 1e-9  # relative: a face moved by the tolerance may tilt
_ROUNDING = 1e-12  # relative, of a sum over thousands of triangles


class Body:
    """One mesh with its FCL and manifold3d objects, each made at the first access.

    Attributes:
        mesh: Welded, so that neighbouring triangles share their vertices.
    """

    def __init__(self, mesh: TriMesh) -> None:
        self.mesh = mesh if mesh.is_closed else mesh.welded()

    @property
    def is_empty(self) -> bool:
        """True when there are no triangles; FCL would crash on it."""
        return not len(self.mesh.triangles)

    @cached_property
    def fault(self) -> str | None:
        """Why overlap with this mesh cannot be measured; None for a valid solid.

        Without this check a broken mesh would silently overlap nothing: manifold3d returns 0 for it.
        """
        if self.is_empty:
            return "the mesh has no triangles"
        if not self.mesh.is_closed:
            return f"the mesh is open: {self.mesh.open_edges} edges belong to only one triangle"
        if self.mesh.volume <= 0:
            return f"the mesh encloses {self.mesh.volume:.6g} mm³: it is flat or inside out"
        if self._shell_outside_all is not None:
            return f"a shell of the mesh encloses {self._shell_outside_all:.6g} mm³ outside all others: it is inside out"
        status = self._new_manifold().status()  # not cached: most parts of a large assembly never come near another
        if status != manifold3d.Error.NoError:
            return f"the mesh is not a manifold ({status.name})"
        return None

    @cached_property
    def manifold(self) -> Any:
        """The solid as a `manifold3d.Manifold` in double precision; check `fault` before using it.

        If the mesh cuts flat faces into far more triangles than their outlines need, these are merged: the solid is the same up to
        rounding, and the cost of a boolean grows with the number of triangles.
        """
        whole = self._new_manifold()
        if whole.num_tri() <= _FEW_TRIANGLES or whole.status() != manifold3d.Error.NoError:
            return whole
        plain = whole.simplify(0.0)  # by no more than the manifold's own tolerance, 1e-12 of its size
        return plain if plain.num_tri() <= _WORTH_THINNING * whole.num_tri() and _same_solid(whole, plain) else whole

    @cached_property
    def manifold_triangles(self) -> int:
        """Number of triangles of `manifold`: those of the mesh, or fewer where it cuts flat faces up needlessly."""
        return int(self.manifold.num_tri()) or len(self.mesh.triangles)  # a broken mesh has none there

    @property
    def is_thinned(self) -> bool:
        """Whether `manifold` has fewer triangles than the mesh."""
        return self.manifold_triangles < len(self.mesh.triangles)

    @cached_property
    def manifold_id(self) -> int:
        """Identifier by which solids cut from `manifold` name the source of their triangles."""
        return int(self.manifold.to_mesh64().run_original_id[0])

    def _new_manifold(self) -> Any:
        # copies: manifold3d only accepts writable arrays
        return manifold3d.Manifold(manifold3d.Mesh64(self.mesh.vertices.copy(), self.mesh.triangles.astype(np.uint64)))

    @cached_property
    def bvh(self) -> Any:
        """The surface as an `fcl.BVHModel`, with as few triangles as `manifold`."""
        return make_bvh(*self._plain)

    @cached_property
    def plain_corners(self) -> FloatArray:
        """Corners of the triangles of `manifold`, `(T, 3, 3)`."""
        vertices, triangles = self._plain
        return np.asarray(vertices[triangles])

    @property
    def _plain(self) -> tuple[FloatArray, NDArray[Any]]:
        if not self.is_thinned:
            return self.mesh.vertices, self.mesh.triangles
        content = self.manifold.to_mesh64()
        return np.array(content.vert_properties)[:, :3], np.array(content.tri_verts).astype(np.int32)

    @cached_property
    def standing(self) -> Any:
        """A collision object that stays at the identity."""
        return fcl.CollisionObject(self.bvh)

    @cached_property
    def moving(self) -> Any:
        """A collision object that is placed anew for every query; separate from `standing`, since a mesh may be compared with itself."""
        return fcl.CollisionObject(self.bvh)

    @cached_property
    def volume(self) -> float:
        """Enclosed volume [mm³]."""
        return self.mesh.volume

    @cached_property
    def diagonal(self) -> float:
        """Diagonal of the bounding box [mm]."""
        return float(np.linalg.norm(self.mesh.bounds[1] - self.mesh.bounds[0]))

    @cached_property
    def components(self) -> tuple[TriMesh, ...]:
        """Its shells."""
        return self.mesh.components()

    @cached_property
    def extremes(self) -> tuple[FloatArray, ...]:
        """For each shell the farthest vertices in 26 directions, `(26, 3)`: nearly always, a shell is inside a box if these are."""
        return tuple(shell.vertices[np.argmax(shell.vertices @ _EXTREME_DIRECTIONS.T, axis=0)] for shell in self.components)

    @cached_property
    def scattered(self) -> FloatArray:
        """Some of the vertices, `(V, 3)`: whatever is near one of them is near the body."""
        return self.mesh.vertices[:: 1 + len(self.mesh.vertices) // _SCATTERED]

    @cached_property
    def reach(self) -> float:
        """Largest coordinate [mm]."""
        return float(np.abs(self.mesh.bounds).max())

    @cached_property
    def scattered_squares(self) -> FloatArray:
        """Squares of the distances of `scattered` from the origin, `(V,)` [mm²]."""
        return np.asarray(np.einsum("vi,vi->v", self.scattered, self.scattered))

    @cached_property
    def corners(self) -> FloatArray:
        """Corners of all triangles, `(T, 3, 3)`."""
        return self.mesh.vertices[self.mesh.triangles]

    @property
    def _shell_outside_all(self) -> float | None:
        """Volume of a shell that is inside out but is not a cavity of another."""
        if len(self.components) == 1:
            return None
        solids = [shell for shell in self.components if shell.volume > 0]
        for shell in self.components:
            low, high = shell.bounds
            if shell.volume <= 0 and not any((other.bounds[0] <= low).all() and (high <= other.bounds[1]).all() for other in solids):
                return shell.volume
        return None


def body_of(mesh: TriMesh) -> Body:
    """Return the body of a mesh; parts that share a mesh share the body, which lives as long as the mesh."""
    body = mesh.derived.get("body")
    if body is None:
        body = mesh.derived["body"] = Body(mesh)
    return cast("Body", body)


def _same_solid(whole: Any, plain: Any) -> bool:
    """Return whether two solids have the same size, volume and surface, up to the change that moving a surface by the tolerance allows."""
    off = float(whole.get_tolerance())
    area, size = float(whole.surface_area()), np.array(whole.bounding_box())
    return (
        plain.status() == manifold3d.Error.NoError
        and abs(plain.volume() - whole.volume()) <= off * area + _ROUNDING * abs(whole.volume())
        and abs(plain.surface_area() - area) <= _AREA_SLACK * area
        and bool(np.abs(np.array(plain.bounding_box()) - size).max() <= off)
    )


def make_bvh(vertices: FloatArray, triangles: NDArray[Any]) -> Any:
    """Return an FCL model of loose triangles."""
    model = fcl.BVHModel()
    model.beginModel(len(vertices), len(triangles))
    model.addSubModel(vertices, triangles)
    model.endModel()
    return model


def relative(T_a: SE3, T_b: SE3) -> SE3:
    """Return `T_a_b`: the pose of b in the frame of a."""
    return T_a.inverse() @ T_b
