"""Sliding members: what slides along lines is proven without a cut in its range, and what it meets at the end of travel is found."""

from __future__ import annotations

import itertools
import math

import manifold3d as m3
import numpy as np
import pytest

from articad.certificates.certificate import certify
from articad.certificates.clearing import Ranges, Slides, clear
from articad.certificates.profile import Forest
from articad.certificates.proof import NO_SHRINK, Prover
from articad.certificates.ranges import PROVEN
from articad.certificates.spread import Spread
from articad.connectors import SE3
from articad.geometry import TriMesh
from articad.interference.motion import Chain, Route
from articad.interference.scene import Scene
from articad.interference.surface import whole_surface
from articad.interference.work import PIECES_PER_SECOND, WorkBudget
from articad.kinematics.joints import Joint
from tests.interference.mechanisms import joint, manifold_mesh, random_rotation, verified
from tests.interference.slides import cabinet

CASES = 22  # pairs of parts that move against each other
MOST_WORK = 5 * PIECES_PER_SECOND
NEEDED = 1e-3  # mm


# --- the drawer on two telescopic slides


@pytest.mark.parametrize(
    ("segments", "turned", "closing"), [(0, None, "tree"), (32, None, "tree"), (32, 3, "tree"), (8, None, "both"), (8, 1, "both")]
)
def test_a_telescopic_slide_is_proven_with_little_work(segments: int, turned: int | None, closing: str) -> None:
    drawer = cabinet(segments, turned=turned, closing=closing)
    certificate = certify(drawer.meshes, drawer.mechanism)
    assert certificate.ok, str(certificate.findings)
    assert len(certificate.pairs) == CASES
    assert certificate.work < MOST_WORK
    assert verified(certificate.to_json(), certificate) == []


@pytest.mark.parametrize("turned", [None, 2])
def test_a_lip_that_is_too_thick_at_the_end_of_travel_is_refused(turned: int | None) -> None:
    drawer = cabinet(8, turned=turned, closing="tree", too_thick=0.05)
    certificate = certify(drawer.meshes, drawer.mechanism)
    assert not certificate.ok
    (finding,) = certificate.findings.of("E_MOTION_COLLISION")
    assert set(finding.parts) == {"outer_left", "inner_left"}
    assert finding.value == pytest.approx(0.05, abs=1e-3)
    assert not any(set(claim.parts) == {"outer_left", "inner_left"} for claim in certificate.claims)
    assert certificate.work < MOST_WORK


@pytest.mark.parametrize("turned", [None, 2])
def test_a_lip_that_just_passes_is_proven(turned: int | None) -> None:
    drawer = cabinet(8, turned=turned, closing="tree", too_thick=-0.05)
    certificate = certify(drawer.meshes, drawer.mechanism)
    assert certificate.ok, str(certificate.findings)
    assert verified(certificate.to_json(), certificate) == []


def test_boxes_of_what_slides_hold_their_triangles() -> None:
    drawer = cabinet(8, closing="tree")
    parts, joints = ("outer_left", "middle_left"), [drawer.joints[2]]
    prover = Prover(Scene.of(drawer.meshes, joints), Route(parts, tuple(joints)), ["left_1"])
    for forest in prover.forests(NO_SHRINK):
        tree = forest.tree
        for node in range(len(tree.centre)):
            corners = tree.corners[tree.order[tree.start[node] : tree.start[node] + tree.size[node]]]
            assert (np.abs(corners - tree.centre[node]) <= tree.half[node]).all()


# --- random bodies on random slides, against the gap of the swept hull


def sliders(rng: np.random.Generator, ways: int, *, more: int) -> list[Joint]:
    """Return sliders in a row along a few random lines, some along the same one, their parts' frames turned at random."""
    along = [random_rotation(rng) for _ in range(ways)]
    chosen = [*range(ways), *rng.integers(ways, size=more).tolist()]
    own = [random_rotation(rng) for _ in range(len(chosen) + 1)]
    found = []
    for at, which in enumerate(chosen):
        low, high = sorted(rng.uniform(-20.0, 20.0, size=2).tolist())
        parent, child = (at, at + 1) if rng.random() < 0.5 else (at + 1, at)
        frames = [own[part].inverse() @ along[which] for part in (parent, child)]
        found.append(
            joint(f"s{at}", "slider", f"p{parent}", f"p{child}", at_parent=frames[0], at_child=frames[1], lower=(low,), upper=(high,))
        )
    return found


