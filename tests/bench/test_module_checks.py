"""Checks of repeated modules: spacing, which way round, which way they go, and the fits of bought parts; each against bodies placed by hand."""

from __future__ import annotations

from typing import Any

import pytest

from articad.assembly import Assembly
from articad.connectors import SE3
from articad.geometry import Part, TriMesh, box, cylinder
from articad_bench.subject import Subject
from tests.bench.test_cheats import made, placed, solid
from tests.bench.test_checks import form
from tests.kinematics.linkages import at, joint

BRACKET = made("Add", solid(box(40, 20, 6)), solid(placed(box(6, 20, 20), -17, 0, 10)))
SIDES = [40, 20, 23]


def standing(*places: SE3, mesh: TriMesh = BRACKET) -> Subject:
    """A ground plate, and copies of a mesh at these places."""
    parts = [Part.from_mesh("plate", placed(box(900, 900, 10), 0, 0, -40), density=1000)]
    parts += [Part.from_mesh(f"copy_{number}", mesh, density=1000) for number in range(len(places))]
    joints = [joint(f"held_{number}", "fixed", ("plate", place), (f"copy_{number}", at(0))) for number, place in enumerate(places)]
    return Subject(Assembly.from_parts("standing", parts=parts, joints=joints, ground="plate"))


def row(*x: float, y: float = 0.0) -> list[SE3]:
    return [SE3.trans(each, y, 0) for each in x]


def ok(subject: Subject, kind: str, **fields: Any) -> bool:
    return form({"kind": kind} | fields).judge(subject).ok


@pytest.mark.parametrize(
    ("places", "expected"),
    [
        (row(0, 60, 120, 180), True),
        (row(0, 60, 120), False),
        (row(0, 60, 122, 180), False),
        (row(0, 60, 120, 180, 240), False),
        ([*row(0, 60, 120, 180)[:3], SE3.trans(180, 300, 70)], True),  # the axis alone counts
    ],
)
def test_levels_are_counted_and_measured_along_their_axis(places: list[SE3], *, expected: bool) -> None:
    assert ok(standing(*places), "spaced", mm=SIDES, axis=[1, 0, 0], pitch=[60], levels=4) is expected


def test_each_distance_may_be_another_and_each_level_holds_as_many_parts() -> None:
    grid = [*row(0, 60, 160), *row(0, 60, 160, y=100)]

    assert ok(standing(*grid), "spaced", mm=SIDES, axis=[1, 0, 0], pitch=[60, 100], levels=3, each=[2])
    assert not ok(standing(*grid), "spaced", mm=SIDES, axis=[-1, 0, 0], pitch=[60, 100], levels=3, each=[2])
    assert not ok(standing(*grid[:-1]), "spaced", mm=SIDES, axis=[1, 0, 0], pitch=[60, 100], levels=3, each=[2])
    assert not ok(standing(*grid), "spaced", mm=SIDES, axis=[1, 0, 0], pitch=[60], levels=3, each=[2])
    assert ok(standing(*grid[:-1]), "spaced", mm=SIDES, axis=[1, 0, 0], pitch=[60, 100], levels=3, each=[2, 2, 1])
    assert not ok(standing(*grid[:-1]), "spaced", mm=SIDES, axis=[1, 0, 0], pitch=[60, 100], levels=3, each=[1, 2, 2])
    assert ok(standing(*grid), "spaced", mm=SIDES, axis=[0, 0, 1], levels=1, each=[6])


def test_sizes_follow_each_other_along_an_axis() -> None:
    parts = [Part.from_mesh("plate", placed(box(900, 900, 10), 0, 0, -60), density=1000)]
    parts += [Part.from_mesh(f"post_{side}", box(side, side, side), density=1000) for side in (20, 30, 40)]

    def posts(*x: float) -> Subject:
        held = [joint(f"held_{s}", "fixed", ("plate", at(place)), (f"post_{s}", at(0))) for s, place in zip((20, 30, 40), x, strict=True)]
        return Subject(Assembly.from_parts("posts", parts=parts, joints=held, ground="plate"))

    follow = {"sizes": [[20, 20, 20], [30, 30, 30], [40, 40, 40]], "axis": [1, 0, 0]}
    assert ok(posts(0, 50, 200), "ordered", **follow)
    assert not ok(posts(0, 200, 50), "ordered", **follow)
    assert not ok(posts(200, 50, 0), "ordered", **follow)
    assert ok(posts(200, 50, 0), "ordered", **(follow | {"axis": [-1, 0, 0]}))
    assert not ok(posts(0, 50, 200), "ordered", **(follow | {"sizes": [[20, 20, 20], [31, 31, 31]]}))


def test_one_part_that_is_turned_round_is_seen_wherever_it_lies() -> None:
    places = row(0, 60, 120, 180)
    one_turned = [*places[:3], places[3] @ SE3.rot_z(3.14159265)]

    assert ok(standing(*places), "turned", mm=SIDES, alike=[4])
    assert not ok(standing(*one_turned), "turned", mm=SIDES, alike=[4])
    assert ok(standing(*one_turned), "turned", mm=SIDES, alike=[3, 1])
    assert not ok(standing(*places[:3]), "turned", mm=SIDES, alike=[4])


def test_a_bought_ring_fits_a_seat_by_their_diameters() -> None:
    ring = made("Subtract", solid(cylinder(11, 7)), solid(cylinder(4, 9)))

    def housing(seat: float) -> Subject:
        body = made("Subtract", solid(box(60, 40, 7)), solid(cylinder(seat / 2, 9)))
        parts = [Part.from_mesh(name, mesh, density=1000) for name, mesh in (("body", body), ("ring", ring))]
        held = joint("held", "fixed", ("body", at(0)), ("ring", at(0)))
        return Subject(Assembly.from_parts("housing", parts=parts, joints=[held], ground="body"))

    fits = {"diameter": 22, "play": [0, 0.04], "number": [1, 1]}
    assert ok(housing(22.02), "fitted", **fits)
    assert not ok(housing(22.2), "fitted", **fits)
    assert not ok(housing(22.02), "fitted", **(fits | {"diameter": 24}))
    assert not ok(housing(22.02), "fitted", **(fits | {"axis": [1, 0, 0]}))
    aside = Assembly.from_parts(
        "aside",
        parts=list(housing(22.02).assembly.parts.values()),
        joints=[joint("held", "fixed", ("body", at(0, 0, 30)), ("ring", at(0)))],
        ground="body",
    )
    assert not ok(Subject(aside), "fitted", **fits)


def test_a_drawer_that_opens_to_the_back_does_not_come_to_the_front() -> None:
    def chest(sign: float) -> Subject:
        slide = SE3.rot_x(sign * 3.14159265 / 2)  # z is along -y or y
        parts = [Part.from_mesh(name, placed(box(80, 80, 20), 0, 0, z), density=1000) for name, z in (("carcase", 0), ("drawer", 20.1))]
        slides = joint("slide", "slider", ("carcase", slide), ("drawer", slide), limits=[(0.0, 60.0)])
        return Subject(Assembly.from_parts("chest", parts=parts, joints=[slides], ground="carcase"))

    comes = {"joint": {"type": "slider"}, "toward": [0, -1, 0], "mm": [59, 61], "number": [1, 1]}
    assert ok(chest(1), "reaches", **comes)
    assert not ok(chest(-1), "reaches", **comes)
    assert ok(chest(-1), "reaches", **(comes | {"toward": [0, 1, 0]}))
