"""Rods on ball joints: what leans out of a ball's centre keeps clear of a ring about it, however it swings and spins."""

from __future__ import annotations

import math

import manifold3d as m3
import numpy as np
import pytest

from articad.certificates import verifier
from articad.certificates.certificate import Certificate, certify
from articad.connectors import SE3
from articad.geometry import TriMesh
from articad.interference.meridian import swung
from articad.interference.surface import Core
from articad.interference.work import PIECES_PER_SECOND
from articad.kinematics.mechanism import Mechanism
from tests.interference.mechanisms import joint, manifold_mesh, random_rotation, verified

REACH, THICK, CONE = 70.0, 3.0, 0.4  # mm, mm, rad


def bodies(room: float) -> dict[str, TriMesh]:
    """Return a rod from the centre of a ball, and a ring at its reach that it misses by some room where it leans most [mm]."""
    rod = m3.Manifold.cylinder(REACH + 10.0, THICK, THICK, 24) + m3.Manifold.sphere(5.0, 24)
    # the axis at full swing, and the rod's side beside it, meet the height h of the ring's lower edge at this radius
    low, high = REACH * math.cos(CONE) - 2.0, REACH * math.cos(CONE) + 2.0
    radius = (high * math.sin(CONE) + THICK + room) / math.cos(CONE)
    segments = 96
    inner = radius / math.cos(math.pi / segments)  # of the corners: the middles of the sides are at the radius
    ring = m3.Manifold.cylinder(high - low, inner + 6.0, inner + 6.0, segments) - m3.Manifold.cylinder(
        60.0, inner, inner, segments, center=True
    )
    return {"frame": manifold_mesh(ring.translate([0, 0, low])), "rod": manifold_mesh(rod)}


def certified(room: float, *, turned: int | None = None, backwards: bool = False, budget: float = 2.0) -> Certificate:
    meshes = bodies(room)
    own = SE3.identity() if turned is None else random_rotation(np.random.default_rng(turned))
    meshes["rod"] = meshes["rod"].transformed(own.inverse())
    ends = {"frame": SE3.identity(), "rod": own.inverse()}
    parent, child = ("rod", "frame") if backwards else ("frame", "rod")
    ball = joint("ball", "ball", parent, child, at_parent=ends[parent], at_child=ends[child], cone=CONE)
    return certify(meshes, Mechanism(tuple(meshes), "frame", [ball]), budget=budget)


@pytest.mark.parametrize(("turned", "backwards"), [(None, False), (None, True), (1, False), (2, True)])
@pytest.mark.parametrize("room", [3.5, 0.2])
def test_a_rod_that_has_room_in_a_ring_is_proven_with_little_work(room: float, turned: int | None, backwards: bool) -> None:
    certificate = certified(room, turned=turned, backwards=backwards)
    assert certificate.ok, str(certificate.findings)
    assert certificate.work < 0.2 * PIECES_PER_SECOND
    assert verified(certificate.to_json(), certificate) == []


def test_a_rod_that_meets_its_ring_is_not_proven() -> None:
    assert not certified(-0.3).ok


def test_a_checker_refuses_a_cone_that_pieces_do_not_keep_to(monkeypatch: pytest.MonkeyPatch) -> None:
    honest = certified(0.2)
    document = honest.to_json()
    ball = document["mechanism"]["joints"][0]
    assert verified(document, honest) == []
    ball["cone"] += 0.01
    assert verified(document, honest) != []
    monkeypatch.setattr(verifier, "BESIDE", verifier.BESIDE[:1] - 0.3)  # one cone, and that elsewhere
    assert verified(honest.to_json(), honest) != []


@pytest.mark.parametrize("seed", range(20))
def test_swung_triangles_keep_to_their_cones(seed: int) -> None:
    """Random triangles, swung and spun at random: no point passes its bound, and no distance of two is less than the bounds state."""
    rng = np.random.default_rng(seed)
    cone = float(rng.uniform(0.05, math.pi / 2))
    frame = (SE3.from_translation(rng.uniform(-5, 5, size=3)) @ random_rotation(rng)).matrix
    own = rng.normal(size=(40, 1, 3)) * rng.uniform(0, 30, size=(40, 1, 1)) + rng.normal(size=(40, 3, 3)) * rng.uniform(
        0, 30, size=(40, 1, 1)
    )
    corners = own @ frame[:3, :3].T + frame[:3, 3]
    low, high = swung(Core(frame, 3), corners, cone)
    checked = verifier.swung(corners - frame[:3, 3], frame[:3, 2], cone)
    for mine, theirs in ((low, checked[0]), (high, checked[1])):  # the same numbers, in an order of their own
        assert np.allclose(np.sort(mine, axis=1), np.sort(theirs, axis=1), atol=1e-9)
    share = rng.dirichlet(np.ones(3), size=(40, 200))
    share[:, :3] = np.eye(3)
    points = np.einsum("tsk,tki->tsi", share, own)
    angles = np.clip(cone + np.radians([-32, -16, -8, -4, -2, -1, -0.5, 0, 0.5, 1, 2, 4, 8, 16, 32]), 0, math.pi / 2)
    assert low.shape == high.shape == (40, 2 * len(angles))

    def outside(there: np.ndarray) -> np.ndarray:
        z, r = there[..., 2], np.hypot(there[..., 0], there[..., 1])
        return np.stack([r * np.cos(c) - side * np.sin(c) for side in (z, -z) for c in angles], axis=-1)

    assert (low[:, None] <= outside(points) + 1e-9).all()
    for swing in [cone, cone, *rng.uniform(0, cone, size=60)]:
        heading, twist = rng.uniform(-math.pi, math.pi, size=2)
        turn = (SE3.rot_z(heading) @ SE3.rot_x(swing) @ SE3.rot_z(twist)).matrix[:3, :3]
        assert (high[:, None] >= outside(points @ turn.T) - 1e-9).all()
