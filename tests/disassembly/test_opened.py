"""Linkages whose last parts come off only beyond the range of the whole: a bell crank, slider-cranks and a four-bar under a roof.

Each has a lever and a strut that hold its crank near rest. Once they are off, the crank turns on; where the roof ends, what is under it comes off.
With a roof all around, or posts in the way, nothing does.
"""

from __future__ import annotations

import math
from typing import Any

import manifold3d as m3
import numpy as np
import pytest

import articad as ac
from articad.assembly import Assembly
from articad.disassembly.opened import is_opened, remaining, step_poses
from articad.disassembly.steps import AssemblyOrder, words_of
from articad.interference.body import body_of
from articad.interference.overlap import overlap
from articad.papers.items import items_of
from articad.papers.manual import manual_of
from tests.interference.mechanisms import manifold_mesh

NEAR = 0.15  # rad by which the lever turns from rest
PIN, BORE = 3.0, 3.3
TURNS = (-math.inf, math.inf)


def bar(
    a: tuple[float, float], b: tuple[float, float], low: float, high: float, *, width: float = 8.0, bores: tuple[Any, ...] = ()
) -> m3.Manifold:
    """A straight link with round ends, and bores at some points."""
    along = np.subtract(b, a)
    length, turn = float(np.linalg.norm(along)), math.degrees(math.atan2(along[1], along[0]))
    body = m3.Manifold.cube([length, width, high - low]).translate([0, -width / 2, 0]).rotate([0, 0, turn]).translate([*a, low])
    for end in (a, b):
        body += disc(end, 7.0, low, high)
    for hole in bores:
        body -= disc(hole, BORE, low - 1, high + 1)
    return body


def disc(at: tuple[float, float], radius: float, low: float, high: float) -> m3.Manifold:
    return m3.Manifold.cylinder(high - low, radius, radius, 24).translate([*at, low])


def box(x: tuple[float, float], y: tuple[float, float], z: tuple[float, float]) -> m3.Manifold:
    return m3.Manifold.cube([x[1] - x[0], y[1] - y[0], z[1] - z[0]]).translate([x[0], y[0], z[0]])


def ring(inner: float, outer: float, low: float, high: float) -> m3.Manifold:
    return m3.Manifold.cylinder(high - low, outer, outer, 48).translate([0, 0, low]) - m3.Manifold.cylinder(
        high - low + 2, inner, inner, 48
    ).translate([0, 0, low - 1])


class Drawn:
    """Parts drawn in one frame, with connectors of the joints' names."""

    def __init__(self) -> None:
        self.solids: dict[str, m3.Manifold] = {}
        self.places: dict[str, dict[str, ac.Connector]] = {}
        self.joints: list[tuple[str, str, str, str, dict[str, Any]]] = []

    def add(self, name: str, solid: m3.Manifold) -> None:
        self.solids[name] = solid
        self.places.setdefault(name, {})

    def join(self, name: str, a: str, b: str, at: tuple[float, float], kind: str = "revolute", **options: Any) -> None:
        z = (0, 0, 1) if kind == "revolute" else (1, 0, 0)
        x = (1, 0, 0) if kind == "revolute" else (0, 1, 0)
        for part in (a, b):
            self.places[part][name] = ac.Connector(name, ac.SE3.from_axes(o=(*at, 0), z=z, x=x))
        self.joints.append((kind, name, a, b, {"limits": TURNS, **options}))

    def assembly(self) -> Assembly:
        parts = {
            name: ac.Part.from_mesh(name, manifold_mesh(solid), density=2700, connectors=self.places[name])
            for name, solid in self.solids.items()
        }
        joints = [getattr(ac, kind)(name, parts[a][name], parts[b][name], **options) for kind, name, a, b, options in self.joints]
        return Assembly.from_parts("drawn", parts=parts.values(), joints=joints, ground="base")


