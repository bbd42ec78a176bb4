"""The field's measures of shapes and of joints, each stated exactly: rules that differ by a word differ by a factor.

Shapes as in CADCodeVerify and the ArtiCAD paper: 1,000 points of each surface, brought into the unit cube by each shape's own box, aligned by
ICP; `dense` repeats the distances with 10,000 points. Objects at rest: 10,000 points, scaled by the diagonal of the box, aligned by ICP from each
of the 24 rotations of a cube. Sampling is random, so every score is the mean over five seeds. The floor that sampling leaves and the
score of a plain box stand beside every table, since both are nearer to a perfect score than one expects.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
from scipy.ndimage import binary_fill_holes
from scipy.optimize import linear_sum_assignment
from scipy.spatial import cKDTree

from articad.arrays import FloatArray
from articad.geometry import TriMesh, box

Scaling = Callable[[FloatArray], FloatArray]
Cloud = tuple[FloatArray, FloatArray]
"""Points of a surface and of the true one."""

POINTS: Final = 1000
DENSE: Final = 10_000
SEEDS: Final = (0, 1, 2, 3, 4)
ICP_STEPS: Final = 50
ICP_STILL: Final = 1e-3  # of the mean squared distance: no further progress
LEAST_GAIN: Final = 0.02  # of the distance of 10,000 points, by which ICP with 1,000 must lower it to be accepted
WORST: Final = math.sqrt(3)  # the diagonal of the unit cube: what a failed sample scores
VOXELS: Final = 64  # along the diagonal
SPACING: Final = 0.4  # of a voxel, between the points of a surface that is voxelised
ASIDE: Final = 1.3679  # voxels from the least coordinate to the grid's edge: flat faces do not lie on the border of two voxels
AS_NEAR: Final = 1.1  # times the least distance: ways to face that the shape alone cannot tell apart
FEWER: Final = 4
ROUGHLY: Final = 1.3  # the same with a quarter of 1,000 points
AXIS_RAD: Final = math.radians(10)  # by which the axis of a matching joint may lean
AXIS_OFF: Final = 0.05  # of the diagonal, by which it may lie beside


class ShapeScore(NamedTuple):
    """How near a shape comes to the true one.

    Attributes:
        pcd: Symmetric Chamfer distance: the mean of both directions' mean distance to the nearest point, in unit cubes.
        hd: Hausdorff distance: the largest distance to the nearest point, either way.
        iogt: Volume that both boxes share over the volume of the true one.
        pcd_dense: As `pcd`, with 10,000 points.
        hd_dense: As `hd`, with 10,000 points.
    """

    pcd: float
    hd: float
    iogt: float
    pcd_dense: float
    hd_dense: float


FAILED: Final = ShapeScore(WORST, WORST, 0.0, WORST, WORST)
"""What counts for a sample that did not come to be."""


class Distances(NamedTuple):
    """How far two sets of points are from each other: the mean of both directions' mean distance to the nearest point, and the largest."""

    mean: float
    largest: float


class Motion(NamedTuple):
    """A rigid motion of points: rotation `(3, 3)` and translation `(3,)`."""

    turn: FloatArray
    shift: FloatArray

    def apply(self, points: FloatArray) -> FloatArray:
        """Return points `(n, 3)` moved."""
        return np.asarray(points @ self.turn.T + self.shift)


def surface_points(mesh: TriMesh, count: int = POINTS, *, seed: int = 0) -> FloatArray:
    """Return points of a surface, uniform by area, `(count, 3)` [mm]."""
    rng = np.random.default_rng(seed)
    corners = mesh.vertices[mesh.triangles]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    chosen = corners[rng.choice(len(corners), count, p=areas / areas.sum())]
    u, v = rng.random((2, count, 1))
    u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
    return np.asarray(chosen[:, 0] + u * (chosen[:, 1] - chosen[:, 0]) + v * (chosen[:, 2] - chosen[:, 0]))


