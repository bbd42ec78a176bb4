"""Convex pieces lie inside the solid and reach close to its surface, for random solids; manifold3d and trimesh judge."""

from __future__ import annotations

import manifold3d
import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, cKDTree

from articad.connectors.se3 import SE3
from articad.geometry.inscribed import INSIDE_MM, MOST_PIECES, Inscribed, inscribed, missing_bound
from articad.geometry.inscribed.piece import polytope
from articad.geometry.mesh import TriMesh, merged
from articad.geometry.shapes import box, capsule, cylinder, sphere, tube

FloatArray = NDArray[np.float64]


def body_of(mesh: TriMesh) -> manifold3d.Manifold:
    body = manifold3d.Manifold(manifold3d.Mesh64(mesh.vertices.copy(), mesh.triangles.astype(np.uint64)))
    assert body.status() == manifold3d.Error.NoError
    return body


def mesh_of(body: manifold3d.Manifold) -> TriMesh:
    found = body.to_mesh64()
    return TriMesh(np.array(found.vert_properties[:, :3]), np.array(found.tri_verts, dtype=np.int32))


def placed(found: Inscribed) -> list[TriMesh]:
    return [piece.mesh.transformed(piece.frame) for piece in found.pieces]


def assert_inside(found: Inscribed, solid: TriMesh, epsilon: float = INSIDE_MM) -> None:
    """No corner of a piece is outside by more than epsilon, and no volume is, as manifold3d's boolean has it."""
    body = body_of(solid)
    for mesh in placed(found):
        outside = body_of(mesh) - body
        assert outside.volume() <= epsilon * outside.surface_area() / 2 + 1e-9 * mesh.volume
        assert mesh.is_closed
        assert body_of(mesh).hull().volume() == pytest.approx(mesh.volume, rel=1e-6)  # convex


def random_solid(rng: np.random.Generator) -> TriMesh:
    """A slab, a disc or a frame with bosses, bores, slots and pockets, somewhere in space."""
    size = rng.uniform(5, 300)
    base = rng.integers(3)
    if base == 0:
        body = manifold3d.Manifold.cube(tuple(size * rng.uniform(0.1, 1, 3)), center=True)
    elif base == 1:
        body = manifold3d.Manifold.cylinder(
            size * rng.uniform(0.1, 1), size / 2, size / 2 * rng.uniform(0.3, 1), int(rng.integers(24, 96)), center=True
        )
    else:
        outer, wall = size * rng.uniform(0.4, 1, 3), size * rng.uniform(0.02, 0.1)
        body = manifold3d.Manifold.cube(tuple(outer), center=True) - manifold3d.Manifold.cube(
            tuple(outer - 2 * wall), center=True
        ).translate((0, 0, wall * 1.5))
    low, high = np.array(body.bounding_box()[:3]), np.array(body.bounding_box()[3:])
    for _ in range(int(rng.integers(0, 5))):
        where = tuple(rng.uniform(low, high))
        form = rng.integers(3)
        r = size * rng.uniform(0.02, 0.15)
        if form == 0:
            tool = manifold3d.Manifold.cylinder(3 * size, r, r, int(rng.integers(16, 64)), center=True)
        elif form == 1:
            tool = manifold3d.Manifold.sphere(r, 32)
        else:
            tool = manifold3d.Manifold.cube(tuple(size * rng.uniform(0.05, 0.3, 3)), center=True)
        tool = tool.rotate(tuple(90.0 * rng.integers(0, 3, 3)) if rng.random() < 0.6 else tuple(rng.uniform(0, 360, 3))).translate(where)
        body = body - tool if rng.random() < 0.7 else body + (tool ^ manifold3d.Manifold.cube(tuple(1.2 * (high - low)), center=True))
    largest = max(body.decompose(), key=lambda piece: float(piece.volume()))
    T = SE3.from_axis_angle(rng.normal(size=3), rng.uniform(0, 3)) if rng.random() < 0.5 else SE3.identity()
    return mesh_of(largest).transformed(SE3.from_translation(rng.uniform(-200, 200, 3)) @ T)


@pytest.mark.parametrize("seed", range(12))
def test_pieces_of_a_random_solid_lie_inside_it(seed: int) -> None:
    solid = random_solid(np.random.default_rng(seed))
    found = inscribed(solid)

    assert found is not None
    assert 1 <= len(found.pieces) <= MOST_PIECES
    assert_inside(found, solid)


