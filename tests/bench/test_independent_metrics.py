"""The field's measures against an implementation that shares no code: trimesh samples, aligns and voxelises; distances are taken pair by pair."""

from __future__ import annotations

import statistics
from collections.abc import Callable

import numpy as np
import pytest
import trimesh
from scipy.spatial.distance import cdist
from scipy.spatial.transform import Rotation

from articad.arrays import FloatArray
from articad.connectors import SE3
from articad.geometry import TriMesh, box, cylinder, merged, tube
from articad_bench.metrics import DENSE, POINTS, SEEDS, articulated_score, shape_score

NUMBER = 20
QUICK = 1  # the pair that is also compared in the quick tests, with fewer seeds
SIZES = (8.0, 40.0)  # mm


def pair(seed: int) -> tuple[TriMesh, TriMesh]:
    """Return a random shape of boxes, pins and bushes, and one that departs from it a little: other dimensions, one body more, or turned."""
    rng = np.random.default_rng(seed)

    def body() -> TriMesh:
        x, y, z = (float(side) for side in rng.uniform(*SIZES, 3))
        one = [box(x, y, z), cylinder(x / 3, y), tube(x / 4, x / 2, z)][int(rng.integers(3))]
        return one.transformed(SE3.from_translation(rng.uniform(-20, 20, 3)))

    bodies = [body() for _ in range(int(rng.integers(1, 4)))]
    truth = merged(bodies)
    stretched = TriMesh(truth.vertices * rng.uniform(0.85, 1.15, 3), truth.triangles)
    ours = merged([stretched, body()]) if seed % 3 == 0 else stretched
    return ours.transformed(SE3.from_axis_angle(rng.normal(size=3), float(rng.uniform(0, 0.15)))), truth


def sampled(mesh: TriMesh, count: int, seed: int) -> FloatArray:
    points, _ = trimesh.sample.sample_surface(trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False), count, seed=seed)
    return np.asarray(points)


def pairwise(a: FloatArray, b: FloatArray) -> tuple[float, float]:
    """Return the mean of both directions' means and the largest of the least distances, block by block."""
    there, back = [], np.full(len(b), np.inf)
    for block in np.array_split(a, max(len(a) // 500, 1)):
        apart = cdist(block, b)
        there.append(apart.min(axis=1))
        np.minimum(back, apart.min(axis=0), out=back)
    least = np.concatenate(there)
    return float(least.mean() + back.mean()) / 2, float(max(least.max(), back.max()))


def unit(mesh: TriMesh, length: Callable[[FloatArray], float]) -> TriMesh:
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    return TriMesh((mesh.vertices - (low + high) / 2) / length(high - low), mesh.triangles)


def fitted(ours: TriMesh, truth: TriMesh, starts: list[FloatArray], seed: int) -> FloatArray:
    """Return the 4x4 motion, of those that begin as told with or without ICP, that brings the dense points nearest."""
    sparse, dense = ((sampled(ours, n, 100 + seed), sampled(truth, n, 200 + seed)) for n in (POINTS, DENSE))
    found = []
    for start in starts:
        begin = np.eye(4)
        begin[:3, :3] = start
        end, _, _ = trimesh.registration.icp(*sparse, initial=begin, threshold=1e-7, max_iterations=60, reflection=False, scale=False)
        found += [begin, np.asarray(end)]
    rough = [pairwise(trimesh.transform_points(sparse[0], motion), sparse[1])[0] for motion in found]
    near = [motion for motion, far in zip(found, rough, strict=True) if far <= 1.05 * min(rough)]
    return min(near, key=lambda motion: pairwise(trimesh.transform_points(dense[0], motion), dense[1])[0])


def independent_shape(ours: TriMesh, truth: TriMesh, seed: int) -> dict[str, float]:
    a, b = unit(ours, np.max), unit(truth, np.max)
    motion = fitted(a, b, [np.eye(3)], seed)
    pcd, hd = pairwise(trimesh.transform_points(sampled(a, POINTS, 300 + seed), motion), sampled(b, POINTS, 400 + seed))
    first, second = trimesh.transform_points(a.vertices, motion), b.vertices
    shared = np.clip(np.minimum(first.max(0), second.max(0)) - np.maximum(first.min(0), second.min(0)), 0, None).prod()
    return {"pcd": pcd, "hd": hd, "iogt": float(shared / np.ptp(second, axis=0).prod())}


def independent_object(ours: TriMesh, truth: TriMesh, seed: int) -> dict[str, float]:
    a, b = unit(ours, lambda side: float(np.linalg.norm(side))), unit(truth, lambda side: float(np.linalg.norm(side)))
    motion = fitted(a, b, list(Rotation.create_group("O").as_matrix()), seed)
    rs_cd, _ = pairwise(trimesh.transform_points(sampled(a, DENSE, 300 + seed), motion), sampled(b, DENSE, 400 + seed))
    grids = [
        {
            tuple(row)
            for row in trimesh.Trimesh(points, mesh.triangles, process=False)
            .voxelized(1 / 64)
            .fill()
            .points.__mul__(64)
            .round()
            .astype(int)
        }
        for points, mesh in ((trimesh.transform_points(a.vertices, motion), a), (b.vertices, b))
    ]
    return {"rs_cd": rs_cd, "rs_iou": len(grids[0] & grids[1]) / len(grids[0] | grids[1])}


def agree(ours: list[dict[str, float]], theirs: list[dict[str, float]], *, least: dict[str, float]) -> None:
    """The means over the seeds differ by at most twice the larger standard deviation over the seeds, or by `least`."""
    for name in theirs[0]:
        first, second = ([row[name] for row in rows] for rows in (ours, theirs))
        spread = max(statistics.stdev(first), statistics.stdev(second), least[name] / 2)
        assert abs(statistics.fmean(first) - statistics.fmean(second)) <= 2 * spread, (name, first, second)


@pytest.mark.parametrize("number", [pytest.param(n, marks=() if n == QUICK else pytest.mark.soak) for n in range(NUMBER)])
def test_shapes_score_as_an_independent_implementation_says(number: int) -> None:
    ours, truth = pair(number)
    seeds = SEEDS[:2] if number == QUICK else SEEDS

    mine = [shape_score(ours, truth, seed=2 * seed)._asdict() for seed in seeds]
    agree(mine, [independent_shape(ours, truth, seed) for seed in seeds], least={"pcd": 1e-3, "hd": 2e-3, "iogt": 5e-3})


@pytest.mark.soak
@pytest.mark.parametrize("number", range(NUMBER))
def test_objects_score_as_an_independent_implementation_says(number: int) -> None:
    ours, truth = pair(100 + number)
    turned = ours.transformed(SE3.from_rotation(Rotation.create_group("O").as_matrix()[number]))

    mine = [articulated_score(turned, [], truth, [], seed=2 * seed)._asdict() for seed in SEEDS[:3]]
    agree(mine, [independent_object(turned, truth, seed) for seed in SEEDS[:3]], least={"rs_cd": 5e-4, "rs_iou": 0.02})