def shape_score(mesh: TriMesh, truth: TriMesh, *, seed: int = 0) -> ShapeScore:
    """Return how near a shape comes to the true one, regardless of its place and size, but not of its orientation.

    Boxes are those of the meshes, not of the sampled points.
    """
    a, b = _into_unit_cube(mesh), _into_unit_cube(truth)
    sparse, dense = ((a(surface_points(mesh, n, seed=seed)), b(surface_points(truth, n, seed=seed + 1))) for n in (POINTS, DENSE))
    _, motion = better(icp(*sparse), Motion(np.eye(3), np.zeros(3)), dense)
    few, many = (distances(motion.apply(points), true) for points, true in (sparse, dense))
    share = _box_share(motion.apply(a(mesh.vertices)), b(truth.vertices))
    return ShapeScore(few.mean, few.largest, share, many.mean, many.largest)


def distances(points: FloatArray, truth: FloatArray) -> Distances:
    """Return how far points `(n, 3)` and true points `(m, 3)` are from each other."""
    there, back = cKDTree(truth).query(points)[0], cKDTree(points).query(truth)[0]
    return Distances(float(there.mean() + back.mean()) / 2, float(max(there.max(), back.max())))


def floor_score(truth: TriMesh, *, seed: int = 0) -> ShapeScore:
    """Return what the true shape scores against itself: other points of the same surface."""
    return shape_score(truth, truth, seed=seed)


def box_score(truth: TriMesh, *, seed: int = 0) -> ShapeScore:
    """Return what a plain box of the true shape's size scores."""
    return shape_score(box_of(truth), truth, seed=seed)


def better(found: Motion, start: Motion, dense: Cloud) -> tuple[float, Motion]:
    """Return the motion that ICP found, if it lowers the distance of other points by at least 2 %, else that it began with; with the distance.

    ICP fits the noise of two samples, too: without this rule it moves the true shape away from itself.
    """
    before, after = (distances(motion.apply(dense[0]), dense[1]).mean for motion in (start, found))
    return (after, found) if after <= (1 - LEAST_GAIN) * before else (before, start)


def icp(points: FloatArray, truth: FloatArray, begin: FloatArray | None = None) -> Motion:
    """Return the rigid motion that brings points nearest to the true ones, by iterative closest points.

    Args:
        points: `(n, 3)`.
        truth: `(m, 3)`.
        begin: Rotation `(3, 3)` to begin with; by default points are where they are.
    """
    tree, motion, before = cKDTree(truth), Motion(np.eye(3) if begin is None else begin, np.zeros(3)), math.inf
    for _ in range(ICP_STEPS):
        apart, nearest = tree.query(motion.apply(points))
        error = float((apart**2).mean())
        if before - error <= ICP_STILL * error:
            break
        before = error
        motion = _fit(points, truth[nearest])
    return motion


def _fit(points: FloatArray, targets: FloatArray) -> Motion:
    """Return the rigid motion with the least squared distance of points to their targets (Kabsch)."""
    here, there = points.mean(axis=0), targets.mean(axis=0)
    u, _, vt = np.linalg.svd((points - here).T @ (targets - there))
    turn = vt.T @ np.diag([1, 1, np.sign(np.linalg.det(vt.T @ u.T))]) @ u.T
    return Motion(np.asarray(turn), np.asarray(there - turn @ here))


def _into_unit_cube(mesh: TriMesh) -> Scaling:
    low, high = mesh.bounds
    middle, longest = (low + high) / 2, max(float((high - low).max()), 1e-12)
    return lambda points: np.asarray((points - middle) / longest)


def _box_share(a: FloatArray, b: FloatArray) -> float:
    shared = np.minimum(a.max(axis=0), b.max(axis=0)) - np.maximum(a.min(axis=0), b.min(axis=0))
    return float(np.prod(np.maximum(shared, 0)) / np.prod(np.maximum(np.ptp(b, axis=0), 1e-12)))


@dataclass(frozen=True)
class MovingJoint:
    """A joint as articulated-object datasets know it: its type, its axis, and what it moves.

    Attributes:
        type: "revolute" or "slider"; other joints count by what they are called.
        axis: Direction in the object's frame, either way along.
        origin: A point of the axis [mm]; of no matter for sliders.
        center: Centre of the box of what it moves, at rest [mm].
    """

    type: str
    axis: tuple[float, float, float]
    origin: tuple[float, float, float]
    center: tuple[float, float, float]