def held_crank(base: m3.Manifold, crank: m3.Manifold) -> Drawn:
    """A crank about the origin with a second arm along y, which a strut and a lever hold near rest."""
    drawn = Drawn()
    drawn.add("base", base + box((-110, 110), (-110, 110), (-4, 0)) + disc((0, 0), PIN, -1, 9.5) + disc((70, -18), PIN, -1, 15))
    drawn.add("crank", crank + bar((0, 0), (0, 12), 0.3, 6, bores=((0, 0),)) - disc((0, 0), BORE, -1, 20) + disc((0, 12), PIN, 5, 22))
    drawn.add("strut", bar((0, 12), (70, 12), 16, 20, bores=((0, 12), (70, 12))))
    drawn.add("lever", bar((70, -18), (70, 12), 6, 11, bores=((70, -18),)) + disc((70, 12), PIN, 10, 22))
    drawn.join("crank", "base", "crank", (0, 0))
    drawn.join("near", "crank", "strut", (0, 12))
    drawn.join("far", "lever", "strut", (70, 12))
    drawn.join("lever", "base", "lever", (70, -18), limits=(-NEAR, NEAR), driver=True)
    return drawn


def bell_crank(roof: m3.Manifold) -> Drawn:
    """A crank with a tongue along -x, under a roof 1 mm above it."""
    return held_crank(roof, bar((0, 0), (-30, 0), 0.3, 6))


TONGUE_ROOF = box((-33, -20), (-20, 20), (7, 11))
RING = ring(18, 40, 7, 11)
POSTS = disc((-30 * math.cos(0.9), 30 * math.sin(0.9)), 4, -1, 7.5) + disc((-30 * math.cos(0.9), -30 * math.sin(0.9)), 4, -1, 7.5)


def linked(kind: str, crank: float, rod: float, roof: m3.Manifold) -> Drawn:
    """A crank with a pin at (-crank, 0), a rod on it, and a slide or a rocker at the rod's other end; a roof is above the crank pin."""
    drawn = held_crank(roof, bar((0, 0), (-crank, 0), 0.3, 6) + disc((-crank, 0), PIN, 5, 9.5))
    end = (-crank - rod, 0.0)
    drawn.add("rod", bar((-crank, 0), end, 6.2, 9.5, bores=((-crank, 0), end)))
    drawn.join("wrist", "crank", "rod", (-crank, 0))
    if kind == "slider":
        rails = [box((-108, -crank - 8), y, (-1, 6)) for y in ((-12, -8.2), (8.2, 12))]
        drawn.add("base", drawn.solids["base"] + rails[0] + rails[1])
        drawn.add("slide", box((end[0] - 10, end[0] + 10), (-8, 8), (0.3, 6)) + disc(end, PIN, 5, 9.5))
        drawn.join("slide", "base", "slide", end, "slider", limits=(-12.0, 12.0))
    else:
        pivot = (end[0] + 30, -45.0)
        drawn.add("base", drawn.solids["base"] + disc(pivot, PIN, -1, 6))
        drawn.add("slide", bar(pivot, end, 0.3, 6, bores=(pivot,)) + disc(end, PIN, 5, 9.5))
        drawn.join("rocker", "base", "slide", pivot)
    drawn.join("gudgeon", "slide", "rod", end)
    return drawn


def small_roof(crank: float) -> m3.Manifold:
    """A roof above the outer half of the crank pin's eye, as wide as the whole moves it."""
    half = max(3.0, crank - 22.0)
    return box((-crank - 7, -crank), (-half, half), (10, 13))


def ring_roof(crank: float) -> m3.Manifold:
    return ring(crank, crank + 7, 10, 13)


