"""A diameter taken for a radius, or a radius for a diameter: plates with random holes and pins, built as stated and otherwise."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest
from build123d import Box, Cylinder, Pos, Sphere
from numpy.random import default_rng

from articad.geometry.mesh import TriMesh
from articad.kernels.radii import radius_findings
from articad.kernels.tessellation import tessellate

SEEDS = range(6)
STEP_MM = 60.0  # between the middles of two features


def sizes(seed: int) -> dict[str, float]:
    """Radii and diameters of features in a row, none of which explains another, and the plate that has room for them."""
    rng = default_rng(seed)
    radii = rng.permutation(np.array([2.3, 3.1, 3.9, 5.3, 7.1, 8.9]) * rng.uniform(0.98, 1.02))[:4].tolist()
    names = ("bore_radius", "pin_radius", "hole_diameter", "ball_radius")
    stated = {name: (2.0 if name.endswith("diameter") else 1.0) * radius for name, radius in zip(names, radii, strict=True)}
    return {"length": 5 * STEP_MM, "width": 77.7, "thickness": 33.3, **stated}


def plate(lengths: dict[str, float], **built: float) -> TriMesh:
    """The plate with a bore, a pin, a hole and a dome; `built` has the radii that are built otherwise."""
    radii = {name: value / (2.0 if name.endswith("diameter") else 1.0) for name, value in lengths.items()} | built
    shape: Any = Box(lengths["length"], lengths["width"], lengths["thickness"])
    places = [Pos((number - 1.5) * STEP_MM, 0, 0) for number in range(4)]
    shape -= places[0] * Cylinder(radii["bore_radius"], 99)
    shape += places[1] * Cylinder(radii["pin_radius"], 99)
    shape -= places[2] * Pos(0, 0, 10) * Cylinder(radii["hole_diameter"], 33.3)  # blind, and seen from above only
    shape += places[3] * Pos(0, 0, lengths["thickness"] / 2) * Sphere(radii["ball_radius"])
    found = tessellate(shape.wrapped, 0.05, 0.1)
    return TriMesh(found.vertices, found.triangles)


def codes(lengths: dict[str, float], **built: float) -> list[tuple[str, str]]:
    return [(finding.code, finding.where) for finding in radius_findings("plate", plate(lengths, **built), lengths)]


@pytest.mark.parametrize("seed", SEEDS)
def test_a_plate_as_stated_has_no_finding(seed: int) -> None:
    assert codes(sizes(seed)) == []


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("times", [0.5, 2.0])
def test_twice_or_half_of_one_radius_is_named_and_is_gone_as_the_hint_says(seed: int, times: float) -> None:
    lengths = sizes(seed)
    name = ("bore_radius", "pin_radius", "hole_diameter", "ball_radius")[seed % 4]
    stated = lengths[name] / (2.0 if name.endswith("diameter") else 1.0)
    (found,) = radius_findings("plate", plate(lengths, **{name: times * stated}), lengths)

    assert (found.code, found.where) == ("W_RADIUS_MISTAKEN", f"parts.plate.dimensions.{name}")
    assert found.value == pytest.approx(times * stated, rel=2e-3)
    kind = "diameter" if name.endswith("diameter") else "radius"
    assert f"{name} is a {kind}, not a {'radius' if kind == 'diameter' else 'diameter'}." in found.hint
    told = re.search(r"with the radius ([\d.]+) mm", found.hint)
    assert told is not None
    assert codes(lengths, **{name: float(told[1])}) == []


@pytest.mark.parametrize(
    "more",
    [{"boss_radius": 2.0}, {"boss_diameter": 4.0}, {"wall": 1.0}, {"other": 2.0}],
    ids=["its own radius", "its own diameter", "a wall on the radius", "a length"],
)
def test_a_face_that_another_dimension_explains_is_another_face(more: dict[str, float]) -> None:
    lengths = sizes(0)
    radius = lengths.pop("bore_radius")
    scaled = {name: value * radius for name, value in more.items()}
    mesh = plate(lengths | {"bore_radius": radius}, bore_radius=2 * radius)

    assert [finding.code for finding in radius_findings("plate", mesh, lengths | {"bore_radius": radius})] == ["W_RADIUS_MISTAKEN"]
    assert not radius_findings("plate", mesh, lengths | {"bore_radius": radius} | scaled)


@pytest.mark.parametrize("name", ["crank_radius", "bolt_circle_diameter", "pitch_radius", "edge_radius", "bend_radius"])
def test_a_radius_on_which_features_lie_or_of_an_edge_needs_no_face(name: str) -> None:
    lengths = sizes(2)
    mesh = plate(lengths)
    diameter = 2.0 if name.endswith("diameter") else 1.0
    for times in (0.5, 2.0):
        assert not radius_findings("plate", mesh, lengths | {name: diameter * times * lengths["bore_radius"]})


def test_names_that_state_neither_a_radius_nor_a_diameter_say_nothing() -> None:
    lengths = sizes(1)
    mesh = plate(lengths, bore_radius=2 * lengths["bore_radius"])
    renamed = {name.replace("radius", "size").replace("diameter", "size"): value for name, value in lengths.items()}
    assert not radius_findings("plate", mesh, renamed)
