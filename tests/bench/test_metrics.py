"""Measures with known answers: equal, shifted, scaled, wrong joints; a box that flatters itself; agreement as published."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from articad.connectors import SE3
from articad.geometry import TriMesh, box, cylinder, merged, tube
from articad_bench import metrics
from articad_bench.agreement import bootstrap_interval, icc_2k, krippendorff_alpha
from articad_bench.metrics import (
    FAILED,
    Motion,
    MovingJoint,
    articulated_score,
    better,
    box_score,
    distances,
    floor_score,
    icp,
    joints_match,
    shape_score,
    surface_points,
)

CUBE = box(10, 10, 10)
GRID = np.stack(np.meshgrid(*[np.linspace(0, 1, 6)] * 3), axis=-1).reshape(-1, 3)


def moved(mesh: TriMesh, x: float) -> TriMesh:
    return mesh.transformed(SE3.from_translation(np.array([x, 0.0, 0.0])))


def test_equal_points_are_no_distance_apart() -> None:
    assert distances(GRID, GRID) == (0, 0)


def test_place_and_size_of_a_shape_do_not_count() -> None:
    ring = tube(15, 20, 30)

    assert shape_score(moved(ring.scaled(25), 1000), ring) == pytest.approx(floor_score(ring), abs=1e-9)


def test_chamfer_and_hausdorff_of_a_point_that_is_missing() -> None:
    truth = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1], [0.5, 0.5, 0.5]])

    found = distances(truth[:5], truth)

    far = math.sqrt(0.75)  # from the middle of the cube to its corners: the missing point's nearest
    assert found.largest == pytest.approx(far)
    assert found.mean == pytest.approx((0 + far / 6) / 2)


def test_box_overlap_is_over_the_true_box_and_that_of_the_meshes() -> None:
    assert shape_score(box(10, 10, 5), box(10, 10, 10)).iogt == pytest.approx(0.5, abs=0.02)
    assert shape_score(box(10, 10, 10), box(10, 10, 5)).iogt == pytest.approx(1, abs=0.02)
    assert floor_score(tube(15, 20, 30)).iogt == 1  # to the last digit: no point of a sample has a say in it


def test_a_failed_sample_scores_the_diagonal_of_the_unit_cube() -> None:
    assert (*[math.sqrt(3)] * 2, 0, *[math.sqrt(3)] * 2) == FAILED


def test_sampling_leaves_a_floor_and_a_plain_box_comes_near_it() -> None:
    ring = tube(15, 20, 30)
    floor, plain = floor_score(ring), box_score(ring)

    assert 0.01 < floor.pcd < 0.04
    assert floor.pcd_dense < 0.012
    assert floor.pcd < plain.pcd < 0.12  # what the score of a box is that looks nothing like a ring
    assert plain.iogt > 0.95


def test_points_of_a_surface_are_uniform_by_area() -> None:
    points = surface_points(box(10, 10, 40), 20_000)
    on_ends = np.isclose(np.abs(points[:, 2]), 20).mean()

    assert on_ends == pytest.approx(200 / 1800, abs=0.01)
    assert np.abs(points).max(axis=0) == pytest.approx((5, 5, 20))


def test_icp_undoes_a_small_motion() -> None:
    points = surface_points(merged([cylinder(5, 40), moved(box(4, 8, 10), 12)]))
    motion = SE3.from_axis_angle(np.array([0.3, 0.5, 0.8]), 0.12)
    found = icp(motion.apply(points) + 0.4, points)

    assert found.apply(motion.apply(points) + 0.4) == pytest.approx(points, abs=1e-6)


def test_icp_is_accepted_only_where_it_brings_other_points_nearer() -> None:
    dense = [surface_points(CUBE, metrics.DENSE, seed=seed) for seed in (1, 2)]
    still, aside = Motion(np.eye(3), np.zeros(3)), Motion(np.eye(3), np.full(3, 1e-3))

    assert better(aside, still, (dense[0], dense[1]))[1] is still
    assert better(still, Motion(np.eye(3), np.full(3, 2.0)), (dense[0], dense[1]))[1] is still


HINGE = MovingJoint("revolute", (0, 0, 1), (5, 5, 0), (6, 0, 0))
SLIDE = MovingJoint("slider", (1, 0, 0), (0, 0, 0), (-6, 0, 0))


def test_the_true_object_scores_the_floor_and_all_its_joints() -> None:
    score = articulated_score(CUBE, [SLIDE, HINGE], CUBE, [HINGE, SLIDE])

    assert score.rs_cd < 0.008
    assert score[1:] == (1, 1, 1, 1)


def test_the_truth_re_sampled_and_lying_on_any_side_is_the_truth() -> None:
    """What sampling leaves is stated: RS-CD 0.007, less than half of the best median of the paper, and RS-IoU 1."""
    cabinet = merged([box(40, 20, 60), moved(box(4, 26, 30), 18)])
    finer = TriMesh(np.concatenate([cabinet.vertices, cabinet.vertices[cabinet.triangles].mean(axis=1)]), _fan(cabinet))
    for seed, turn in ((2, SE3.rot_x(math.pi / 2)), (4, SE3.rot_z(math.pi / 2) @ SE3.rot_y(math.pi))):
        score = articulated_score(finer.transformed(turn), [], cabinet, [], seed=seed)
        assert score.rs_cd < 0.008
        assert score.rs_iou > 0.99


def _fan(mesh: TriMesh) -> np.ndarray:
    """Return triangles of the same surface, each divided into three about its middle."""
    middle = len(mesh.vertices) + np.arange(len(mesh.triangles))
    return np.concatenate([np.column_stack([mesh.triangles[:, [i, (i + 1) % 3]], middle]) for i in range(3)]).astype(np.int32)


def test_size_and_place_of_the_object_do_not_count_but_half_of_it_does() -> None:
    scale = CUBE.scaled(25)
    larger = [
        replace(HINGE, origin=(125, 125, 0), center=(150, 0, 0)),
        replace(SLIDE, origin=(0, 0, 0), center=(-150, 0, 0)),
    ]

    assert articulated_score(scale, larger, CUBE, [HINGE, SLIDE]).f1_axis == 1
    half = articulated_score(box(10, 10, 5), [], CUBE, [])
    assert half.rs_iou < 0.6
    assert half.rs_cd > 0.05
    assert math.isnan(half.type_accuracy)
    assert half.f1 == 1


@pytest.mark.parametrize(
    ("wrong", "accuracy"),
    [
        (replace(HINGE, type="slider"), 0.5),
        (replace(HINGE, axis=(0, math.sin(0.2), math.cos(0.2))), 1),
        (replace(HINGE, origin=(5, 3.9, 0)), 1),  # 1.1 mm of a diagonal of 17.3
    ],
    ids=["type", "leaning", "beside"],
)
def test_a_wrong_joint_is_no_match(wrong: MovingJoint, accuracy: float) -> None:
    score = articulated_score(CUBE, [wrong, SLIDE], CUBE, [HINGE, SLIDE])

    assert (score.type_accuracy, score.f1, score.f1_axis) == (accuracy, accuracy, 0.5)


def test_an_axis_counts_either_way_along_and_a_slider_wherever_it_is() -> None:
    unit = replace(HINGE, origin=(0.1, 0, 0))
    assert joints_match(replace(unit, axis=(0, 0, -1), origin=(0.1, 0, 7)), unit)
    assert joints_match(replace(SLIDE, origin=(9, 9, 9)), SLIDE)
    assert not joints_match(replace(unit, origin=(0.1 + 1.01 * metrics.AXIS_OFF, 0, 0)), unit)


def test_missing_and_extra_joints_lower_f1_as_they_must() -> None:
    assert articulated_score(CUBE, [HINGE], CUBE, [HINGE, SLIDE]).f1 == pytest.approx(2 / 3)
    assert articulated_score(CUBE, [HINGE, SLIDE, HINGE], CUBE, [HINGE, SLIDE]).f1 == pytest.approx(4 / 5)
    assert articulated_score(CUBE, [HINGE], CUBE, []).f1 == 0


NAN = math.nan
KRIPPENDORFF = [
    [1, 2, 3, 3, 2, 1, 4, 1, 2, NAN, NAN, NAN],
    [1, 2, 3, 3, 2, 2, 4, 1, 2, 5, NAN, 3],
    [NAN, 3, 3, 3, 2, 3, 4, 2, 2, 5, 1, NAN],
    [1, 2, 3, 3, 2, 4, 4, 1, 2, 5, 1, NAN],
]
SHROUT_FLEISS = np.array([[9, 2, 5, 8], [6, 1, 3, 2], [8, 4, 6, 8], [7, 1, 2, 6], [10, 5, 6, 9], [6, 2, 4, 7]]).T


def test_agreement_equals_the_published_examples() -> None:
    assert krippendorff_alpha(KRIPPENDORFF, "nominal") == pytest.approx(0.743, abs=5e-4)
    assert krippendorff_alpha(KRIPPENDORFF, "ordinal") == pytest.approx(0.815, abs=5e-4)
    assert krippendorff_alpha(KRIPPENDORFF, "interval") == pytest.approx(0.849, abs=5e-4)
    assert icc_2k(SHROUT_FLEISS) == pytest.approx(0.62, abs=5e-3)


def test_agreement_of_nothing_is_not_a_number_and_of_equals_is_one() -> None:
    assert math.isnan(krippendorff_alpha([[1, NAN], [NAN, 2]]))
    assert math.isnan(icc_2k([[1, 2, 3]]))
    assert krippendorff_alpha([[1, 2, 5], [1, 2, 5]]) == 1
    assert icc_2k([[1, 2, 5], [1, 2, 5]]) == 1


def test_a_bootstrap_interval_is_as_wide_as_theory_says() -> None:
    values = np.random.default_rng(3).normal(5, 2, 400)
    low, high = bootstrap_interval(values)

    half = 1.96 * values.std(ddof=1) / math.sqrt(400)
    assert (low, high) == pytest.approx((values.mean() - half, values.mean() + half), abs=0.02)
    assert bootstrap_interval(values) == (low, high)
    assert bootstrap_interval([3.0, NAN]) == (3.0, 3.0)


def test_the_score_of_shapes_falls_with_what_is_wrong_with_them() -> None:
    ring = tube(15, 20, 30)

    assert shape_score(tube(14, 20, 30), ring).pcd < shape_score(cylinder(20, 30), ring).pcd < shape_score(cylinder(20, 120), ring).pcd
