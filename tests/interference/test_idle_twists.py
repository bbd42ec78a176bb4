"""Rods between two balls of a loop: they twist idly about their own axes while a crank drives, and keep clear of what is about them."""

from __future__ import annotations

import json
import math

import manifold3d as m3
import numpy as np
import pytest

from articad.certificates.certificate import Certificate, certify
from articad.connectors import SE3
from articad.geometry import TriMesh, box
from articad.interference.sweep import sweep
from articad.kinematics.mechanism import Mechanism
from tests.interference.mechanisms import at, joint, manifold_mesh, verified

THICK, TURN, LOW, HIGH, SEGMENTS, SIDES = 3.0, 0.08, 69.0, 71.0, 12, 6  # mm, rad, mm, mm, of the ring, of the rod
LUG, POST_TURN = 14.0, 2.0  # mm: reach of a lug on the rod; rad: where a post stands about the rod


def linkage(seed: int) -> tuple[Mechanism, SE3]:
    """Return a crank, a rod on two balls and a rocker, in places of a generator's choice, and the frame of the rod's first ball."""
    rng = np.random.default_rng(seed)
    a = np.array([20.0, 0, 0]) + rng.uniform(-3, 3, 3)
    b = np.array([90.0, 0, 40]) + rng.uniform(-5, 5, 3)
    along = (b - a) / np.linalg.norm(b - a)
    across = np.cross(along, [0.0, 1, 0])
    frames = [SE3.from_axes(list(place), list(along), list(across / np.linalg.norm(across))) for place in (a, b)]
    pivot = SE3.from_axes([90.0, 0, 0], [0.0, 1, 0], [1.0, 0, 0])
    joints = [
        joint("crank", "revolute", "frame", "arm", lower=(-TURN,), upper=(TURN,)),
        joint("a", "ball", "arm", "rod", at_parent=frames[0], at_child=frames[0], cone=0.6),
        joint("b", "ball", "rod", "rocker", at_parent=frames[1], at_child=frames[1], cone=0.8),
        joint("rock", "revolute", "frame", "rocker", at_parent=pivot, at_child=pivot, lower=(-1.5,), upper=(1.5,)),
    ]
    return Mechanism(("frame", "arm", "rod", "rocker"), "frame", joints), frames[0]


def ringed(seed: int, room: float) -> tuple[Certificate, dict[str, TriMesh]]:
    """Return the certificate of a rod inside a ring on the crank, which it misses by some room where it leans most [mm]."""
    mechanism, ball = linkage(seed)
    swings = []
    for value in np.linspace(-TURN, TURN, 41):
        poses = dict(zip(mechanism.parts, mechanism.poses(np.array([value])), strict=True))
        axis = (poses["arm"].matrix @ ball.matrix)[:3, :3].T @ (poses["rod"].matrix @ ball.matrix)[:3, 2]
        swings.append(math.acos(min(1.0, axis[2])))
    swing = max(swings)
    assert swing > 0.015  # else nothing is tried
    radius = (HIGH * math.sin(swing) + THICK + room) / math.cos(swing)  # of the circle inside the ring
    inner = radius / math.cos(math.pi / SEGMENTS)
    ring = m3.Manifold.cylinder(HIGH - LOW, inner + 6, inner + 6, SEGMENTS) - m3.Manifold.cylinder(60, inner, inner, SEGMENTS, center=True)
    meshes = {
        "frame": box(4, 4, 4).transformed(at(0, 0, -60)),
        "arm": manifold_mesh(ring.translate([0, 0, LOW])).transformed(ball),
        "rod": manifold_mesh(m3.Manifold.cylinder(HIGH + 5, THICK, THICK, SIDES)).transformed(ball),
    }
    return certify(meshes, mechanism, budget=60.0), meshes


def lugged(seed: int, away: float) -> Certificate:
    """Return the certificate of a rod with a lug, beside a post of 2 mm radius on the crank, which stands that far from the rod's axis [mm]."""
    mechanism, ball = linkage(seed)
    rod = m3.Manifold.cylinder(HIGH + 5, THICK, THICK, SIDES)
    lug = m3.Manifold.cube([LUG, 4, 4]).translate([0, -2, 8])
    post = m3.Manifold.cylinder(10, 2, 2, SIDES).translate([away * math.cos(POST_TURN), away * math.sin(POST_TURN), 5])
    meshes = {
        "frame": box(4, 4, 4).transformed(at(0, 0, -60)),
        "arm": manifold_mesh(post).transformed(ball),
        "rod": manifold_mesh(rod + lug).transformed(ball),
    }
    return certify(meshes, mechanism, budget=60.0)


def accepted(certificate: Certificate) -> bool:
    """Return whether a certificate is ok, covers crank and twist at once, and is accepted by its checker."""
    together = any({"crank", "a.z"} <= set(claim.vary) for claim in certificate.claims if set(claim.parts) == {"arm", "rod"})
    return certificate.ok and together and verified(json.loads(json.dumps(certificate.to_json())), certificate) == []


@pytest.mark.parametrize(("seed", "room"), [(0, 12.0), *(pytest.param(seed, 3.5, marks=pytest.mark.soak) for seed in range(3))])
def test_a_rod_of_a_loop_that_has_room_in_a_ring_is_proven_whatever_its_twist(seed: int, room: float) -> None:
    certificate, _ = ringed(seed, room)
    assert accepted(certificate), str(certificate.findings)


@pytest.mark.soak
def test_a_rod_of_a_loop_that_meets_its_ring_is_refused() -> None:
    certificate, _ = ringed(0, -0.5)
    assert not certificate.ok
    assert any(set(finding.parts) == {"arm", "rod"} for finding in certificate.findings)


@pytest.mark.soak
def test_a_post_that_only_the_idle_twist_of_a_rod_leads_into_is_a_collision() -> None:
    certificate = lugged(0, LUG - 2)
    (found,) = {finding.parts for finding in certificate.findings.of("E_MOTION_COLLISION")}
    assert set(found) == {"arm", "rod"}
    assert not certificate.ok


def test_a_post_beyond_the_reach_of_the_lug_is_proven_clear() -> None:
    assert accepted(certificate := lugged(0, LUG + 8)), str(certificate.findings)


def test_a_sweep_says_that_it_does_not_turn_the_rod_by_itself() -> None:
    mechanism, _ = linkage(0)
    report = sweep({"frame": box(4, 4, 4).transformed(at(0, 0, -60)), "rod": box(2, 2, 2)}, mechanism, steps=8)
    (said,) = report.findings.of("I_NOT_SAMPLED")
    assert said.parts == ("rod",)
    assert report.ok
