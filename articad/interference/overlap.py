"""One pair of bodies at one relative pose: whether they overlap, how deeply, or how far apart they are.

FCL finds contact of surfaces and distances. Whether two bodies overlap is decided by the volume and depth that manifold3d measures,
because FCL does not detect containment and reports touching faces as a hit or not depending on rounding. `fcl.continuousCollide` is
never used.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from typing import Any

import fcl
import numpy as np
from numpy.typing import NDArray

from articad.arrays import FloatArray
from articad.connectors.quaternion import cross
from articad.connectors.se3 import SE3
from articad.errors import InvalidSolidError
from articad.geometry.winding import winding_numbers
from articad.interference.body import Body, make_bvh

VOLUME_NOISE_MM3 = 1e-9  # touching faces of centimetres leave up to 1e-12; a real overlap of 1e-6 mm has more
DIRECT_TRIANGLES = 4000  # solids up to this size: a boolean costs less than FCL's search for contact (measured: 0.6x at 2k, 2.7x at 20k)
_DEPTH_PIECES = 24  # pieces of an overlap whose depth is sampled, the largest first
_BEACONS = 400  # points of a surface that bound the distance of others from it
_SQUARES_ROUNDING = 1e-14  # of sums of squares, relative
_SPREAD_SAMPLES = 96  # further points where faces that a mesh cuts into many triangles were merged
_CONVEX = 1e-9  # share of its volume by which the hull of a convex solid may be larger
_DEPTH_SAMPLES = 48  # vertices, and as many centres of triangles, at which the depth of one piece is sampled


@dataclass(frozen=True)
class Overlap:
    """The common volume of two bodies.

    Attributes:
        volume: [mm³].
        depth: Distance of the deepest point of the common solid below a surface on which it does not lie [mm]: the larger of the deepest
            sampled point of its own surface and, where the two surfaces coincide, the radius of the largest ball inside it.
        pieces: Number of separate pieces.
        box: Bounding box of all pieces in the first body's frame, `(2, 3)` [mm]; None if there are none.
    """

    volume: float = 0.0
    depth: float = 0.0
    pieces: int = 0
    box: FloatArray | None = None


NOTHING = Overlap()


def overlap(a: Body, b: Body, T_a_b: SE3) -> Overlap:
    """Measure the common volume and depth exactly, by a boolean of the two solids.

    Raises:
        InvalidSolidError: If one of the meshes is not a solid.
    """
    return overlap_of(intersection(a, b, T_a_b), a, b, T_a_b.matrix[:3])


def overlap_of(common: Any, a: Body, b: Body, T_a_b: FloatArray) -> Overlap:
    """Measure the common solid of two bodies, a manifold in the frame of the first; `T_a_b` is `(3, 4)`."""
    if float(common.volume()) <= VOLUME_NOISE_MM3:
        return NOTHING
    pieces = [(float(piece.volume()), piece) for piece in common.decompose()]
    pieces = sorted(((volume, piece) for volume, piece in pieces if volume > VOLUME_NOISE_MM3), key=lambda pair: -pair[0])
    if not pieces:
        return NOTHING
    depth = 0.0
    for _, piece in pieces[:_DEPTH_PIECES]:
        depth = _sampled_depth(piece, a, b, T_a_b, depth)
    thick = [(2 * volume / float(piece.surface_area()), piece) for volume, piece in pieces]  # mean thicknesses
    depth = max([depth, *(_inscribed(piece, mean) for mean, piece in thick if mean > depth)])  # where both surfaces coincide
    box = np.array(common.bounding_box()).reshape(2, 3)
    return Overlap(sum(volume for volume, _ in pieces), depth, len(pieces), box)


def intersection(a: Body, b: Body, T_a_b: SE3) -> Any:
    """Return the common solid as a manifold in a's frame.

    Raises:
        InvalidSolidError: If one of the meshes is not a solid.
    """
    return _intersection(a, b, T_a_b.matrix[:3])


def _intersection(a: Body, b: Body, T_a_b: FloatArray) -> Any:
    for body in (a, b):
        if body.fault is not None:
            raise InvalidSolidError(f"Overlap cannot be measured: {body.fault}.", status="fault")
    return common(a, b, T_a_b)


def measured(a: Body, b: Body, T_a_b: FloatArray) -> Overlap:
    """Measure the overlap, with the cheaper library first: for large meshes that do not touch this is one FCL search.

    Args:
        a: A body.
        b: Another.
        T_a_b: Pose of b in the frame of a, `(3, 4)`.

    Raises:
        InvalidSolidError: If one of the meshes is not a solid.
    """
    if not may_overlap(a, b, T_a_b):
        return NOTHING
    both = _intersection(a, b, T_a_b)
    return NOTHING if float(both.volume()) <= VOLUME_NOISE_MM3 else overlap_of(both, a, b, T_a_b)


def may_overlap(a: Body, b: Body, T_a_b: FloatArray) -> bool:
    """Return False if FCL and a containment test exclude an overlap; for small meshes the boolean decides at once.

    Args:
        a: A body.
        b: Another.
        T_a_b: Pose of b in the frame of a, `(3, 4)`.
    """
    if max(a.manifold_triangles, b.manifold_triangles) <= DIRECT_TRIANGLES:
        return True
    b.moving.setTransform(fcl.Transform(T_a_b[:, :3], T_a_b[:, 3]))
    if fcl.collide(a.standing, b.moving, fcl.CollisionRequest(), fcl.CollisionResult()) > 0:
        return True
    return one_contains_the_other(a, b, T_a_b)


def se3_of(T_a_b: FloatArray) -> SE3:
    """Return the SE3 of a pose `(3, 4)`, for functions that are called rarely."""
    T: Any = np.eye(4)
    T[:3] = T_a_b
    return SE3.from_matrix(T)


def volume(a: Body, b: Body, T_a_b: FloatArray) -> float:
    """Return only the common volume [mm³] of bodies without fault.

    Args:
        a: A body.
        b: Another.
        T_a_b: Pose of b in the frame of a, `(3, 4)`.
    """
    return float(common(a, b, T_a_b).volume())


def common(a: Body, b: Body, T_a_b: FloatArray) -> Any:
    """Return the common solid of bodies without fault as a manifold in a's frame; see `volume`."""
    return a.manifold ^ b.manifold.transform(T_a_b)


