"""The straight travel between two surfaces, against FCL's distances along the way."""

from __future__ import annotations

import math
from functools import partial

import numpy as np
import pytest

from articad.connectors import SE3
from articad.geometry import TriMesh
from articad.geometry.shapes import box, cylinder, tube
from articad.interference import travel
from articad.interference.body import body_of
from articad.interference.overlap import distance, overlap
from articad.interference.travel import Outline, _travels, first_contacts, material_met, meets
from tests.interference.mechanisms import random_rotation

SHAPES = (box(4, 7, 11), cylinder(5, 9, 24), tube(4, 6, 8, 24))


def corners(mesh: TriMesh, T: SE3) -> np.ndarray:
    return np.asarray(T.apply(mesh.vertices))[mesh.triangles]


@pytest.mark.parametrize("seed", range(12))
def test_surfaces_touch_after_their_travel_and_are_apart_before(seed: int) -> None:
    rng = np.random.default_rng(seed)
    a, b = (SHAPES[k] for k in rng.integers(0, len(SHAPES), 2))
    T_a = SE3.from_translation(rng.uniform(-3, 3, 3)) @ random_rotation(rng)
    way = rng.normal(size=3)
    way /= np.linalg.norm(way)
    T_b = SE3.from_translation(rng.uniform(20, 30) * way + rng.uniform(-4, 4, 3)) @ random_rotation(rng)
    forwards, backwards = first_contacts(Outline.of(corners(a, T_a), way), Outline.of(corners(b, T_b), way))
    assert math.isinf(backwards)

    def gap(travel: float) -> float:
        moved = SE3.from_translation(travel * way) @ T_a
        return distance(body_of(a), body_of(b), moved.inverse() @ T_b)

    if math.isinf(forwards):
        assert min(gap(t) for t in np.linspace(0, 60, 121)) > 0
        return
    assert gap(forwards) < 1e-6
    assert min(gap(t) for t in np.linspace(0, forwards * (1 - 1e-6), 60)) > 0


def test_the_opposite_motion_of_the_other_surface_has_the_same_travel() -> None:
    way = np.array([0.0, 0.6, 0.8])
    a, b = (Outline.of(corners(box(2, 3, 4), SE3.from_translation(at)), way) for at in ((0, 0, 0), (0.5, 9, 12)))
    assert first_contacts(a, b)[0] == pytest.approx(first_contacts(b, a)[1])


def test_surfaces_that_meet_where_they_are_travel_nowhere() -> None:
    way = np.array([1.0, 0.0, 0.0])
    a, b = (Outline.of(corners(box(2, 2, 2), SE3.from_translation(at)), way) for at in ((0, 0, 0), (1.0, 0.3, 0.2)))
    assert first_contacts(a, b) == (0.0, 0.0)


def test_a_pin_leaves_its_bore_along_the_axis_only() -> None:
    bore, pin = tube(5.0, 8.0, 20.0), cylinder(4.95, 30.0)
    for way, wanted in (((0.0, 0.0, 1.0), math.inf), ((1.0, 0.0, 0.0), 0.05)):
        a, b = (Outline.of(corners(mesh, SE3.identity()), np.array(way)) for mesh in (pin, bore))
        assert first_contacts(a, b)[0] == pytest.approx(wanted, abs=1e-3)


@pytest.mark.parametrize("seed", range(6))
def test_the_material_that_meets_a_block_is_what_lies_below_its_top(seed: int) -> None:
    """A block that is met from below is met by all that lies in the block lengthened downwards: measured by a Boolean."""
    rng = np.random.default_rng(seed)
    shape, T = SHAPES[seed % len(SHAPES)], random_rotation(rng)
    block, down = SE3.from_translation(rng.uniform(-3, 3, 3)), SE3.from_translation((0, 0, -100.0))
    expected = overlap(body_of(box(6, 5, 204)), body_of(shape), (block @ down).inverse() @ T).volume  # its top is where that of `met` is
    turned = random_rotation(rng)
    way = turned.rotation[:, 2]
    moving, staying = (Outline.of(corners(mesh, turned @ at), way) for mesh, at in ((shape, T), (box(6, 5, 4), block)))
    assert material_met(moving, staying) == pytest.approx(expected, rel=0.02, abs=2.0)
    backwards = [Outline.of(corners(mesh, turned @ at), -way).reversed for mesh, at in ((shape, T), (box(6, 5, 4), block))]
    assert material_met(*backwards) == pytest.approx(expected, rel=0.02, abs=2.0)


