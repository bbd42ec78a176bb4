"""One closed solid of few facets in place of meshes, in a form that a CAD kernel can sew, at several levels of accuracy.

Meshes from elsewhere may be open, intersect themselves, or consist of loose pieces. A kernel accepts none of these: it requires one
closed surface without self-intersections. The first level is the most accurate; each further one is coarser and more certain to be sewn.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final, NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from articad.arrays import FloatArray
from articad.export.convex import hull_mesh, manifold
from articad.geometry.mesh import TriMesh
from articad.geometry.shapes import box

__all__ = ["LEVELS", "MOST_FACETS", "OneSolid", "one_solid"]


LEVELS: Final = ("mesh", "fine", "coarse", "pieces", "hull", "box")
"""What a solid is made from, the preferred one first: the meshes' surface at three resolutions, their convex pieces, hull and box."""
MOST_FACETS: Final = 400  # of a part: the CAD kernel sews this many in a second
FINE_FACETS: Final = 1600  # used if further simplification makes the surface intersect itself
COARSE_FACETS: Final = 100
CELLS: Final = 6  # along the longest side of a part: the hull of the contents of each cell is a piece
OVERLAP: Final = 0.05  # of cells, as a share of their side, so that neighbouring hulls form one solid
ROUNDING_MM: Final = 6  # digits of a facet's corners: a millionth of a millimetre
CRUMB: Final = 1e-4  # share of the volume below which a loose piece is left out
BAR: Final = 5e-3  # radius of a bar between loose pieces, as a share of the part's size
LEAST_BAR_MM: Final = 0.02


class OneSolid(NamedTuple):
    """A solid that replaces meshes.

    Attributes:
        mesh: Closed, of one piece, its corners rounded to `ROUNDING_MM`; None if the meshes have no extent.
        exact: Total volume of the meshes; 0 if one is open.
        bars: Number of loose pieces connected by bars.
        crumbs: Number of loose pieces left out.
        level: The level used, of `LEVELS`; later than the requested one if the meshes do not allow that.
    """

    mesh: TriMesh | None
    exact: float
    bars: int = 0
    crumbs: int = 0
    level: str = LEVELS[0]


def one_solid(meshes: Sequence[TriMesh], level: str = LEVELS[0]) -> OneSolid:
    """Return one closed solid of few facets in place of meshes; holes are filled if their rims are complete.

    Args:
        meshes: In one frame [mm].
        level: The first of `LEVELS` to try.
    """
    whole = [manifold(mesh) for mesh in meshes]
    exact = float(_united(whole).volume()) if all(map(_is_solid, whole)) else 0.0
    filled = [body if _is_solid(body) else manifold(_filled(mesh)) for body, mesh in zip(whole, meshes, strict=True)]
    closed = all(map(_is_solid, filled))
    for name in LEVELS[LEVELS.index(level) :]:
        if name in _SURFACE and not closed:
            continue
        solid = _at_level(name, meshes, filled)
        if solid is None or solid.is_empty() or not solid.volume() > 0:
            continue
        joined, bars, crumbs = _joined(solid)
        mesh = _rounded(joined)
        if mesh is not None:
            return OneSolid(mesh, exact, bars, crumbs, name)
    return OneSolid(None, exact)


_SURFACE: Final = {"mesh": MOST_FACETS, "fine": FINE_FACETS, "coarse": COARSE_FACETS}  # largest number of facets at each


def _is_solid(body: Any) -> bool:
    return not body.is_empty() and bool(body.volume() > 0)


def _filled(mesh: TriMesh) -> TriMesh:
    """Return a mesh with its holes filled as far as possible."""
    import trimesh  # noqa: PLC0415 - few meshes are open

    made = trimesh.Trimesh(mesh.vertices, mesh.triangles, process=True)
    trimesh.repair.fill_holes(made)
    trimesh.repair.fix_normals(made)
    return TriMesh(np.asarray(made.vertices, dtype=np.float64), np.asarray(made.faces, dtype=np.int32))


def _pieces(mesh: TriMesh, body: Any) -> list[Any]:
    """Return hulls of the contents of grid cells: for a closed mesh of its solid, for an open one of its surface."""
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    cell = max(float((high - low).max()) / CELLS, LEAST_BAR_MM)
    counts = np.maximum(np.ceil((high - low) / cell - 1e-9), 1).astype(int)
    more = OVERLAP * cell
    points = np.zeros((0, 3)) if _is_solid(body) else _dense(mesh, cell / 2)
    hulls = []
    for index in np.ndindex(*counts.tolist()):
        start = low + np.array(index) * cell - more
        if _is_solid(body):
            inside = body ^ manifold(box(1.0, 1.0, 1.0)).scale([cell + 2 * more] * 3).translate((start + cell / 2 + more).tolist())
            own = np.zeros((0, 3)) if inside.is_empty() else _corners(inside)
        else:
            own = points[((points >= start) & (points <= start + cell + 2 * more)).all(axis=1)]
        if len(own) >= 4 and _is_solid(hull := manifold(hull_mesh(own))):
            hulls.append(hull)
    return hulls