def deepest(assembly: Assembly, order: AssemblyOrder) -> float:
    """How much deeper than allowed parts overlap at the places of the steps of an opened loop and on their paths, by Booleans [mm]."""
    scene, worst = assembly.scene(), -math.inf
    for step in (step for step in order.steps if step.opened):
        poses = step_poses(assembly.mechanism, step, order.base)
        for share in np.linspace(0, 1, 12):
            away = -share * sum(move.length_mm * np.array(move.direction) for move in step.moves)
            for a in step.parts:
                for b in step.onto:
                    found = overlap(
                        body_of(scene.meshes[b]), body_of(scene.meshes[a]), poses[b].inverse() @ ac.SE3.from_translation(away) @ poses[a]
                    )
                    worst = max(worst, found.depth - scene.passable(a, b))
    return worst


CASES: dict[str, tuple[Any, bool]] = {
    "bell crank": (lambda: bell_crank(TONGUE_ROOF), True),
    "bell crank, roof all around": (lambda: bell_crank(RING), False),
    "bell crank between posts": (lambda: bell_crank(TONGUE_ROOF + POSTS), False),
    "slider-crank": (lambda: linked("slider", 20, 50, small_roof(20)), True),
    "slider-crank, long crank": (lambda: linked("slider", 30, 60, small_roof(30)), True),
    "four-bar": (lambda: linked("rocker", 20, 60, small_roof(20)), True),
    "slider-crank, roof all around": (lambda: linked("slider", 20, 50, ring_roof(20)), False),
    "four-bar, roof all around": (lambda: linked("rocker", 20, 60, ring_roof(20)), False),
}


@pytest.mark.parametrize("case", CASES)
def test_parts_come_off_beyond_the_range_of_the_whole(case: str) -> None:
    make, builds = CASES[case]
    assembly = make().assembly()
    assert abs(assembly.mechanism.solve(np.array([[NEAR]])).columns[0, 0]) < 0.6  # the whole moves its crank by less
    order = assembly.assembly_order()
    assert order.ok is builds, [blocked.parts for blocked in order.blocked]
    turned = [step for step in order.steps if step.opened]
    assert bool(turned) is builds
    for step in turned:
        ((name, value),) = step.at.items()
        assert f"with {name} turned over to {math.degrees(value):.0f}°" in words_of(step)
        assert step.strength == "proven"
    if turned:
        assert deepest(assembly, order) <= 1e-6
        assert not {"strut", "lever"} & {part for step in turned for part in (*step.parts, *step.onto)}
    assert AssemblyOrder.from_json(order.to_json()) == order


def test_only_what_lacks_a_loop_is_opened() -> None:
    mechanism = CASES["four-bar"][0]().assembly().mechanism
    assert not is_opened(mechanism, mechanism.parts)
    assert is_opened(mechanism, ("base", "crank", "rod", "slide"))
    rest = remaining(mechanism, ("base", "crank", "rod", "slide"), "base", "crank")
    assert rest is not None
    assert [driver.joint for driver in rest.drivers] == ["crank"]
    assert remaining(mechanism, ("base", "rod"), "base", "crank") is None  # joints do not connect them


def test_the_manual_says_and_shows_how_the_rest_is_turned() -> None:
    assembly = CASES["bell crank"][0]().assembly()
    order = assembly.assembly_order()
    (step,) = [step for step in order.steps if step.opened]
    value = math.degrees(step.at["crank"])
    page = next(page for page in manual_of(assembly, order, items_of(assembly), dots=1.0) if page.told.get("step") == step.number)
    words = " ".join(lettering.words for lettering in page.texts)
    assert f"turned over to {value:.0f}°" in words
    assert f"Before: move crank to {value:.4g}°." in words
    turned = step_poses(assembly.mechanism, step, order.base)["crank"]
    assert np.allclose(turned.rotation[:, 0], [math.cos(step.at["crank"]), math.sin(step.at["crank"]), 0], atol=1e-9)
    others = [name for name in assembly.parts if name != "crank"]
    assert all(np.allclose(step_poses(assembly.mechanism, step, order.base)[name].matrix, assembly.at()[name].matrix) for name in others)
