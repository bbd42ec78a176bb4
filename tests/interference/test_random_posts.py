"""Random mechanisms with a planted post: sweeps, certificates and MuJoCo agree with dense sampling by an oracle of the test's own.

A few run with the other tests, `-m soak` takes 200 and samples them at 10⁵ poses.
"""

from __future__ import annotations

from functools import lru_cache
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


@lru_cache(maxsize=SOME)
def post_of(seed: int) -> Posted:
    """Return the post of a seed; several tests ask for the same one."""
    return planted_post(seed, POSES if seed < SOME else MOST_POSES)


@pytest.mark.parametrize("seed", seeds())
def test_no_certificate_is_ok_where_dense_sampling_finds_an_overlap(seed: int) -> None:
    posted = post_of(seed)
    certificate = posted.assembly.certify(budget=BUDGET)
    at_most_two = max(depth for drivers, depth in posted.deepest.items() if len(drivers) <= 2)
    if certificate.ok:
        assert at_most_two < HIT, (posted.deepest, posted.story)
        assert verified(certificate.to_json(), certificate) == []
    elif not posted.is_hit:  # what is free but not proven says so
        assert certificate.findings.of("W_NOT_CERTIFIED"), (certificate.findings, posted.story)
    if not posted.is_hit:
        assert not certificate.findings.of("E_MOTION_COLLISION"), (certificate.findings, posted.story)


@pytest.mark.parametrize("seed", seeds())
def test_a_sweep_misses_only_what_is_between_its_samples(seed: int) -> None:
    posted = post_of(seed)
    mechanism = posted.assembly.mechanism
    names = [c.name for c in mechanism.drivers]
    collisions = posted.assembly.sweep(steps=STEPS).findings.of("E_MOTION_COLLISION")
    for finding in collisions:
        assert finding.pose is not None
        q = np.array([[finding.pose.get(name, rest) for name, rest in zip(names, mechanism.rest, strict=True)]])
        assert posted.depth(q)[0] > 0, (finding, posted.story)
    for k, name in enumerate(names):  # an overlap over more than one step of the driver alone is found
        q = np.tile(mechanism.rest, (20 * STEPS, 1))
        q[:, k] = np.linspace(*posted.spans[name], len(q))
        if longest_run(posted.depth(q) > HIT) > 21:
            assert any(finding.pose and name in finding.pose for finding in collisions), (name, posted.deepest, posted.story)


def longest_run(flags: NDArray[np.bool_]) -> int:
    """Return the most flags in a row."""
    ends = np.flatnonzero(np.diff(np.concatenate([[0], flags.astype(int), [0]])))
    return int((ends[1::2] - ends[::2]).max(initial=0))


@pytest.mark.parametrize("seed", seeds())
def test_manifold_and_mujoco_see_the_post_where_the_planes_do(seed: int, tmp_path: Path) -> None:
    posted = post_of(seed)
    assembly, mechanism = posted.assembly, posted.assembly.mechanism
    bundle = write_mjcf(assembly)
    bundle.write(tmp_path)
    engine = MujocoMjcf(tmp_path / bundle.main)
    ids = {engine.model.body(name).id for name in (posted.hand, "post")}
    excluded = posted.hand_is_carried_by_the_carrier()
    names = [c.name for c in mechanism.drivers]
    found = samples(mechanism.rest, [posted.spans[name] for name in names], names, 400, np.random.default_rng(seed))
    q = np.concatenate(list(found.values()))
    depth = posted.depth(q)
    rows = np.concatenate([np.argsort(depth)[-3:], np.random.default_rng(seed).choice(len(q), 12)])
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
    mechanism = posted.assembly.mechanism
    X = mechanism.poses(q).matrix
    placed = []
    for name, solid in zip((posted.hand, "post"), posted.solids, strict=True):
        mesh = m3.Mesh(solid.mesh.vertices.astype(np.float32), solid.mesh.triangles.astype(np.uint32))
        placed.append(m3.Manifold(mesh).transform(X[mechanism.part_index(name), :3]))
    return float((placed[0] ^ placed[1]).volume())