def surfaces_touch(a: Body, b: Body, T_a_b: SE3) -> bool:
    """Return whether FCL finds a common point of the two surfaces; for faces that merely touch, this depends on rounding."""
    if a.is_empty or b.is_empty:
        return False
    return bool(fcl.collide(a.standing, _placed(b, T_a_b), fcl.CollisionRequest(), fcl.CollisionResult()) > 0)


def distance(a: Body, b: Body, T_a_b: SE3) -> float:
    """Return the smallest distance of the two surfaces [mm]; 0 if they meet, positive also if one is inside the other."""
    if a.is_empty or b.is_empty:
        return math.inf
    return max(float(fcl.distance(a.standing, _placed(b, T_a_b), fcl.DistanceRequest(), fcl.DistanceResult())), 0.0)


def nearest(a: Body, b: Body, T_a_b: SE3) -> tuple[float, FloatArray, FloatArray]:
    """Return the distance [mm] and the two nearest points, both in a's frame, `(3,)` each."""
    result = fcl.DistanceResult()
    gap = max(float(fcl.distance(a.standing, _placed(b, T_a_b), fcl.DistanceRequest(enable_nearest_points=True), result)), 0.0)
    return gap, np.array(result.nearest_points[0]), np.array(result.nearest_points[1])


def one_contains_the_other(a: Body, b: Body, T_a_b: FloatArray) -> bool:
    """Return whether a shell of one is inside the other, provided that their surfaces do not meet; `T_a_b` is `(3, 4)`."""
    R, t = T_a_b[:, :3], T_a_b[:, 3]
    return any(_is_inside(a, points @ R.T + t) for points in b.extremes) or any(_is_inside(b, (points - t) @ R) for points in a.extremes)


def _is_inside(outer: Body, points: FloatArray) -> bool:
    """Return whether a shell with these extreme points, which meets no surface of the outer body, is inside it."""
    low, high = outer.mesh.bounds
    return bool((points >= low).all() and (points <= high).all()) and bool(winding_numbers(points[:1], outer.corners)[0] > 0.5)


def _placed(b: Body, T_a_b: SE3) -> Any:
    b.moving.setTransform(fcl.Transform(T_a_b.rotation, T_a_b.translation))
    return b.moving


def _sampled_depth(piece: Any, a: Body, b: Body, T_a_b: FloatArray, known: float) -> float:
    """Return the largest distance of a point of the piece's surface from the surface on which it does not lie [mm], at least `known`.

    A corner that penetrates by 1 mm has a mean thickness of 0.24 mm; its tip gives the depth. Vertices alone give 0 when whole faces
    overlap.
    """
    mesh = piece.to_mesh64()
    vertices = np.asarray(mesh.vert_properties)[:, :3]
    triangles = np.asarray(mesh.tri_verts).astype(np.int64)
    points, of = _samples(vertices, triangles, all_over=a.is_thinned or b.is_thinned)
    others = _other_surfaces(mesh, triangles, a, b)
    asked = others[of]
    own = [vertices[triangles[~others[:, side], 0]] for side in (0, 1)]  # those on the surface of a, and of b
    known = _deepest(a, points[asked[:, 0]], own[0], known)
    R, t = T_a_b[:, :3], T_a_b[:, 3]
    return _deepest(b, (points[asked[:, 1]] - t) @ R, (own[1] - t) @ R, known)