def _dense(mesh: TriMesh, spacing: float) -> FloatArray:
    """Return points on a mesh that are at most a given distance apart along its edges."""
    import trimesh  # noqa: PLC0415 - few meshes are open

    vertices, _ = trimesh.remesh.subdivide_to_size(mesh.vertices, mesh.triangles, spacing, max_iter=20)
    return np.asarray(vertices, dtype=np.float64)


def _at_level(name: str, meshes: Sequence[TriMesh], whole: Sequence[Any]) -> Any:
    """Return the manifold that replaces meshes at a level, None if there is none."""
    vertices = np.concatenate([mesh.vertices for mesh in meshes])
    if name in _SURFACE:
        return _coarse(_united(whole), _SURFACE[name])
    if name == "pieces":
        pieces = [piece for mesh, body in zip(meshes, whole, strict=True) for piece in _pieces(mesh, body)]
        return _coarse(_united(pieces), MOST_FACETS) if pieces else None
    if name == "hull":
        return _coarse(manifold(hull_mesh(vertices)), MOST_FACETS)
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    x, y, z = np.maximum(high - low, LEAST_BAR_MM)
    return manifold(box(float(x), float(y), float(z))).translate(((low + high) / 2).tolist())


def _united(bodies: Sequence[Any]) -> Any:
    return sum(bodies[1:], start=bodies[0])


def _coarse(solid: Any, most: int) -> Any:
    """Return a solid with few facets, as close to the given one as that allows."""
    if solid.is_empty():
        return solid
    low, high = np.array(solid.bounding_box()).reshape(2, 3)
    size = float((high - low).max())
    coarse, tolerance = solid.simplify(1e-6 * size), 1e-4 * size
    while coarse.num_tri() > most and tolerance < size / 4:
        coarse, tolerance = solid.simplify(tolerance), 1.2 * tolerance
    if coarse.num_tri() > most or coarse.is_empty():
        coarse = manifold(hull_mesh(solid.simplify(size / 50).to_mesh64().vert_properties[:, :3]))
    return coarse


def _joined(solid: Any) -> tuple[Any, int, int]:
    """Return a solid of one piece: crumbs left out, loose pieces connected to the largest one by bars; and the numbers of both."""
    bodies = sorted(
        (body for body in solid.decompose() if body.volume() > 0), key=lambda body: (-body.volume(), tuple(body.bounding_box()))
    )
    total = sum(body.volume() for body in bodies)
    kept = [body for body in bodies if body.volume() >= CRUMB * total]
    low, high = np.array(solid.bounding_box()).reshape(2, 3)
    radius = max(BAR * float((high - low).max()), LEAST_BAR_MM)
    whole, rest = kept[0], [(body, _corners(body)) for body in kept[1:]]
    while rest:  # the nearest piece next
        tree = cKDTree(_corners(whole))
        found = [tree.query(corners) for _, corners in rest]
        at = min(range(len(rest)), key=lambda index: float(found[index][0].min()))
        body, corners = rest.pop(at)
        nearest = int(found[at][0].argmin())
        near, far = tree.data[found[at][1][nearest]], corners[nearest]
        if float(found[at][0].min()) < radius / 10:  # they touch in a point or along an edge, which is not a solid: push it in
            towards = _middle(whole) - _middle(body)
            push = radius * towards / (float(np.linalg.norm(towards)) or 1.0)
            body, far = body.translate(push.tolist()), far + push
        whole = whole + body + manifold(hull_mesh(np.concatenate([near + radius * _KNOB, far + radius * _KNOB])))
    return whole, len(kept) - 1, len(bodies) - len(kept)


_KNOB: FloatArray = np.array([  # corners of an octahedron in general orientation, so that no faces coincide
    [0.96, 0.11, 0.25], [-0.96, -0.11, -0.25], [-0.06, 0.98, -0.19], [0.06, -0.98, 0.19], [-0.27, 0.17, 0.95], [0.27, -0.17, -0.95],
])  # fmt: skip


def _middle(body: Any) -> FloatArray:
    """Return the centre of a body's bounding box."""
    return np.asarray(np.array(body.bounding_box()).reshape(2, 3).mean(axis=0))


def _corners(body: Any) -> FloatArray:
    return np.asarray(body.to_mesh64().vert_properties[:, :3], dtype=np.float64)


def _rounded(solid: Any) -> TriMesh | None:
    """Return a mesh with rounded corners that is still one closed piece, None if rounding breaks it."""
    row = solid.to_mesh64()
    corners = np.asarray(np.round(row.vert_properties[:, :3], ROUNDING_MM) + 0.0, dtype=np.float64)
    again = manifold(TriMesh(corners, np.asarray(row.tri_verts, dtype=np.int32)))
    if again.is_empty() or not again.volume() > 0 or len(again.decompose()) != 1:
        return None
    found = again.to_mesh64()
    return TriMesh(np.array(found.vert_properties[:, :3], dtype=np.float64), np.array(found.tri_verts, dtype=np.int32))
