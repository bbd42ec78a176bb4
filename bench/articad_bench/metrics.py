"""The field's measures of shapes and of joints, each stated exactly: rules that differ by a word differ by a factor.

Shapes as in CADCodeVerify: 1,000 points of each surface, aligned by ICP, brought into the unit cube by the true shape's box; the
floor that sampling leaves and the score of a plain box stand beside every table, since both are nearer to 1 than one expects.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.ndimage import binary_fill_holes
from scipy.optimize import linear_sum_assignment
from scipy.spatial import cKDTree

from articad.arrays import FloatArray
from articad.geometry import TriMesh, box

Scaling = Callable[[FloatArray], FloatArray]

POINTS: Final = 1000
ICP_STEPS: Final = 50
ICP_STILL: Final = 1e-9  # of the box diagonal: no further progress
WORST: Final = math.sqrt(3)  # the diagonal of the unit cube: what a failed sample scores
VOXELS: Final = 64  # along the diagonal
VOXEL_POINTS: Final = 200_000  # of the surface: forty for each voxel that a cube's surface passes through
AS_NEAR: Final = 1.1  # times the least distance: ways to face that the shape alone cannot tell apart
AXIS_RAD: Final = math.radians(10)  # by which the axis of a matching joint may lean
AXIS_OFF: Final = 0.05  # of the diagonal, by which it may lie beside


@dataclass(frozen=True)
class ShapeScore:
    """How near a shape comes to the true one.

    Attributes:
        pcd: Symmetric Chamfer distance: the mean of both directions' mean distance to the nearest point, in unit cubes.
        hd: Hausdorff distance: the largest distance to the nearest point, either way.
        iogt: Volume that both boxes share over the volume of the true one.
    """

    pcd: float
    hd: float
    iogt: float


FAILED: Final = ShapeScore(WORST, WORST, 0.0)
"""What counts for a sample that did not come to be."""


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
    """Return how near a shape comes to the true one, regardless of its place and size, but not of its orientation."""
    return point_score(surface_points(mesh, seed=seed), surface_points(truth, seed=seed + 1))


def point_score(points: FloatArray, truth: FloatArray) -> ShapeScore:
    """Return the same for points of surfaces, `(n, 3)` and `(m, 3)`."""
    a, b = _into_unit_cube(points), _into_unit_cube(truth)
    turn, shift = icp(a, b)
    a = a @ turn.T + shift
    there, back = cKDTree(b).query(a)[0], cKDTree(a).query(b)[0]
    return ShapeScore(float(there.mean() + back.mean()) / 2, float(max(there.max(), back.max())), _box_share(a, b))


def floor_score(truth: TriMesh, *, seed: int = 0) -> ShapeScore:
    """Return what the true shape scores against itself: other points of the same surface."""
    return shape_score(truth, truth, seed=seed)


def box_score(truth: TriMesh, *, seed: int = 0) -> ShapeScore:
    """Return what a plain box of the true shape's size scores."""
    return shape_score(box_of(truth), truth, seed=seed)


def icp(points: FloatArray, truth: FloatArray, begin: FloatArray | None = None) -> tuple[FloatArray, FloatArray]:
    """Return rotation `(3, 3)` and translation `(3,)` that bring points nearest to the true ones (ICP).

    Args:
        points: `(n, 3)`.
        truth: `(m, 3)`.
        begin: Rotation `(3, 3)` to begin with; by default points are where they are.
    """
    tree, turn, shift, before = cKDTree(truth), np.eye(3) if begin is None else begin, np.zeros(3), math.inf
    scale = float(np.linalg.norm(np.ptp(truth, axis=0))) or 1.0
    for _ in range(ICP_STEPS):
        distances, nearest = tree.query(points @ turn.T + shift)
        error = float((distances**2).mean())
        if before - error < ICP_STILL * scale * scale:
            break
        before = error
        turn, shift = _fit(points, truth[nearest])
    return turn, shift


