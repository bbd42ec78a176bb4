"""Lighter meshes for small pictures, and the smooth normals that keep them from looking faceted."""

from __future__ import annotations

import math

import manifold3d
import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from articad.arrays import FloatArray
from articad.geometry.mesh import TriMesh

_FEW_TRIANGLES = 200  # triangles; smaller meshes cost nothing to draw
_CREASE = math.cos(math.radians(32.0))  # a sharper bend between two triangles is an edge; normals are not smoothed across it
_AWAY = 0.2  # cosine between a triangle and a mean normal that no longer describes it


def simplified(mesh: TriMesh, tolerance: float) -> TriMesh:
    """Return a mesh with fewer triangles that lies within a distance of the given one; the same mesh if that cannot be done.

    Only closed manifolds become lighter: other meshes are drawn as they are.

    Args:
        mesh: The mesh.
        tolerance: Largest distance [mm]; rounded down to a power of two, so that nearly equal requests share one result.
    """
    if len(mesh.triangles) <= _FEW_TRIANGLES or not tolerance > 0:
        return mesh
    step = 2.0 ** math.floor(math.log2(tolerance))
    known: dict[float, TriMesh] = mesh.derived.setdefault("render.simplified", {})
    if step not in known:
        finer = max((done for done in known if done < step), default=0.0)  # most of the work is done there; distances add up
        known[step] = _collapsed(known.get(finer, mesh), step - finer)
    return known[step]


def _collapsed(mesh: TriMesh, tolerance: float) -> TriMesh:
    welded = mesh.welded()
    solid = manifold3d.Manifold(manifold3d.Mesh64(welded.vertices.copy(), welded.triangles.astype(np.uint64)))
    if solid.status() != manifold3d.Error.NoError:
        return mesh
    light = solid.simplify(tolerance)
    if not 0 < light.num_tri() < len(mesh.triangles):
        return mesh
    made = light.to_mesh64()
    return TriMesh(np.asarray(made.vert_properties, dtype=np.float64)[:, :3].copy(), np.asarray(made.tri_verts).astype(np.int32))


def corner_normals(mesh: TriMesh) -> FloatArray:
    """Return the unit normal at each corner of each triangle, `(T, 3, 3)`: the mean over the smooth surface around the vertex.

    Triangles belong to one smooth surface when a path of neighbours without a crease connects them. The mean is weighted by area.
    """
    known: FloatArray | None = mesh.derived.get("render.normals")
    if known is not None:
        return known
    triangles = np.asarray(mesh.triangles, dtype=np.int64)
    count = len(triangles)
    weighted = np.asarray(mesh.normals_of_twice_area, dtype=np.float64)
    flat = weighted / np.maximum(np.linalg.norm(weighted, axis=1, keepdims=True), 1e-300)
    place = _places(mesh)[triangles]
    surface = _smooth_surfaces(place, flat)
    # One sum for each pair of vertex and smooth surface.
    key = (place * max(count, 1) + surface[:, None]).ravel()
    _, inverse = np.unique(key, return_inverse=True)
    total = np.zeros((int(inverse.max(initial=-1)) + 1, 3))
    np.add.at(total, inverse, np.repeat(weighted, 3, axis=0))
    total /= np.maximum(np.linalg.norm(total, axis=1, keepdims=True), 1e-300)
    normals = total[inverse].reshape(count, 3, 3)
    # A surface that bends slowly by more than a right angle in all may turn the mean away from the triangle: it then keeps its own normal.
    away = (normals * flat[:, None]).sum(axis=2) < _AWAY
    result: FloatArray = np.where(away[..., None], flat[:, None], normals)
    mesh.derived["render.normals"] = result
    return result


def _places(mesh: TriMesh) -> np.ndarray[tuple[int], np.dtype[np.int64]]:
    """Return a number for each vertex that equal positions share."""
    return np.unique(mesh.vertices, axis=0, return_inverse=True)[1].astype(np.int64).ravel()


def _smooth_surfaces(place: np.ndarray, flat: FloatArray) -> np.ndarray:
    """Return the number of each triangle's smooth surface, `(T,)`."""
    count = len(place)
    sides = np.concatenate([place[:, [0, 1]], place[:, [1, 2]], place[:, [2, 0]]])
    owner = np.tile(np.arange(count), 3)
    key = sides.min(axis=1) * (int(place.max(initial=0)) + 1) + sides.max(axis=1)
    order = np.argsort(key, kind="stable")
    same = key[order][1:] == key[order][:-1]
    first, second = owner[order][:-1][same], owner[order][1:][same]
    smooth = (flat[first] * flat[second]).sum(axis=1) > _CREASE
    graph = coo_array((np.ones(int(smooth.sum()), dtype=np.int8), (first[smooth], second[smooth])), shape=(count, count))
    labels: np.ndarray = connected_components(graph, directed=False)[1].astype(np.int64)
    return labels