@pytest.mark.soak
@pytest.mark.parametrize("seed", range(100, 300))
def test_pieces_of_many_random_solids_lie_inside_them(seed: int) -> None:
    solid = random_solid(np.random.default_rng(seed))
    found = inscribed(solid)
    if found is not None:
        assert_inside(found, solid)


def damaged_solid(rng: np.random.Generator) -> TriMesh:
    """A solid as other programs leave them: with slivers, cracks, repeated, crossing, hollow or reversed shells, rounded coordinates."""
    mesh = random_solid(rng)
    size = float(np.linalg.norm(mesh.bounds[1] - mesh.bounds[0]))
    for damage in rng.choice(7, size=int(rng.integers(1, 4)), replace=False):
        middle = SE3.from_translation(mesh.vertices[rng.integers(len(mesh.vertices))])
        other = box(*(size * rng.uniform(0.05, 0.5, 3))).transformed(middle)
        if damage == 0:  # a shell that crosses the others
            mesh = merged([mesh, other])
        elif damage == 1:  # a shell that takes its matter away, wherever it is
            mesh = merged([mesh, other.flipped()])
        elif damage == 2:  # everything twice
            mesh = merged([mesh, mesh])
        elif damage == 3:  # edges cut at points that lie on them: triangles without area
            mesh = with_slivers(mesh, rng)
        elif damage == 4:  # coordinates of few digits
            mesh = TriMesh(np.round(mesh.vertices, int(rng.integers(0, 4))), mesh.triangles)
        elif damage == 5:  # of single precision, far from the origin
            mesh = TriMesh((mesh.vertices + 1e4).astype(np.float32).astype(np.float64), mesh.triangles)
        else:  # nearly flat
            mesh = TriMesh(mesh.vertices * np.array([1, 1, 10.0 ** -rng.integers(2, 7)]), mesh.triangles)
    return mesh


def with_slivers(mesh: TriMesh, rng: np.random.Generator) -> TriMesh:
    """Put a vertex into an edge of some triangles and close the crack with a triangle that has no area."""
    vertices, triangles = list(mesh.vertices), [list(row) for row in mesh.triangles]
    for index in rng.choice(len(triangles), size=min(8, len(triangles)), replace=False):
        a, b, c = triangles[index]
        vertices.append(vertices[a] + rng.uniform(0.001, 0.999) * (vertices[b] - vertices[a]))
        new = len(vertices) - 1
        triangles[index] = [a, new, c]
        triangles += [[new, b, c], [a, b, new]]
    return TriMesh(np.array(vertices), np.array(triangles, dtype=np.int32))


def crossings(points: FloatArray, mesh: TriMesh, way: FloatArray) -> NDArray[np.intp]:
    """Count how often rays from points leave the surface, less how often they enter it: at least 1 inside (Moeller and Trumbore 1997)."""
    a, b, c = np.moveaxis(mesh.vertices[mesh.triangles], 1, 0)
    ab, ac = b - a, c - a
    h = np.cross(way, ac)
    det = (ab * h).sum(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        from_a = points[:, None] - a
        u = (from_a * h).sum(axis=2) / det
        q = np.cross(from_a, ab)
        v = q @ way / det
        t = (q * ac).sum(axis=2) / det
        hit = (u > 0) & (v > 0) & (u + v < 1) & (t > 0)
    return np.asarray((hit * -np.sign(det).astype(int)).sum(axis=1))


def assert_enclosed(found: Inscribed, solid: TriMesh) -> None:
    """Points inside the pieces, somewhat away from their surface, are inside the solid, as most of three rays have it."""
    rng = np.random.default_rng(0)
    for mesh in placed(found):
        if not mesh.volume > 0 or float(np.ptp(mesh.vertices, axis=0).min()) < 20 * INSIDE_MM:
            continue
        corners, middle = mesh.vertices[mesh.triangles], mesh.vertices.mean(axis=0)
        drawn = corners[rng.integers(len(corners), size=40)]
        surface = (drawn * rng.dirichlet((1, 1, 1), 40)[:, :, None]).sum(axis=1)
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-300)[:, None]
        points = middle + rng.uniform(0.05, 0.98, (40, 1)) * (surface - middle)
        deep = ((points[:, None] - corners[None, :, 0]) * normals[None]).sum(axis=2).max(axis=1) < -2 * INSIDE_MM
        counts = np.sort([crossings(points[deep], solid, way) for way in rng.normal(size=(3, 3))], axis=0)[1]
        assert (counts >= 1).all(), (mesh.volume, points[deep][counts < 1][:3])