def body(rng: np.random.Generator) -> m3.Manifold:
    """Return a convex body of a few corners."""
    return m3.Manifold.hull_points(rng.uniform(-6.0, 6.0, size=(int(rng.integers(4, 9)), 3)))


def swept(solid: m3.Manifold, chain: Chain) -> m3.Manifold:
    """Return the hull of a convex body at all corners of a range: where it slides, as the chain's first part sees it."""
    corners = [chain.matrix(values)[:3] for values in itertools.product(*((f.lower, f.upper) for f in chain.freedoms))]
    return m3.Manifold.batch_hull([solid.transform(T) for T in corners])


def drawn(seed: int) -> tuple[m3.Manifold, m3.Manifold, Chain, np.ndarray]:
    """Return two bodies on random slides, and a way for the first that ends where it just touches what the second sweeps."""
    rng = np.random.default_rng(seed)
    joints = sliders(rng, 1 + seed % 2, more=seed // 2 % 2)
    parts = tuple(f"p{at}" for at in range(len(joints) + 1))
    chain = Chain(Route(parts, tuple(joints)), [j.name for j in joints], coordinates=PROVEN)
    a, b = body(rng), body(rng)
    way = swept(b, chain)
    low, high = np.array(way.bounding_box()).reshape(2, 3)
    start, end = rng.normal(size=3) * 200.0, rng.uniform(low, high)
    apart, meets = 0.0, 1.0  # shares of the way from start to end: bisected to where they touch
    for _ in range(45):
        middle = (apart + meets) / 2
        hits = float((a.translate(start + middle * (end - start)) ^ way).volume()) > 0
        apart, meets = (apart, middle) if hits else (middle, meets)
    return a.translate(start + apart * (end - start)), b, chain, (end - start) / np.linalg.norm(end - start)


def search(mesh_a: TriMesh, mesh_b: TriMesh, chain: Chain, bounds: np.ndarray, *, most: int = 8_000) -> tuple[bool, int]:
    """Return whether two bodies are kept apart over a range, and in how many boxes."""
    a, b = (Forest.plain(whole_surface(mesh)) for mesh in (mesh_a, mesh_b))
    boxes = Ranges(Spread(chain), bounds)
    found = clear(a, b, boxes, NEEDED, epsilon=1e-3, budget=WorkBudget(math.inf), most=most)
    return found.is_complete, len(boxes.spread)


def compared(seeds: range) -> int:
    """Compare the search with the gap of the swept hull, a little before and behind the place where they touch; return how many apart."""
    apart = 0
    for seed in seeds:
        a, b, chain, towards = drawn(seed)
        way, mesh_b, bounds = swept(b, chain), manifold_mesh(b), np.array([(f.lower, f.upper) for f in chain.freedoms])
        for step in (-0.05, -0.01, 0.01, 0.05):
            there = a.translate(step * towards)
            complete, boxes = search(manifold_mesh(there), mesh_b, chain, bounds)
            if float((there ^ way).volume()) > 0:
                assert not complete, (seed, step)
            elif there.min_gap(way, 1.0) > 2 * NEEDED:
                apart += 1
                assert (complete, boxes) == (True, 1), (seed, step)  # one box: the range is not cut
    return apart


def test_random_slides_are_proven_in_one_box_exactly_where_the_swept_hull_keeps_apart() -> None:
    assert compared(range(10)) >= 10


@pytest.mark.soak
def test_many_random_slides_are_proven_in_one_box_exactly_where_the_swept_hull_keeps_apart() -> None:
    assert compared(range(1000, 2000)) >= 1000


# --- bounds of motion, against dense samples


def mixed(rng: np.random.Generator) -> Chain:
    """Return a chain of random joints that slide, turn and screw, crossed either way."""
    kinds = rng.choice(["slider", "revolute", "cylindrical", "screw", "planar"], size=int(rng.integers(1, 4)))
    joints = []
    for at, kind in enumerate(kinds.tolist()):
        forth = rng.random() < 0.5
        names = (f"p{at}", f"p{at + 1}") if forth else (f"p{at + 1}", f"p{at}")
        frames = [SE3.from_translation(rng.uniform(-30, 30, size=3)) @ random_rotation(rng) for _ in range(2)]
        upper = (1.0,) * {"cylindrical": 2, "planar": 3}.get(kind, 1)
        lower = tuple(-end for end in upper)
        joints.append(joint(f"j{at}", kind, *names, at_parent=frames[0], at_child=frames[1], lower=lower, upper=upper, lead=4.0))
    return Chain(Route(tuple(f"p{at}" for at in range(len(joints) + 1)), tuple(joints)), [j.name for j in joints], coordinates=PROVEN)


@pytest.mark.parametrize("seed", range(12))
def test_no_point_goes_further_than_its_bound(seed: int) -> None:
    rng = np.random.default_rng(seed)
    chain = mixed(rng)
    spread = Spread(chain)
    centre, half = rng.uniform(-1, 1, size=len(chain.freedoms)), 10.0 ** rng.uniform(-2, 0.3, size=len(chain.freedoms))
    columns = [factor.column for _, factor in spread.factors]
    box = spread.add(centre[None], half[columns][None])
    points, u = rng.uniform(-40, 40, size=(20, 3)), rng.normal(size=(20, 6, 3))
    axes = spread.omega[0][spread.turns > 0]
    u[:, : min(5, len(axes))] = axes[:5]  # a turn does not move points along its own axis, unless the turns outside tilt it
    u /= np.linalg.norm(u, axis=2, keepdims=True)
    T = chain.matrix(centre)
    here = points @ T[:3, :3].T + T[:3, 3]
    rows = np.repeat(box, len(points))
    bound = spread.first_order(rows, u, here, None).sum(axis=2) + spread.second_order(rows, u, here, np.zeros(len(points)))
    signs = np.array(list(itertools.product((-1, 1), repeat=len(half))))
    farthest = np.zeros_like(bound)
    for share in [*signs, *rng.uniform(-1, 1, size=(800, len(half)))]:
        T = chain.matrix(centre + share * half)
        moved = points @ T[:3, :3].T + T[:3, 3] - here
        farthest = np.maximum(farthest, np.abs(np.einsum("pdi,pi->pd", u, moved)))
    assert (farthest <= bound + 1e-9).all()
    assert np.median(bound / np.maximum(farthest, 1e-9)) < 100  # it is of some use, too


@pytest.mark.parametrize("seed", range(12))
def test_no_axis_tilts_further_than_its_bound(seed: int) -> None:
    rng = np.random.default_rng(seed)
    spread = Spread(mixed(rng))
    columns = [factor.column for _, factor in spread.factors]
    count = max(columns) + 1
    centre, half = rng.uniform(-1, 1, size=count), 10.0 ** rng.uniform(-2, 0.7, size=count)
    at = int(spread.add(centre[None], half[columns][None])[0])
    others = spread.add(centre + rng.choice([-1.0, 1.0, 0.0, 0.6], size=(400, count)) * half, np.tile(half[columns], (400, 1)))
    tilted = np.linalg.norm(spread.omega[others] - spread.omega[at], axis=2).max(axis=0)
    assert (tilted <= spread.tilt[at] + 1e-9).all()
    turning = np.flatnonzero(spread.turns)
    if len(turning) > 1 and half[columns[turning[0]]] < np.pi:  # the second axis is turned by the first alone: that bound is reached
        assert tilted[turning[1]] > 0.99 * spread.tilt[at, turning[1]]


def test_a_wheel_that_spins_does_not_tilt_the_axis_of_another_wheel() -> None:
    # wheel a spins about x, a knuckle turns about z, wheel b spins about x again: b's axis leans as far as the knuckle turns it, at any spin
    turn_y = SE3.from_matrix(np.array([[0.0, 0, 1, 0], [0, 1, 0, 0], [-1, 0, 0, 0], [0, 0, 0, 1]]))  # z of a connector along x
    ends = {"spin_a": np.pi, "steer": 0.1, "spin_b": np.pi}
    joints = [
        joint(name, "revolute", f"p{at}", f"p{at + 1}", at_parent=frame, at_child=frame, lower=(-ends[name],), upper=(ends[name],))
        for at, (name, frame) in enumerate(zip(ends, (turn_y, SE3.identity(), turn_y), strict=True))
    ]
    spread = Spread(Chain(Route(tuple(f"p{at}" for at in range(4)), tuple(joints)), list(ends), coordinates=PROVEN))
    spread.add(np.zeros((1, 3)), np.array([list(ends.values())]))
    np.testing.assert_allclose(spread.tilt, [[0.0, 2 * np.sin(np.pi / 2), 2 * np.sin(0.05)]], atol=1e-12)


@pytest.mark.parametrize("seed", range(6))
def test_no_corner_of_a_little_box_goes_further_than_the_bound_of_the_box(seed: int) -> None:
    rng = np.random.default_rng(100 + seed)
    chain = mixed(rng)
    spread = Spread(chain)
    centre, half = rng.uniform(-1, 1, size=len(chain.freedoms)), 10.0 ** rng.uniform(-2, 0.3, size=len(chain.freedoms))
    box = spread.add(centre[None], half[[factor.column for _, factor in spread.factors]][None])
    middles, u = rng.uniform(-40, 40, size=(12, 3)), rng.normal(size=(12, 5, 3))
    u /= np.linalg.norm(u, axis=2, keepdims=True)
    sides = rng.uniform(0, 30, size=(12, 3)) * (rng.random(size=(12, 3)) < 0.6)  # half edges along b's axes [mm]: rods and plates, too
    T = chain.matrix(centre)
    extent, here = T[:3, :3].T * sides[:, :, None], middles @ T[:3, :3].T + T[:3, 3]
    rows = np.repeat(box, 12)
    first, ball = spread.first_order(rows, u, here, extent).sum(axis=2), np.linalg.norm(sides, axis=1)
    bound = first + spread.second_order(rows, u, here, ball, extent)
    assert (bound <= first + spread.second_order(rows, u, here, ball) + 1e-9).all()
    points = middles[:, None] + np.array(list(itertools.product((-1, 1), repeat=3))) * sides[:, None]
    still = points @ T[:3, :3].T + T[:3, 3]
    signs = np.array(list(itertools.product((-1, 1), repeat=len(half))))
    for share in [*signs, *rng.uniform(-1, 1, size=(300, len(half)))]:
        T = chain.matrix(centre + share * half)
        moved = points @ T[:3, :3].T + T[:3, 3] - still
        assert (np.abs(np.einsum("pdi,pci->pcd", u, moved)) <= bound[:, None] + 1e-9).all()


def test_a_turn_about_the_axis_of_a_rod_is_bound_by_its_radius_not_its_length() -> None:
    chain = Chain(Route(("p0", "p1"), (joint("r", "revolute", "p0", "p1", lower=(-1.0,), upper=(1.0,)),)), ["r"], coordinates=PROVEN)
    spread = Spread(chain)
    box, u = spread.add(np.zeros((1, 1)), np.full((1, 1), 0.1)), np.array([[[1.0, 0, 0]]])
    rod = np.diag([2.0, 2.0, 200.0])[None]
    bound = spread.second_order(box, u, np.zeros((1, 3)), np.array([200.02]), rod)
    assert bound[0, 0] == pytest.approx(0.1**2 * 4 / 2)  # half the square of the turn times the radius, at most the sum of both sides


def test_what_turns_or_slides_everywhere_has_no_directions_of_slides() -> None:
    rng = np.random.default_rng(0)
    for joints, expected in (
        (sliders(rng, 2, more=1), True),
        (sliders(rng, 3, more=0), False),
        ([joint("r", "revolute", "p0", "p1")], False),
    ):
        chain = Chain(Route(tuple(f"p{at}" for at in range(len(joints) + 1)), tuple(joints)), [j.name for j in joints], coordinates=PROVEN)
        spread = Spread(chain)
        spread.add(chain.rest[None], np.ones((1, len(spread.factors))))
        assert (Slides.of(spread, 0) is not None) == expected