def _fit(points: FloatArray, targets: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the rigid motion with the least squared distance of points to their targets (Kabsch)."""
    here, there = points.mean(axis=0), targets.mean(axis=0)
    u, _, vt = np.linalg.svd((points - here).T @ (targets - there))
    turn = vt.T @ np.diag([1, 1, np.sign(np.linalg.det(vt.T @ u.T))]) @ u.T
    return np.asarray(turn), np.asarray(there - turn @ here)


def _into_unit_cube(points: FloatArray) -> FloatArray:
    low, high = points.min(axis=0), points.max(axis=0)
    return np.asarray((points - (low + high) / 2) / max(float((high - low).max()), 1e-12))


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


@dataclass(frozen=True)
class ArticulatedScore:
    """How near an articulated object comes to the true one.

    Attributes:
        rs_cd: Chamfer distance at rest, in diagonals of the true object's box: the mean of both directions' means.
        rs_iou: At rest, shared over joint volume of the voxels that the surfaces pass through or enclose, 64 to the diagonal.
        type_accuracy: Share of the true moving joints whose counterpart has the same type; NaN where nothing is to move.
        f1: Of moving joints that match: same type, axis within 10°, and within 5 % of the diagonal of it where it turns.
    """

    rs_cd: float
    rs_iou: float
    type_accuracy: float
    f1: float


FAILED_OBJECT: Final = ArticulatedScore(1.0, 0.0, 0.0, 0.0)
"""What a failed sample scores: as far off as the object is large."""


def articulated_score(
    mesh: TriMesh, joints: Sequence[MovingJoint], truth: TriMesh, true_joints: Sequence[MovingJoint], *, seed: int = 0
) -> ArticulatedScore:
    """Return how near an articulated object comes to the true one: each scaled by its diagonal about its centre, aligned by ICP.

    The orientation of an object does not count: ICP begins with each quarter turn about Z, and of those that end as near as the
    nearest, the one counts whose joints match best. Joints are matched to those true ones whose moved parts are nearest, one to one,
    at the least total distance.
    """
    ours, theirs = _by_diagonal(mesh), _by_diagonal(truth)
    a, b = ours(surface_points(mesh, seed=seed)), theirs(surface_points(truth, seed=seed + 1))
    wanted = [_carried(joint, theirs, np.eye(3), np.zeros(3)) for joint in true_joints]
    ways = [_aligned(a, b, quarter) for quarter in range(4)]
    near = AS_NEAR * min(rs_cd for rs_cd, _, _ in ways)

    def scored(way: tuple[float, FloatArray, FloatArray]) -> tuple[float, float]:
        return _joint_scores([_carried(joint, ours, *way[1:]) for joint in joints], wanted)

    rs_cd, turn, shift = max((way for way in ways if way[0] <= near), key=lambda way: (scored(way)[1], -way[0]))
    accuracy, f1 = scored((rs_cd, turn, shift))
    dense = ours(surface_points(mesh, VOXEL_POINTS, seed=seed)) @ turn.T + shift
    return ArticulatedScore(
        rs_cd=rs_cd,
        rs_iou=_shared_voxels(dense, theirs(surface_points(truth, VOXEL_POINTS, seed=seed + 1))),
        type_accuracy=accuracy,
        f1=f1,
    )


def _aligned(points: FloatArray, truth: FloatArray, quarter: int) -> tuple[float, FloatArray, FloatArray]:
    """Return the Chamfer distance, rotation and translation where ICP ends that begins with so many quarter turns about Z."""
    cos, sin = ((1, 0), (0, 1), (-1, 0), (0, -1))[quarter]
    turn, shift = icp(points, truth, np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]]))
    moved = points @ turn.T + shift
    there, back = cKDTree(truth).query(moved)[0], cKDTree(moved).query(truth)[0]
    return float(there.mean() + back.mean()) / 2, turn, shift


def joints_match(joint: MovingJoint, truth: MovingJoint) -> bool:
    """Return whether a joint is the true one; both in diagonals of their objects."""
    a, b = np.asarray(joint.axis), np.asarray(truth.axis)
    if joint.type != truth.type or abs(float(a @ b)) < math.cos(AXIS_RAD):
        return False
    off = np.asarray(joint.origin) - np.asarray(truth.origin)
    return joint.type == "slider" or float(np.linalg.norm(off - (off @ b) * b)) <= AXIS_OFF


def _joint_scores(found: Sequence[MovingJoint], wanted: Sequence[MovingJoint]) -> tuple[float, float]:
    if not wanted:
        return float("nan"), 1.0 if not found else 0.0
    if not found:
        return 0.0, 0.0
    cost = [[math.dist(joint.center, truth.center) for truth in wanted] for joint in found]
    pairs = [(found[i], wanted[j]) for i, j in zip(*linear_sum_assignment(cost), strict=True)]
    matches = sum(joints_match(joint, truth) for joint, truth in pairs)
    return sum(joint.type == truth.type for joint, truth in pairs) / len(wanted), 2 * matches / (len(found) + len(wanted))


def _carried(joint: MovingJoint, scaled: Scaling, turn: FloatArray, shift: FloatArray) -> MovingJoint:
    axis = turn @ (np.asarray(joint.axis) / np.linalg.norm(joint.axis))
    origin, center = (scaled(np.array([point])) @ turn.T + shift for point in (joint.origin, joint.center))
    return MovingJoint(joint.type, tuple(axis), tuple(origin[0]), tuple(center[0]))


def _by_diagonal(mesh: TriMesh) -> Scaling:
    low, high = mesh.bounds
    middle, diagonal = (low + high) / 2, float(np.linalg.norm(high - low))
    return lambda points: np.asarray((points - middle) / diagonal)


def _shared_voxels(a: FloatArray, b: FloatArray) -> float:
    """Return the intersection over the union of what two dense clouds of surface points enclose, both in diagonals."""
    low = np.minimum(a.min(axis=0), b.min(axis=0)) - 1 / VOXELS
    shape = tuple(np.ceil((np.maximum(a.max(axis=0), b.max(axis=0)) - low) * VOXELS).astype(int) + 1)
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