@pytest.mark.parametrize("seed", range(40))
def test_pieces_of_a_damaged_solid_lie_where_its_surface_encloses_matter(seed: int) -> None:
    solid = damaged_solid(np.random.default_rng(seed))
    found = inscribed(solid)
    if found is not None:
        assert_enclosed(found, solid)


@pytest.mark.soak
@pytest.mark.parametrize("seed", range(1000, 2000))
def test_pieces_of_many_damaged_solids_lie_where_their_surfaces_enclose_matter(seed: int) -> None:
    solid = damaged_solid(np.random.default_rng(seed))
    found = inscribed(solid)
    if found is not None:
        assert_enclosed(found, solid)


def test_triangles_without_area_cost_no_pieces() -> None:
    whole = random_solid(np.random.default_rng(3))
    found, plain = inscribed(with_slivers(whole, np.random.default_rng(0))), inscribed(whole)

    assert found is not None
    assert plain is not None
    assert found.missing == pytest.approx(plain.missing, abs=0.5 * plain.bound)


@pytest.mark.parametrize("seed", range(4))
def test_what_is_missing_is_what_an_independent_measurement_finds(seed: int) -> None:
    """trimesh samples the solid's surface and the pieces: the farthest sample is about as far as is stated."""
    solid = random_solid(np.random.default_rng(seed))
    found = inscribed(solid)
    assert found is not None
    size = float(np.linalg.norm(solid.bounds[1] - solid.bounds[0]))
    surface, _ = trimesh.sample.sample_surface(trimesh.Trimesh(solid.vertices, solid.triangles), 3000, seed=1)
    together = [trimesh.sample.sample_surface(trimesh.Trimesh(mesh.vertices, mesh.triangles), 20_000, seed=1)[0] for mesh in placed(found)]
    inside = np.array([max(trimesh.Trimesh(mesh.vertices, mesh.triangles).area for mesh in placed(found))])
    spacing = 3 * float(np.sqrt(inside[0] / 20_000))
    far, _ = cKDTree(np.concatenate(together)).query(surface)

    assert found.missing <= missing_bound(solid) * 3
    assert float(far.max()) <= found.missing + spacing + 0.02 * size


def test_a_box_is_one_box_wherever_it_stands() -> None:
    T = SE3.from_axis_angle((1, 2, 3), 0.7) @ SE3.from_translation((5, -3, 8))
    found = inscribed(box(10, 20, 30).transformed(T))

    assert found is not None
    (piece,) = found.pieces
    assert piece.primitive is not None
    assert piece.primitive.kind == "box"
    assert sorted(piece.primitive.size) == pytest.approx([10, 20, 30], abs=1e-4)
    assert found.missing < 1e-4
    assert_inside(found, box(10, 20, 30).transformed(T))


def test_a_plate_keeps_its_axes_and_whole_sides() -> None:
    found = inscribed(box(10, 20, 30))

    assert found is not None
    assert found.pieces[0].primitive is not None
    assert found.pieces[0].primitive.size == (10.0, 20.0, 30.0)
    assert found.pieces[0].frame.allclose(SE3.identity(), mm=0.0, rad=0.0)


@pytest.mark.parametrize("phase", [0.0, 0.3])
def test_a_cylinder_and_a_ball_are_recognised(phase: float) -> None:
    pin, ball = cylinder(4, 30, 64, phase=phase), sphere(8, 64)
    T = SE3.from_axis_angle((1, 0, 1), 1.1)
    turned, round_ = inscribed(pin.transformed(T), deflection=0.01), inscribed(ball, deflection=0.05)

    assert turned is not None
    assert round_ is not None
    (a,), (b,) = turned.pieces, round_.pieces
    assert (a.primitive and a.primitive.kind, b.primitive and b.primitive.kind) == ("cylinder", "sphere")
    assert a.primitive is not None
    assert a.primitive.size == pytest.approx((4, 30), abs=1e-4)
    assert abs(a.frame.z_axis @ T.rotation[:, 2]) == pytest.approx(1)