class ArticulatedScore(NamedTuple):
    """How near an articulated object comes to the true one.

    The paper does not say when movable joints match; both readings are given.

    Attributes:
        rs_cd: Chamfer distance at rest, in diagonals of the true object's box: the mean of both directions' means.
        rs_iou: At rest, shared over joint volume of the voxels that the surfaces pass through or enclose, 64 to the diagonal.
        type_accuracy: Share of the true moving joints whose counterpart has the same type; NaN where nothing is to move.
        f1: Of moving joints that match by type.
        f1_axis: Of moving joints that match by type and axis: within 10°, and within 5 % of the diagonal of it where it turns.
    """

    rs_cd: float
    rs_iou: float
    type_accuracy: float
    f1: float
    f1_axis: float


FAILED_OBJECT: Final = ArticulatedScore(1.0, 0.0, 0.0, 0.0, 0.0)
"""What a failed sample scores: as far off as the object is large."""


def articulated_score(
    mesh: TriMesh, joints: Sequence[MovingJoint], truth: TriMesh, true_joints: Sequence[MovingJoint], *, seed: int = 0
) -> ArticulatedScore:
    """Return how near an articulated object comes to the true one: each scaled by its diagonal about its centre, aligned by ICP.

    The orientation of an object does not count: ICP begins with each of the 24 rotations of a cube, and of those that end as near as the
    nearest, the one counts whose joints match best. Joints are matched to those true ones whose moved parts are nearest, one to one,
    at the least total distance.
    """
    ours, theirs = _by_diagonal(mesh), _by_diagonal(truth)
    sparse, dense = ((ours(surface_points(mesh, n, seed=seed)), theirs(surface_points(truth, n, seed=seed + 1))) for n in (POINTS, DENSE))
    wanted = [_carried(joint, theirs, Motion(np.eye(3), np.zeros(3))) for joint in true_joints]
    ways = [better(icp(*sparse, begin), Motion(begin, np.zeros(3)), dense) for begin in _promising(sparse)]
    least = min(rs_cd for rs_cd, _ in ways)

    def scored(motion: Motion) -> tuple[float, float, float]:
        return _joint_scores([_carried(joint, ours, motion) for joint in joints], wanted)

    rs_cd, motion = max((way for way in ways if way[0] <= AS_NEAR * least), key=lambda way: (scored(way[1])[2], -way[0]))
    rs_iou = _shared_voxels(motion.apply(ours(_covering(mesh))), theirs(_covering(truth)))
    return ArticulatedScore(rs_cd, rs_iou, *scored(motion))


def _promising(sparse: Cloud) -> list[FloatArray]:
    """Return the rotations of a cube from which ICP with every fourth point ends about as near as from the best of them."""
    few = (sparse[0][::FEWER], sparse[1][::FEWER])
    rough = [distances(icp(*few, begin).apply(few[0]), few[1]).mean for begin in CUBE_ROTATIONS]
    return [begin for begin, far in zip(CUBE_ROTATIONS, rough, strict=True) if far <= ROUGHLY * min(rough)]


def _rotations() -> tuple[FloatArray, ...]:
    """Return the rotations that map a cube to itself: signed permutations of the axes with determinant 1."""
    rows = [
        np.eye(3)[list(order)] * np.array(signs)[:, None]
        for order in itertools.permutations(range(3))
        for signs in itertools.product((1, -1), repeat=3)
    ]
    return tuple(row for row in rows if np.linalg.det(row) > 0)


CUBE_ROTATIONS: Final = _rotations()


def joints_match(joint: MovingJoint, truth: MovingJoint) -> bool:
    """Return whether a joint is the true one; both in diagonals of their objects."""
    a, b = np.asarray(joint.axis), np.asarray(truth.axis)
    if joint.type != truth.type or abs(float(a @ b)) < math.cos(AXIS_RAD):
        return False
    off = np.asarray(joint.origin) - np.asarray(truth.origin)
    return joint.type == "slider" or float(np.linalg.norm(off - (off @ b) * b)) <= AXIS_OFF


