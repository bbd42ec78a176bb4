"""A ball that rests turned holds what it carries turned while other joints move: in sweeps, certificates, and what a checker reads."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from articad.certificates.certificate import certify
from articad.certificates.ranges import proven_freedoms, turned
from articad.connectors import SE3
from articad.geometry import TriMesh, box
from articad.interference.freedoms import driver_values, freedoms
from articad.interference.sweep import sweep
from articad.kinematics.joints import Joint
from articad.kinematics.mechanism import Mechanism
from tests.interference.mechanisms import at, joint, verified
from tests.interference.test_certificate import ball_and_socket

QUARTER_ABOUT_X = (math.sin(math.pi / 4), 0.0, 0.0, math.cos(math.pi / 4))


def propeller(post: SE3) -> tuple[dict[str, TriMesh], Mechanism]:
    """A blade of 60 mm that turns about the z axis of a hub, which a ball lets rest with that axis along -y; and a post on the ground."""
    joints: list[Joint] = [
        joint("ball", "ball", "ground", "hub", rest=QUARTER_ABOUT_X, cone=2.0),
        joint("spin", "revolute", "hub", "blade", at_child=at(-30)),
        joint("foot", "fixed", "ground", "post", at_parent=post),
    ]
    meshes = {"blade": box(60, 4, 4), "post": box(6, 6, 6)}
    return meshes, Mechanism(("ground", "hub", "blade", "post"), "ground", joints)


@pytest.mark.parametrize(("place", "is_hit"), [(at(0, 0, 40), True), (at(0, 40, 0), False)])
def test_what_a_ball_carries_moves_about_where_the_ball_rests(place: SE3, is_hit: bool) -> None:
    meshes, mechanism = propeller(place)
    certificate = certify(meshes, mechanism, joints=["spin"])
    assert bool(certificate.findings.of("E_MOTION_COLLISION")) == is_hit
    assert certificate.ok == (not is_hit)
    assert verified(certificate.to_json(), certificate) == []
    assert bool(sweep(meshes, mechanism, joints=["spin"]).findings.of("E_MOTION_COLLISION")) == is_hit


def test_the_freedoms_of_a_ball_rest_where_it_does() -> None:
    rng = np.random.default_rng(0)
    for _ in range(50):
        R = Rotation.from_rotvec(rng.uniform(0, 2.9) * (v := rng.normal(size=3)) / np.linalg.norm(v))
        ball = joint("ball", "ball", "a", "b", rest=tuple(R.as_quat()), cone=math.pi)
        values = driver_values(ball, [freedom.rest for freedom in freedoms(ball)])
        assert np.allclose(Rotation.from_quat(values).as_matrix(), R.as_matrix(), atol=1e-12)
        assert np.allclose(turned([freedom.rest for freedom in proven_freedoms(ball)])[:3, :3], R.as_matrix(), atol=1e-12)


def test_a_ball_in_its_socket_is_certified_where_it_rests_turned() -> None:
    knuckle = joint("knuckle", "ball", "socket", "stud", cone=0.25, rest=(0.06, 0.0, 0.0, math.sqrt(1 - 0.06**2)))
    certificate = certify(ball_and_socket(), Mechanism(("socket", "stud"), "socket", [knuckle]), deflection=0.02, budget=1)
    assert verified(certificate.to_json(), certificate) == []
