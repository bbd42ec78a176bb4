"""Measures of solids, taken from their triangles alone: round holes and studs, thickness of walls, what a vessel holds, how far a thing tips.

Only the surface of a part is known, whatever tool made it. A round face is known by its normals and its corners, which lie on
the circle; where the mesh says which triangles are one face, that is used, else faces end where the surface bends sharply.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import label
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import ConvexHull, QhullError

from articad.arrays import FloatArray
from articad.geometry import TriMesh

BEND_RAD: Final = math.radians(31)  # between neighbours: a cylinder of twelve facets is still one face, a chamfer of 45° is another
FLAT: Final = 1e-3  # share of the normals that may leave a plane across the axis of a cylinder
ROUND: Final = 0.02  # of the radius, by which corners may lie beside the circle
ARC_RAD: Final = math.radians(300)  # at least so much of a circle is a hole or a stud
PIECE_RAD: Final = math.radians(20)  # less of a circle than this has no certain radius
SAME_MM: Final = 0.02  # pieces of one cylinder have the same axis and radius
AXES: Final = 4  # directions in which cylinders are looked for within one smooth surface
UPRIGHT: Final = 2e-3  # cosine of the angle of a cylinder's normals to its axis, at most
SLENDER: Final = 3.0  # length of a facet by its width
SAMPLES: Final = 200  # points of a surface at which a wall is measured
BOX_DIRECTIONS: Final = 8  # in which most of a surface faces
SAME_WAY: Final = 1e-6  # by which the cosine of the angle between normals of one direction is less than one
ALIKE: Final = 0.01  # share by which areas of facets of one round face differ, or distances between eyes that are taken for equal
GRID_ROUNDING: Final = 1e-4  # of a cell: coordinates of single precision make no other number of cells
CELLS: Final = 100  # along the longest side, where volumes are counted
FLAT_CELLS: Final = 64  # above one another, where it matters how high water stands
FOOT_MM: Final = 0.2  # corners so near the ground stand on it
_LOW_DISCREPANCY: Final = (0.7548776662466927, 0.5698402909980532)
_ASIDE: Final = (3.7e-5, 6.1e-5)  # of a cell: columns never run along an edge

Grid = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Round:
    """A cylindrical face that goes (nearly) all the way round.

    Attributes:
        radius: [mm].
        axis: Of unit length `(3,)`.
        centre: Middle of the axis `(3,)` [mm].
        length: Along the axis [mm].
        hollow: True for a hole, False for a stud.
        blind: True for a hole with a bottom.
    """

    radius: float
    axis: FloatArray
    centre: FloatArray
    length: float
    hollow: bool
    blind: bool = False


@dataclass(frozen=True, eq=False)
class _Piece:
    radius: float
    axis: FloatArray
    foot: FloatArray  # of the axis: its point nearest to the origin
    span: tuple[float, float]
    hollow: bool
    points: FloatArray

    def is_slender(self) -> bool:
        """Return whether facets are much longer than wide."""
        u = np.cross(self.axis, [1.0, 0, 0] if abs(self.axis[0]) < 0.9 else [0, 1.0, 0])
        beside = self.points - self.foot
        facets = len(np.unique(np.round(np.arctan2(beside @ np.cross(self.axis, u), beside @ u), 6)))
        return self.span[1] - self.span[0] > SLENDER * math.tau * self.radius / facets

    def continues(self, other: _Piece) -> bool:
        alike = self.hollow == other.hollow and abs(self.radius - other.radius) < SAME_MM and abs(float(self.axis @ other.axis)) > 1 - 1e-6
        return (
            alike
            and float(np.linalg.norm(self.foot - other.foot)) < SAME_MM
            and self.span[0] < other.span[1] - SAME_MM
            and other.span[0] < self.span[1] - SAME_MM
        )


def rounds(mesh: TriMesh) -> list[Round]:
    """Return the round holes and studs of a solid, in the order of their first triangle."""
    mesh = mesh.welded(1e-6)
    normals = mesh.normals_of_twice_area
    area = np.linalg.norm(normals, axis=1)
    unit = normals / np.where(area > 0, area, 1)[:, None]
    smooth = _Smooth.of(mesh, unit, area > 0)
    faces = smooth.pieces(np.ones(len(area), dtype=np.bool_)) if mesh.face is None else np.asarray(mesh.face)
    pieces = []
    for face in dict.fromkeys(faces.tolist()):
        chosen = (faces == face) & (area > 0)
        if (piece := _cylinder(mesh, normals[chosen], mesh.triangles[chosen])) is not None:
            pieces.append(piece)
        elif mesh.face is None:
            pieces += _cylinders_within(mesh, normals, unit, chosen, smooth)
    found = []
    while pieces:
        group = [pieces.pop(0)]
        for piece in list(pieces):
            if any(piece.continues(other) for other in group):
                group.append(piece)
                pieces.remove(piece)
        if (whole := _whole(mesh, group)) is not None:
            found.append(whole)
    return found


@dataclass(frozen=True, eq=False)
class _Smooth:
    """Pairs of triangles across an edge at which the surface hardly bends: the triangles `(n,)` each, the edges' vertices `(n, 2)`."""

    first: NDArray[Any]
    second: NDArray[Any]
    edges: NDArray[Any]
    count: int

    @classmethod
    def of(cls, mesh: TriMesh, unit: FloatArray, real: Grid) -> _Smooth:
        """Return the pairs of a mesh.

        Args:
            mesh: The mesh.
            unit: Its normals `(n, 3)`.
            real: Whether a triangle has an area; one without belongs to all its neighbours `(n,)`.
        """
        edges = np.sort(mesh.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        owner = np.repeat(np.arange(len(mesh.triangles)), 3)
        order = np.lexsort(edges.T)
        edges, owner = edges[order], owner[order]
        pairs = np.flatnonzero((edges[1:] == edges[:-1]).all(axis=1))
        a, b = owner[pairs], owner[pairs + 1]
        smooth = ((unit[a] * unit[b]).sum(axis=1) > math.cos(BEND_RAD)) | ~real[a] | ~real[b]
        return cls(a[smooth], b[smooth], edges[pairs][smooth], len(mesh.triangles))

    def pieces(self, chosen: Grid) -> NDArray[Any]:
        """Return a number for each triangle `(count,)`, the same for those that such pairs of chosen triangles connect."""
        inside = chosen[self.first] & chosen[self.second]
        graph = coo_matrix((np.ones(int(inside.sum())), (self.first[inside], self.second[inside])), shape=(self.count, self.count))
        return np.asarray(connected_components(graph, directed=False)[1])


def _cylinders_within(mesh: TriMesh, normals: FloatArray, unit: FloatArray, chosen: Grid, smooth: _Smooth) -> list[_Piece]:
    """Return the cylinders of a smooth surface that is more than one: a leg with a taper, a pin whose edge is rounded.

    A cylinder bends along lines that are parallel to its axis, so the directions of most such lines are the candidates. Its facets are
    `SLENDER` times as long as wide; those in which a sphere or a ring are drawn are not.
    """
    rows = chosen[smooth.first] & chosen[smooth.second] & ((unit[smooth.first] * unit[smooth.second]).sum(axis=1) < 1 - 1e-7)
    lines: FloatArray = mesh.vertices[smooth.edges[rows, 1]] - mesh.vertices[smooth.edges[rows, 0]]
    length = np.linalg.norm(lines, axis=1)
    if not len(length):
        return []
    lines = lines / length[:, None]
    lines *= np.where(lines[np.arange(len(lines)), np.abs(lines).argmax(axis=1)] < 0, -1.0, 1.0)[:, None]
    ways, inverse = np.unique(np.round(lines, 3), axis=0, return_inverse=True)
    total = np.bincount(inverse.ravel(), weights=length)
    found: list[_Piece] = []
    left = chosen.copy()
    for way in np.argsort(-total)[:AXES]:
        axis = ways[way] / np.linalg.norm(ways[way])
        around = left & (np.abs(unit @ axis) < UPRIGHT)
        numbers = smooth.pieces(around)
        for number in dict.fromkeys(numbers[around].tolist()):
            face = around & (numbers == number)
            piece = _cylinder(mesh, normals[face], mesh.triangles[face])
            if piece is not None and piece.is_slender():
                found.append(piece)
                left &= ~face
    return found


def _cylinder(mesh: TriMesh, normals: FloatArray, triangles: NDArray[Any]) -> _Piece | None:
    """Return the cylinder that a face is, or None if it is not a cylinder."""
    if len(triangles) < 2:
        return None
    unit = normals / np.linalg.norm(normals, axis=1)[:, None]
    weight = np.linalg.norm(normals, axis=1)
    values, vectors = np.linalg.eigh((unit * weight[:, None]).T @ unit / weight.sum())
    axis = vectors[:, 0]
    if values[0] > FLAT or values[1] < FLAT:
        return None
    axis = axis if axis[int(np.abs(axis).argmax())] > 0 else -axis
    points = mesh.vertices[np.unique(triangles)]
    u, v = vectors[:, 1], vectors[:, 2]
    flat = np.stack([points @ u, points @ v], axis=1)
    middle = flat.mean(axis=0)
    rows = np.column_stack([2 * (flat - middle), np.ones(len(flat))])
    (x, y, c), *_ = np.linalg.lstsq(rows, ((flat - middle) ** 2).sum(axis=1), rcond=None)
    if (radius := math.sqrt(max(0.0, c + x * x + y * y))) == 0:
        return None
    centre = middle + np.array([x, y])
    if float(np.abs(np.linalg.norm(flat - centre, axis=1) - radius).max()) > ROUND * radius + 1e-3:
        return None
    if _arc(flat - centre) < PIECE_RAD:
        return None
    foot = centre[0] * u + centre[1] * v
    outward = float(((mesh.vertices[triangles].mean(axis=1) - foot) * normals).sum())  # along the axis it adds nothing
    along = points @ axis
    return _Piece(radius, axis, foot, (float(along.min()), float(along.max())), outward < 0, points)


def _arc(flat: FloatArray) -> float:
    """Return how much of a circle points go round, from the largest gap between them [rad]."""
    angles = np.sort(np.unique(np.round(np.arctan2(flat[:, 1], flat[:, 0]), 9)))
    gaps = np.diff(np.append(angles, angles[0] + 2 * math.pi))
    largest, second = float(gaps.max()), float(np.sort(gaps)[-2]) if len(gaps) > 1 else 0.0
    return 2 * math.pi if largest < 1.5 * second + 1e-9 and largest < math.pi / 3 + 1e-9 else 2 * math.pi - largest


def _whole(mesh: TriMesh, group: list[_Piece]) -> Round | None:
    first = group[0]
    points = np.concatenate([piece.points for piece in group])
    u = np.cross(first.axis, [1.0, 0, 0] if abs(first.axis[0]) < 0.9 else [0, 1.0, 0])
    u /= np.linalg.norm(u)
    v = np.cross(first.axis, u)
    beside = points - first.foot
    if _arc(np.stack([beside @ u, beside @ v], axis=1)) < ARC_RAD:
        return None
    low, high = min(piece.span[0] for piece in group), max(piece.span[1] for piece in group)
    centre = first.foot + (low + high) / 2 * first.axis
    blind = False
    if first.hollow:
        reach = (high - low) / 2 + 1.2 * first.radius
        blind = any(_has_bottom(mesh, centre + 1e-5 * u, way, reach, (u, v), first.radius) for way in (first.axis, -first.axis))
    return Round(first.radius, first.axis, centre, high - low, first.hollow, blind)


def _has_bottom(
    mesh: TriMesh, centre: FloatArray, way: FloatArray, reach: float, across: tuple[FloatArray, FloatArray], radius: float
) -> bool:
    """Return whether a hole ends that way: at a surface within reach, with wall all round it, unlike one that only faces another wall."""
    ahead = float(ray_lengths(mesh, centre[None], way[None])[0])
    if ahead >= reach:
        return False
    angles = np.arange(8) * math.pi / 4 + 0.1
    sideways = np.cos(angles)[:, None] * across[0] + np.sin(angles)[:, None] * across[1]
    bottom = np.repeat((centre + (ahead - ROUND * radius) * way)[None], len(angles), axis=0)
    return bool((ray_lengths(mesh, bottom, sideways) < (1 + 2 * ROUND) * radius).all())


def ray_lengths(mesh: TriMesh, origins: FloatArray, directions: FloatArray) -> FloatArray:
    """Return how far each ray goes to the surface, inf where it never meets it; origins and directions `(n, 3)` [mm]."""
    a, b, c = (mesh.vertices[mesh.triangles[:, i]] for i in range(3))
    e1, e2 = b - a, c - a
    lengths = np.full(len(origins), np.inf)
    for row, (origin, way) in enumerate(zip(origins, directions, strict=True)):
        p = np.cross(way, e2)
        det = (e1 * p).sum(axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            s = origin - a
            u = (s * p).sum(axis=1) / det
            q = np.cross(s, e1)
            v = (q @ way) / det
            t = (e2 * q).sum(axis=1) / det
            hit = (np.abs(det) > 1e-12) & (u >= -1e-9) & (v >= -1e-9) & (u + v <= 1 + 1e-9) & (t > 0)
        if hit.any():
            lengths[row] = t[hit].min()
    return lengths


def wall_thickness(mesh: TriMesh, samples: int = SAMPLES) -> FloatArray:
    """Return the thickness of a solid below points spread evenly over its surface, straight inwards `(samples,)` [mm]."""
    normals = mesh.normals_of_twice_area
    area = np.linalg.norm(normals, axis=1)
    ends = np.cumsum(area)
    number = np.arange(samples)
    chosen = np.minimum(np.searchsorted(ends, (number + 0.5) / samples * ends[-1]), len(area) - 1)
    s, t = ((number * step) % 1.0 for step in _LOW_DISCREPANCY)
    s, t = np.where(s + t > 1, 1 - s, s)[:, None], np.where(s + t > 1, 1 - t, t)[:, None]
    a, b, c = (mesh.vertices[mesh.triangles[chosen, i]] for i in range(3))
    inwards = -normals[chosen] / area[chosen, None]
    start = 1e-4
    return ray_lengths(mesh, a + s * (b - a) + t * (c - a) + start * inwards, inwards) + start


def boxes_by_faces(mesh: TriMesh, directions: int = BOX_DIRECTIONS) -> list[FloatArray]:
    """Return the sides of boxes around a shape in the frames that its faces suggest, each `(3,)` ascending [mm].

    For each of the directions in which most area faces: the height along it, and the least rectangle around the shape seen that way,
    as well as the rectangles along the other directions that are perpendicular to it. The line between the two round holes or studs that
    lie farthest apart is such a direction, too: a bar is measured along its eyes.
    """
    main = _facing(mesh, directions)
    lines = _along_eyes(rounds(mesh))
    try:
        points = mesh.vertices[ConvexHull(mesh.vertices).vertices]
    except QhullError:
        return []
    return [box for way in main for box in _boxes_along(points, way, [*main, *lines])]


def _facing(mesh: TriMesh, directions: int) -> list[FloatArray]:
    """Return the directions in which most area faces, whichever frame the mesh is in; no more than these.

    Facets of one round face have the same area each: none is a direction if not all of them can be.
    """
    normals = mesh.normals_of_twice_area
    area = np.linalg.norm(normals, axis=1)
    unit, area = normals[area > 0] / area[area > 0, None], area[area > 0]
    unit *= np.where(unit[np.arange(len(unit)), np.abs(unit).argmax(axis=1)] < 0, -1.0, 1.0)[:, None]
    _, inverse = np.unique(np.round(unit, 3), axis=0, return_inverse=True)
    ways: FloatArray = np.stack([np.bincount(inverse.ravel(), weights=area * unit[:, i]) for i in range(3)], axis=1)
    left = np.linalg.norm(ways, axis=1)
    ways = ways / left[:, None]
    found: list[tuple[float, FloatArray]] = []
    while len(found) < 3 * directions and left.any():  # of what rounding splits, each is less than the whole
        along = ways @ ways[left.argmax()]
        same = (np.abs(along) > 1 - SAME_WAY) & (left > 0)
        way = (ways[same] * (np.sign(along[same]) * left[same])[:, None]).sum(axis=0)
        found.append((float(np.linalg.norm(way)), way / np.linalg.norm(way)))
        left[same] = 0
    found.sort(key=lambda pair: -pair[0])
    least = found[directions][0] * (1 + ALIKE) if len(found) > directions else 0.0
    return [way for size, way in found[:directions] if size > least]


def _along_eyes(found: Sequence[Round]) -> list[FloatArray]:
    """Return the direction between the two parallel axes that lie farthest apart; none if others lie as far apart another way."""
    lines = []
    for a, b in combinations(found, 2):
        apart = b.centre - a.centre
        across = apart - float(apart @ a.axis) * a.axis
        if (length := float(np.linalg.norm(across))) > SAME_MM and abs(float(a.axis @ b.axis)) > 1 - 1e-6:
            lines.append((length, across / length))
    longest, way = max(lines, key=lambda line: line[0], default=(0.0, np.zeros(3)))
    others = [line for length, line in lines if length > (1 - ALIKE) * longest]
    return [way] if lines and all(abs(float(line @ way)) > 1 - SAME_WAY for line in others) else []


def _boxes_along(points: FloatArray, way: FloatArray, others: Sequence[FloatArray]) -> list[FloatArray]:
    u = np.cross(way, [1.0, 0, 0] if abs(way[0]) < 0.9 else [0, 1.0, 0])
    u /= np.linalg.norm(u)
    flat, height = np.column_stack([points @ u, points @ np.cross(way, u)]), float(np.ptp(points @ way))
    try:
        outline = flat[ConvexHull(flat).vertices]
    except QhullError:
        return []
    edges = np.roll(outline, -1, axis=0) - outline
    angles = np.arctan2(edges[:, 1], edges[:, 0])
    rectangles = [_rectangle(outline, angle) for angle in np.unique(np.round(np.mod(angles, math.pi / 2), 6))]
    chosen = [min(rectangles, key=lambda sides: float(np.prod(sides)))]
    across = [other for other in others if abs(float(other @ way)) < 1e-3]
    chosen += [_rectangle(outline, math.atan2(float(other @ np.cross(way, u)), float(other @ u))) for other in across]
    return [np.sort([height, *sides]) for sides in chosen]


def _rectangle(outline: FloatArray, angle: float) -> FloatArray:
    cos, sin = math.cos(angle), math.sin(angle)
    return np.asarray(np.ptp(outline @ np.array([[cos, -sin], [sin, cos]]), axis=0))


def occupied(meshes: Sequence[TriMesh], cells: int = CELLS) -> tuple[Grid, float]:
    """Return which cells of a grid hold matter, `(nx, ny, nz)`, and the side of a cell [mm]; the grid lies evenly about the box."""
    start, pitch, shape = _grid(meshes, cells)
    return np.asarray(np.any([_filled(_crossings(mesh, start, np.full(3, pitch), shape)) for mesh in meshes], axis=0)), pitch


def filled_cells(mesh: TriMesh, start: FloatArray, pitch: FloatArray, shape: tuple[int, int, int]) -> Grid:
    """Return the cells of a grid whose middles lie in a solid; start is the corner of the grid, and pitch the sides of a cell [mm]."""
    return _filled(_crossings(mesh, start, pitch, shape))


def held_volume(meshes: Sequence[TriMesh], cells: int = CELLS) -> float:
    """Return how much water stays in a vessel that stands as it is, filled to the brim [mm³].

    Water stays in a cell if, below that level, there is no way out from it; hollows that nothing can be poured into do not count.
    Walls thinner than a cell are in its way all the same: the cells on both sides of them count as wall first, and those that the
    water then touches as water. A second look, with flat cells, is taken at the heights where the first one found water.
    """
    start, pitch, (nx, ny, nz) = _grid(meshes, cells)
    start, sides = start - pitch, np.full(3, pitch)  # a way round everything
    water = _water(meshes, start, sides, (nx + 2, ny + 2, nz + 2), below=False)
    levels = np.flatnonzero(water.any(axis=(0, 1)))
    if not levels.size:
        return 0.0
    low, high = levels[0] - 2, levels[-1] + 3
    if high - low < FLAT_CELLS:
        start[2] += low * pitch
        sides[2] *= (high - low) / FLAT_CELLS
        water = _water(meshes, start, sides, (nx + 2, ny + 2, FLAT_CELLS), below=True)
    return float(water.sum()) * float(sides.prod())


def _water(meshes: Sequence[TriMesh], start: FloatArray, pitch: FloatArray, shape: tuple[int, int, int], *, below: bool) -> Grid:
    """Return the cells in which water stays; below tells that the grid begins above the ground, and all is open there."""
    matter, sheets = np.zeros(shape, dtype=bool), np.zeros(shape, dtype=bool)
    for mesh in meshes:
        matter |= _filled(_crossings(mesh, start, pitch, shape))
        sheets |= _sheets(mesh, start, pitch, shape)
    empty = ~(matter | sheets)
    if below:
        empty[:, :, 0] = True
    reached, _ = label(empty)
    open_above = reached == reached[0, 0, 0]
    water = np.zeros(shape, dtype=bool)
    for level in range(1, shape[2] - 1):
        if label(empty[:, :, level])[1] == 1:  # nothing is walled in at this height
            continue
        basins, _ = label(empty[:, :, : level + 1])
        water[:, :, level] = (basins[:, :, level] > 0) & (basins[:, :, level] != basins[0, 0, 0]) & open_above[:, :, level]
    beside = np.zeros(shape, dtype=bool)
    for axis, step in ((0, 1), (0, -1), (1, 1), (1, -1), (2, -1)):
        beside |= np.roll(water, step, axis)
    return water | (beside & sheets & ~matter)


def _grid(meshes: Sequence[TriMesh], cells: int) -> tuple[FloatArray, float, tuple[int, int, int]]:
    """Return the corner of a grid [mm], the side of its cells [mm] and how many there are along each axis."""
    low = np.min([mesh.bounds[0] for mesh in meshes], axis=0)
    high = np.max([mesh.bounds[1] for mesh in meshes], axis=0)
    pitch = float((high - low).max()) / cells
    nx, ny, nz = (max(1, math.ceil(side / pitch - GRID_ROUNDING)) for side in high - low)
    return (low + high) / 2 - np.array([nx, ny, nz]) * pitch / 2, pitch, (nx, ny, nz)


def _filled(crossings: NDArray[np.int32]) -> Grid:
    """Return the cells whose middles lie inside: the column has met the surface an odd number of times below them."""
    return np.asarray(np.cumsum(crossings, axis=2)[:, :, :-1] % 2 == 1)


def _sheets(mesh: TriMesh, start: FloatArray, pitch: FloatArray, shape: tuple[int, int, int]) -> Grid:
    """Return the cells between whose middle and the next one, along any axis, the surface goes in and out again."""
    found = np.zeros(shape, dtype=bool)
    for axis in range(3):
        order = [(axis + 1) % 3, (axis + 2) % 3, axis]
        turned = TriMesh(mesh.vertices[:, order], mesh.triangles)
        counts = _crossings(turned, start[order], pitch[order], (shape[order[0]], shape[order[1]], shape[order[2]]))[:, :, 1:-1]
        thin = np.zeros([shape[i] for i in order], dtype=bool)
        thin[:, :, :-1] |= counts >= 2
        thin[:, :, 1:] |= counts >= 2
        found |= np.moveaxis(thin, (0, 1, 2), order)
    return found


def _crossings(mesh: TriMesh, start: FloatArray, pitch: FloatArray, shape: tuple[int, int, int]) -> NDArray[np.int32]:
    """Return how often each column of middles along z meets the surface below its first middle, between any two, and above its last."""
    counts = np.zeros((*shape[:2], shape[2] + 1), dtype=np.int32)
    corners = (mesh.vertices[mesh.triangles] - start) / pitch - 0.5  # cell i has its middle at i
    corners[..., :2] += _ASIDE
    seen_from_above = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2]
    lows = np.maximum(np.ceil(corners[..., :2].min(axis=1)), 0).astype(int)
    highs = np.minimum(np.floor(corners[..., :2].max(axis=1)), np.array(shape[:2]) - 1).astype(int)
    met = (np.abs(seen_from_above) > 1e-12) & (highs >= lows).all(axis=1)
    for (a, b, c), low, high in zip(corners[met], lows[met], highs[met], strict=True):
        x, y = np.meshgrid(np.arange(low[0], high[0] + 1), np.arange(low[1], high[1] + 1), indexing="ij")
        det = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        u = ((x - a[0]) * (c[1] - a[1]) - (y - a[1]) * (c[0] - a[0])) / det
        v = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / det
        inside = (u >= 0) & (v >= 0) & (u + v <= 1)
        z = a[2] + u * (b[2] - a[2]) + v * (c[2] - a[2])
        cell = np.clip(np.ceil(z), 0, shape[2]).astype(int)
        np.add.at(counts, (x[inside], y[inside], cell[inside]), 1)
    return counts


def asymmetry(grid: Grid, axis: int) -> float:
    """Return what share of a shape has nothing opposite it in the plane across an axis through the middle of its box; all, where no cell is met."""
    if not grid.any():
        return 1.0
    return float((grid ^ np.flip(grid, axis)).sum()) / float(2 * grid.sum())


def tipping_angle(points: FloatArray, com: FloatArray) -> float:
    """Return how far the ground may be inclined in any direction before a body tips over [deg]; below zero when it does not stand at all.

    Args:
        points: Its corners `(n, 3)` [mm].
        com: Its centre of mass `(3,)` [mm].
    """
    ground = float(points[:, 2].min())
    feet = points[points[:, 2] < ground + FOOT_MM, :2]
    try:
        hull = ConvexHull(feet)
    except QhullError:
        return -90.0  # it stands on a point or an edge
    inside = -(hull.equations[:, :2] @ com[:2] + hull.equations[:, 2])
    return math.degrees(math.atan2(float(inside.min()), float(com[2]) - ground))
