"""Random mechanisms with a planted post: checks of the motion, certificates and MuJoCo agree with dense sampling by the test's own oracle.

A few run with the other tests, `-m soak` takes 200 and samples them at 10⁵ poses.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import manifold3d as m3
import numpy as np
import pytest
from numpy.typing import NDArray

from articad.export.mjcf import write_mjcf
from tests.engines import MujocoMjcf, joint_values
from tests.interference.mechanisms import verified
from tests.random_posts import CLEAR, HIT, Posted, planted_post, samples

FloatArray = NDArray[np.float64]

SOME, ALL = 6, 200
POSES, MOST_POSES = 3_000, 100_000
BUDGET = 5.0  # nominal seconds of a certificate
STEPS = 60  # of a sweep
CONTACT = 0.05  # mm: less depth or distance than this is not asked of engines


def seeds() -> list[Any]:
    """Seeds of posts; those beyond the first few are marked."""
    return [seed if seed < SOME else pytest.param(seed, marks=pytest.mark.soak) for seed in range(ALL)]


@pytest.fixture(scope="module", params=seeds())
def posted(request: pytest.FixtureRequest) -> Posted:
    """Return the post of a seed; all tests of one seed run in a row."""
    return planted_post(request.param, POSES if request.param < SOME else MOST_POSES)


def test_no_certificate_is_ok_where_dense_sampling_finds_an_overlap(posted: Posted) -> None:
    certificate = posted.assembly.certify(budget=BUDGET)
    at_most_two = max(depth for drivers, depth in posted.deepest.items() if len(drivers) <= 2)
    if certificate.ok:
        assert at_most_two < HIT, (posted.deepest, posted.story)
        assert verified(certificate.to_json(), certificate) == []
    elif not posted.is_hit:  # what is free but not proven says so
        assert certificate.findings.of("W_NOT_CERTIFIED") or certificate.findings.of("E_NOT_CHECKED"), (certificate.findings, posted.story)
    if not posted.is_hit:
        assert not certificate.findings.of("E_MOTION_COLLISION"), (certificate.findings, posted.story)


def test_a_sweep_misses_only_what_is_between_its_samples(posted: Posted) -> None:
    mechanism = posted.assembly.mechanism
    names = [c.name for c in mechanism.drivers]
    collisions = posted.assembly.check_motion(steps=STEPS).findings.of("E_MOTION_COLLISION")
    for finding in collisions:
        assert finding.pose is not None
        q = np.array([[finding.pose.get(name, rest) for name, rest in zip(names, mechanism.rest, strict=True)]])
        assert posted.depth(q)[0] > 0, (finding, posted.story)
    for k, name in enumerate(names):  # an overlap over more than one step of the driver alone is found
        q = np.tile(mechanism.rest, (20 * STEPS, 1))
        q[:, k] = np.linspace(*posted.spans[name], len(q))
        if longest_run(posted.depth(q) > HIT) > 21:
            assert any(finding.pose and name in finding.pose for finding in collisions), (name, posted.deepest, posted.story)


def test_a_check_of_the_motion_agrees_with_dense_sampling_and_names_pair_pose_and_depth(posted: Posted) -> None:
    mechanism = posted.assembly.mechanism
    collisions = posted.assembly.check(motion=True).findings.of("E_MOTION_COLLISION")
    assert bool(collisions) == posted.is_hit, (posted.deepest, posted.story)
    for finding in collisions:
        assert set(finding.parts) == {posted.hand, "post"}
        assert finding.pose
        q = np.array([[finding.pose.get(c.name, rest) for c, rest in zip(mechanism.drivers, mechanism.rest, strict=True)]])
        depth = posted.depth(q)[0]
        assert depth > 0, (finding, posted.story)
        assert finding.value is not None
        assert 0 < finding.value < depth + CONTACT, (finding, depth)  # of convex solids no point lies deeper than the least way out


def test_a_least_clearance_is_a_distance_that_is_there_and_that_dense_sampling_hardly_betters(posted: Posted) -> None:
    mechanism = posted.assembly.mechanism
    names = [c.name for c in mechanism.drivers]
    (row,) = posted.assembly.clearances()
    assert set(row.parts) == {posted.hand, "post"}
    assert row.strength.kind == "sampled"
    q = np.array([row.pose.get(name, rest) for name, rest in zip(names, mechanism.rest, strict=True)])
    assert gap(posted, q) == pytest.approx(row.gap, abs=1e-6)
    if posted.is_hit:
        assert row.gap == 0
        return
    found = samples(mechanism.rest, [posted.spans[name] for name in names], names, 20_000, np.random.default_rng(1))
    rows = np.concatenate(list(found.values()))
    nearest = rows[np.argsort(posted.depth(rows))[-20:]]
    assert row.gap <= min(gap(posted, at) for at in nearest) + 1e-3, (row, posted.story)


def longest_run(flags: NDArray[np.bool_]) -> int:
    """Return the most flags in a row."""
    ends = np.flatnonzero(np.diff(np.concatenate([[0], flags.astype(int), [0]])))
    return int((ends[1::2] - ends[::2]).max(initial=0))


def test_manifold_and_mujoco_see_the_post_where_the_planes_do(posted: Posted, tmp_path: Path) -> None:
    assembly, mechanism = posted.assembly, posted.assembly.mechanism
    bundle = write_mjcf(assembly)
    bundle.write(tmp_path)
    engine = MujocoMjcf(tmp_path / bundle.main)
    ids = {engine.model.body(name).id for name in (posted.hand, "post")}
    rng = np.random.default_rng(0)
    excluded = posted.hand_is_carried_by_the_carrier()
    names = [c.name for c in mechanism.drivers]
    found = samples(mechanism.rest, [posted.spans[name] for name in names], names, 400, rng)
    q = np.concatenate(list(found.values()))
    depth = posted.depth(q)
    rows = np.concatenate([np.argsort(depth)[-3:], rng.choice(len(q), 12)])
    for row in rows[np.abs(depth[rows]) > CONTACT]:
        assert (common_volume(posted, q[row]) > 0) == (depth[row] > 0), posted.story
        if not excluded:
            engine.poses(joint_values(assembly, q[row]))
            engine.mujoco.mj_forward(engine.model, engine.data)
            touching = any(
                {int(engine.model.geom_bodyid[geom]) for geom in contact.geom} == ids and contact.dist < 0
                for contact in engine.data.contact
            )
            assert touching == (depth[row] > 0), (float(depth[row]), posted.story)
    assert posted.is_hit or float(depth.max()) < -CLEAR / 2


def common_volume(posted: Posted, q: FloatArray) -> float:
    """Return the volume that hand and post share [mm³], by manifold3d."""
    hand, post = placed(posted, q)
    return float((hand ^ post).volume())


def gap(posted: Posted, q: FloatArray) -> float:
    """Return the distance of hand and post [mm], by manifold3d."""
    hand, post = placed(posted, q)
    return float(hand.min_gap(post, 1e5))


def placed(posted: Posted, q: FloatArray) -> list[Any]:
    """Return hand and post where the drivers put them, as manifolds."""
    mechanism = posted.assembly.mechanism
    X = mechanism.poses(q).matrix
    solids = []
    for name, solid in zip((posted.hand, "post"), posted.solids, strict=True):
        mesh = m3.Mesh64(solid.mesh.vertices.copy(), solid.mesh.triangles.astype(np.uint64))
        solids.append(m3.Manifold(mesh).transform(X[mechanism.part_index(name), :3]))
    return solids