def of_every_two(a: Outline, b: Outline) -> tuple[float, float]:
    """Return the travels from every triangle of a to every one of b, walls among them."""
    i, j = (index.ravel() for index in np.indices((len(a.flat), len(b.flat))))
    travel = _travels(a.flat[i], a.height[i], b.flat[j], b.height[j])
    travel = travel[np.isfinite(travel).any(axis=1)]
    least, most = np.nanmin(travel, axis=1, initial=np.inf), np.nanmax(travel, axis=1, initial=-np.inf)
    if ((least <= 0) & (most >= 0)).any():
        return 0.0, 0.0
    return float(least[least > 0].min(initial=np.inf)), -float(most[most < 0].max(initial=-np.inf))


@pytest.mark.parametrize("seed", range(40))
def test_walls_that_are_seen_edge_on_decide_nothing_about_solids(seed: int) -> None:
    rng = np.random.default_rng(seed)
    a, b = (SHAPES[k] for k in rng.integers(0, len(SHAPES), 2))
    turn = random_rotation(rng) if seed % 2 else SE3.identity()  # edge-on but for rounding, and exactly
    T_b = SE3.from_translation(rng.integers(-12, 13, 3) / 2)
    way = turn.rotation[:, seed % 3]
    both = [Outline.of(corners(mesh, turn @ T), way) for mesh, T in ((a, SE3.identity()), (b, T_b))]
    assert not both[0].wide.all()
    assert first_contacts(*both) == pytest.approx(of_every_two(*both), abs=1e-9)


@pytest.mark.parametrize("seed", range(120))
def test_surfaces_meet_where_their_travel_is_finite(seed: int) -> None:
    """Beside each other, apart on one side, around each other, and through each other."""
    rng = np.random.default_rng(seed)
    a, b = (SHAPES[k] for k in rng.integers(0, len(SHAPES), 2))
    way = rng.normal(size=3)
    way /= np.linalg.norm(way)
    T_b = SE3.from_translation(rng.uniform(-1, 1, 3) * (4, 12, 25)[seed % 3]) @ random_rotation(rng)
    both = Outline.of(corners(a, random_rotation(rng)), way), Outline.of(corners(b, T_b), way)
    forwards, backwards = (math.isfinite(travel) for travel in first_contacts(*both))
    assert (meets(*both, forwards=True), meets(*both, forwards=False)) == (forwards, backwards)


def test_what_no_few_triangles_show_is_found_among_all() -> None:
    """A needle between the teeth of two fine combs: only one of 4,000 triangles meets it."""
    comb = np.array([[[x, 0.0, 0.0], [x + 0.01, 0.0, 0.0], [x, 1.0, 0.0]] for x in np.arange(4000) * 0.02])
    way = np.array([0.0, 0.0, 1.0])
    for tooth in (1, 1777, 3999):
        needle = comb[tooth : tooth + 1] * (0.5, 0.5, 1.0) + (0.5 * tooth * 0.02, 0.1, -3.0)
        a, b = Outline.of(needle, way), Outline.of(comb, way)
        assert meets(a, b, forwards=True)
        assert not meets(a, b, forwards=False)
        beside = Outline.of(needle + np.array([0.0125, 0.0, 0.0]), way)
        assert not meets(beside, b, forwards=True)


def test_whether_surfaces_meet_takes_fewer_triangles_than_where(monkeypatch: pytest.MonkeyPatch) -> None:
    """A tube with 4,000 triangles that is pushed at another one, which lies before it."""
    examined = {"meets": 0, "first_contacts": 0}
    way = np.array([1.0, 0.0, 0.0])
    ends = [Outline.of(corners(tube(4, 6, 80, 1000), SE3.from_translation((at, 1, 2))), way) for at in (0, 20)]
    for name, asked in (("meets", partial(meets, forwards=True)), ("first_contacts", first_contacts)):

        def counted(p: np.ndarray, *rest: np.ndarray, name: str = name) -> np.ndarray:
            examined[name] += len(p)
            return _travels(p, *rest)

        monkeypatch.setattr(travel, "_travels", counted)
        asked(*ends)
    assert 0 < examined["meets"] < examined["first_contacts"] / 3