def _joint_scores(found: Sequence[MovingJoint], wanted: Sequence[MovingJoint]) -> tuple[float, float, float]:
    """Return type accuracy, F1 by type, and F1 by type and axis."""
    if not wanted:
        nothing = 1.0 if not found else 0.0
        return float("nan"), nothing, nothing
    if not found:
        return 0.0, 0.0, 0.0
    cost = [[math.dist(joint.center, truth.center) for truth in wanted] for joint in found]
    pairs = [(found[i], wanted[j]) for i, j in zip(*linear_sum_assignment(cost), strict=True)]
    same, matching = sum(joint.type == truth.type for joint, truth in pairs), sum(joints_match(joint, truth) for joint, truth in pairs)
    total = len(found) + len(wanted)
    return same / len(wanted), 2 * same / total, 2 * matching / total


def _carried(joint: MovingJoint, scaled: Scaling, motion: Motion) -> MovingJoint:
    axis = motion.turn @ (np.asarray(joint.axis) / np.linalg.norm(joint.axis))
    origin, center = (motion.apply(scaled(np.array([point]))) for point in (joint.origin, joint.center))
    return MovingJoint(joint.type, tuple(axis), tuple(origin[0]), tuple(center[0]))


def _by_diagonal(mesh: TriMesh) -> Scaling:
    low, high = mesh.bounds
    middle, diagonal = (low + high) / 2, float(np.linalg.norm(high - low))
    return lambda points: np.asarray((points - middle) / diagonal)


def _covering(mesh: TriMesh) -> FloatArray:
    """Return points that cover a surface no farther apart than 0.4 voxels, always the same ones, `(n, 3)` [mm].

    Each triangle gets rows parallel to its longest side: with base ab, apex c and height h, row v in [0, 1] goes from a + v (c - a)
    to b + v (c - b), and rows are at most a spacing apart.
    """
    spacing = SPACING / VOXELS * max(float(np.linalg.norm(np.ptp(mesh.bounds, axis=0))), 1e-12)
    corners = mesh.vertices[mesh.triangles]
    sides = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
    first = sides.argmax(axis=1)
    row = np.arange(len(corners))
    a, b, c = (corners[row, (first + step) % 3] for step in range(3))
    base = sides[row, first]
    height = np.linalg.norm(np.cross(b - a, c - a), axis=1) / np.maximum(base, 1e-300)
    along, across = (np.ceil(length / spacing).astype(int) + 1 for length in (base, height))
    counts = along * across
    triangle = np.repeat(row, counts)
    number = np.arange(len(triangle)) - np.repeat(np.cumsum(counts) - counts, counts)
    u = (number % along[triangle] / np.maximum(along[triangle] - 1, 1))[:, None]
    v = (number // along[triangle] / np.maximum(across[triangle] - 1, 1))[:, None]
    start, end = a[triangle] + v * (c - a)[triangle], b[triangle] + v * (c - b)[triangle]
    return np.asarray(start + u * (end - start))


def _shared_voxels(a: FloatArray, b: FloatArray) -> float:
    """Return the intersection over the union of what two covered surfaces enclose, both in diagonals."""
    low = np.minimum(a.min(axis=0), b.min(axis=0)) - ASIDE / VOXELS
    shape = tuple(np.ceil((np.maximum(a.max(axis=0), b.max(axis=0)) - low) * VOXELS).astype(int) + 2)
    filled = []
    for points in (a, b):
        grid = np.zeros(shape, dtype=bool)
        grid[tuple(((points - low) * VOXELS).astype(int).T)] = True
        filled.append(binary_fill_holes(grid))
    return float((filled[0] & filled[1]).sum() / (filled[0] | filled[1]).sum())


def box_of(mesh: TriMesh) -> TriMesh:
    """Return a plain box of a shape's size."""
    low, high = mesh.bounds
    return box(*(float(side) for side in np.maximum(high - low, 1e-6)))