def _inscribed(piece: Any, thickness: float) -> float:
    """Return the radius of the largest ball in a convex solid [mm]; for any other solid its mean thickness.

    Linear program: the largest r with n·x + r <= n·p for the plane (n, p) of every face (Chebyshev centre; Boyd and Vandenberghe, Convex
    Optimization, 4.3.1).
    """
    from scipy.optimize import linprog  # noqa: PLC0415 - rarely needed, and slow to import

    if float(piece.hull().volume()) > (1 + _CONVEX) * float(piece.volume()):
        return thickness
    mesh = piece.to_mesh64()
    corners = np.asarray(mesh.vert_properties)[:, :3][np.asarray(mesh.tri_verts)]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    sizes = np.linalg.norm(normals, axis=1)
    flat = sizes > 0
    normals = normals[flat] / sizes[flat, None]
    planes = np.column_stack([normals, np.ones(len(normals))])
    found = linprog([0, 0, 0, -1], planes, np.einsum("ti,ti->t", normals, corners[flat, 0]), bounds=[(None, None)] * 3 + [(0, None)])
    return float(found.x[3]) if found.success else thickness


def _samples(vertices: FloatArray, triangles: NDArray[np.int64], *, all_over: bool) -> tuple[FloatArray, NDArray[np.int64]]:
    """Return points of a surface `(P, 3)` and the indices of their triangles, `(P,)`: vertices, centres of the largest triangles.

    Args:
        vertices: `(V, 3)` [mm].
        triangles: `(T, 3)`.
        all_over: Whether to add points spread evenly by area, for faces in few large triangles that a mesh cuts into many.
    """
    corners = vertices[triangles]
    sides = corners[:, 1:] - corners[:, :1]
    normals = cross(sides[:, 0], sides[:, 1])
    areas = np.sqrt(np.einsum("ti,ti->t", normals, normals))
    largest = np.argsort(-areas, kind="stable")[:_DEPTH_SAMPLES]
    stride = max(1, len(vertices) // _DEPTH_SAMPLES)
    at = np.empty(len(vertices), dtype=np.int64)
    at[triangles] = np.arange(len(triangles))[:, None]
    points, of = [vertices[::stride], corners[largest].mean(axis=1)], [at[::stride], largest]
    if all_over:
        below = np.cumsum(areas)
        of.append(np.searchsorted(below[:-1], _SPREAD[:, 0] * below[-1]))
        points.append(corners[of[-1], 0] + np.einsum("pk,pki->pi", _SPREAD[:, 1:], sides[of[-1]]))
    return np.concatenate(points), np.concatenate(of)


def _spread(count: int) -> FloatArray:
    """Return a share of the area and two coordinates in a triangle for each of some points spread over a surface, `(count, 3)`."""
    at = np.arange(count)
    u, v = ((at * step) % 1.0 for step in (0.7548776662466927, 0.5698402909980532))  # the R₂ sequence of Roberts
    over = u + v > 1
    return np.stack([(at + 0.5) / count, np.where(over, 1 - u, u), np.where(over, 1 - v, v)], axis=1)


_SPREAD = _spread(_SPREAD_SAMPLES)


def _deepest(body: Body, points: FloatArray, on_surface: FloatArray, known: float) -> float:
    """Return the largest distance of points `(P, 3)` from a body's surface [mm], at least `known`.

    No point is farther from it than from the nearest of those `on_surface` `(S, 3)`, so most need no query.
    """
    off = _SQUARES_ROUNDING * (1.0 + body.reach + float(np.abs(points).max(initial=0.0))) ** 2
    beacons = [(body.scattered, body.scattered_squares)]
    if len(on_surface):
        some = on_surface[:: 1 + len(on_surface) // _BEACONS]
        beacons.append((some, np.einsum("si,si->s", some, some)))
    least = np.min([(squares - points @ (2.0 * there).T).min(axis=1) for there, squares in beacons], axis=0)
    at_most = np.sqrt(np.maximum(least + np.einsum("pi,pi->p", points, points), 0.0) + off)
    for at in np.argsort(-at_most, kind="stable").tolist():
        if at_most[at] <= known:
            break
        known = max(known, point_distance(body, points[at]))
    return known


def _other_surfaces(mesh: Any, triangles: NDArray[np.int64], a: Body, b: Body) -> NDArray[np.bool_]:
    """Return for each triangle of a common solid whether to query its distance from a, and from b, `(T, 2)`: not from its own surface."""
    if a.manifold_id == b.manifold_id:  # the same mesh twice
        return np.ones((len(triangles), 2), dtype=bool)
    of = np.repeat(np.asarray(mesh.run_original_id), np.diff(np.asarray(mesh.run_index)) // 3)
    return np.stack([of != a.manifold_id, of != b.manifold_id], axis=1)


def point_distance(body: Body, point: FloatArray) -> float:
    """Return the distance of a point from a body's surface [mm], in the body's frame."""
    probe = _point()
    probe.setTranslation(point)
    return float(fcl.distance(body.standing, probe, fcl.DistanceRequest(), fcl.DistanceResult()))


@cache
def _point() -> Any:
    """A point as a triangle of zero size: exact to the last bit, while FCL's spheres are exact to 1e-9 mm."""
    return fcl.CollisionObject(make_bvh(np.zeros((3, 3)), np.array([[0, 1, 2]], dtype=np.int32)))