def test_a_long_bar_that_is_nearly_a_box_is_not_replaced_by_one() -> None:
    """10 m long, with one corner 9 µm inside the box: that is 9e-7 of the length, but 90 times what a piece may be outside."""
    bar = box(10_000, 100, 100)
    corner = int(np.argmax(bar.vertices.sum(axis=1)))
    vertices = bar.vertices.copy()
    vertices[corner, 0] -= 9e-3
    found = inscribed(TriMesh(vertices, bar.triangles))

    assert found is not None
    hull = manifold3d.Manifold.hull_points(vertices)
    planes = ConvexHull(mesh_of(hull).vertices).equations
    for mesh in placed(found):
        assert float((mesh.vertices @ planes[:, :3].T + planes[:, 3]).max()) <= INSIDE_MM


def test_a_long_prism_is_no_cylinder_unless_its_deflection_says_so() -> None:
    """The cylinder through the corners of a prism of 200 sides is outside it by r (1 - cos(pi / 200)): 0.012 mm, at a length of 10 m."""
    prism = cylinder(100, 10_000, 200)
    exact, rough = inscribed(prism), inscribed(prism, deflection=1.0)

    assert exact is not None
    assert rough is not None
    assert [piece.primitive and piece.primitive.kind for piece in rough.pieces] == ["cylinder"]
    apothem = 100 * np.cos(np.pi / 200)
    sides = np.arange(200) * 2 * np.pi / 200 + np.pi / 200
    normals = np.stack([np.cos(sides), np.sin(sides), np.zeros(200)], axis=1)
    for mesh in placed(exact):
        assert float((mesh.vertices @ normals.T).max()) - apothem <= INSIDE_MM


def test_the_distance_from_a_piece_is_no_less_where_planes_tie() -> None:
    """Of planes whose heights differ by less than rounding, one below the point must not hide one that it is above."""
    cube = polytope(
        np.array([[1, 0, 0, 1], [-1, 0, 0, 1], [0, 1, 0, 1], [0, -1, 0, 1], [0, 0, 1, 1], [0, 0, -1, 1]], dtype=float), np.zeros(3)
    )
    assert cube is not None
    points = np.array([[1 + 5e-4, 1 - 2e-4, 0], [1 - 2e-4, 1 + 5e-4, 0], [0, 1 + 5e-4, 1 - 1e-4], [1 + 3e-4, 1 + 4e-4, 0]])
    assert cube.distance(points) == pytest.approx([5e-4, 5e-4, 5e-4, 5e-4])


def test_a_bore_is_never_entered() -> None:
    """Corners and faces of the pieces of a tube keep out of the bore, as its facets have it."""
    r, n = 20.0, 64
    found = inscribed(tube(r, 30, 10, n))

    assert found is not None
    assert len(found.pieces) <= 16
    for mesh in placed(found):
        points, _ = trimesh.sample.sample_surface(trimesh.Trimesh(mesh.vertices, mesh.triangles), 2000, seed=0)
        assert float(np.linalg.norm(points[:, :2], axis=1).min()) >= r * np.cos(np.pi / n) - INSIDE_MM


def test_a_capsule_is_covered_from_inside() -> None:
    solid = capsule(5, 20, 48)
    found = inscribed(solid)

    assert found is not None
    assert_inside(found, solid)
    assert found.missing <= found.bound


def test_what_encloses_nothing_has_no_pieces() -> None:
    open_ = TriMesh(box(1, 1, 1).vertices, box(1, 1, 1).triangles[:-1])

    assert inscribed(open_) is None
    assert inscribed(box(1, 1, 1).flipped()) is None


def test_pieces_come_out_the_same_twice() -> None:
    solid = random_solid(np.random.default_rng(3))
    first, again = inscribed(solid), inscribed(solid)

    assert first is not None
    assert again is not None
    assert [piece.mesh.digest for piece in first.pieces] == [piece.mesh.digest for piece in again.pieces]


def test_a_capsule_is_a_cylinder_and_two_balls_and_a_prism_is_one_piece() -> None:
    """Neither needs a primitive of its own: URDF and SDF have no prisms, and URDF has no capsules."""
    round_ = capsule(5, 20, 48)
    heights = round_.vertices[round_.triangles].mean(axis=1)[:, 2]
    face = np.where(heights < -10, 0, np.where(heights > 10, 2, 1)).astype(np.int32)  # as a B-rep has them
    found = inscribed(TriMesh(round_.vertices, round_.triangles, face), deflection=0.05)
    prism = inscribed(cylinder(10, 30, 6))

    assert found is not None
    assert sorted(piece.primitive.kind for piece in found.pieces if piece.primitive) == ["cylinder", "sphere", "sphere"]
    assert found.missing < 0.05
    assert prism is not None
    assert len(prism.pieces) == 1
    assert prism.less < 1e-6
