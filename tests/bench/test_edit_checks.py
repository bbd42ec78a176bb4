"""Checks of an edit: what was to be moved lies elsewhere than before, and a clearance is that of whole bodies."""

from __future__ import annotations

import pytest

from articad.assembly import Assembly
from articad.geometry import Part, TriMesh, box
from articad_bench.subject import Subject
from tests.bench.test_cheats import made, of, placed, solid
from tests.bench.test_checks import form
from tests.kinematics.linkages import at, joint


def rod(*nuts: float, length: float = 180.0, in_place: bool = False) -> Assembly:
    """A rod along x with a cap at 0 and nuts, all alike; perhaps with the frames of the nuts in the middle, as STEP files have them."""
    own = [x if in_place else 0.0 for x in nuts]
    bodies = [
        ("rod", box(length, 5, 5)),
        ("cap", box(20, 30, 30)),
        *((f"nut_{i}", placed(box(10, 20, 20), x, 0, 0)) for i, x in enumerate(own)),
    ]
    fixed = [joint("cap", "fixed", ("rod", at(0)), ("cap", at(0)))]
    fixed += [joint(f"nut_{i}", "fixed", ("rod", at(x)), (f"nut_{i}", at(own[i]))) for i, x in enumerate(nuts)]
    return Assembly.from_parts("rod", parts=[Part.from_mesh(n, m, density=1000) for n, m in bodies], joints=fixed, ground="rod")


@pytest.mark.parametrize(
    ("after", "mm", "number", "expected"),
    [
        (rod(145, length=195), [14.9, 15.1], [1, 1], True),  # the rod is another one: cap and nut are a pair
        (rod(130, length=195), [14.9, 15.1], [1, 1], False),
        (rod(115, length=195), [14.9, 15.1], [1, 1], False),  # nearer
        (rod(-145, length=195), [14.9, 15.1], [1, 1], True),  # the product turned round
        (rod(130), [-0.1, 0.1], [3, 3], True),
        (rod(145), [14.9, 15.1], [2, 2], True),  # from the rod as well
        (rod(145, 100), [14.9, 15.1], [1, 9], False),  # which of two nuts it was, nobody knows
    ],
)
def test_how_much_farther_apart_what_is_unchanged_lies(after: Assembly, mm: list[float], number: list[int], expected: bool) -> None:
    check = form({"kind": "shifted", "axis": [1, 0, 0], "mm": mm, "number": number})

    assert check.judge(Subject(after, before=rod(130))).ok is expected
    assert not check.judge(Subject(after)).ok


@pytest.mark.parametrize("in_place", [False, True])
def test_a_part_that_lies_elsewhere_in_its_own_frame_is_unchanged(in_place: bool) -> None:
    before, after = rod(130.1, in_place=in_place), rod(145.4, in_place=in_place)
    rows = [{"kind": "unchanged", "number": [3, 3]}, {"kind": "shifted", "axis": [1, 0, 0], "mm": [15.2, 15.4], "number": [2, 2]}]

    assert all(form(row).judge(Subject(after, before=before)).ok for row in rows)
    assert form({"kind": "unchanged", "number": [2, 2]}).judge(Subject(rod(145.4, length=181, in_place=in_place), before=before)).ok


def bearing(cap_gap: float) -> Subject:
    """A square shaft between a base, 0.15 mm below it, and a cap that is fixed to the base, above it."""
    base, cap = placed(box(40, 40, 10), 0, 0, -15.15), placed(box(40, 40, 10), 0, 0, 15 + cap_gap)
    post = made("Add", solid(base), solid(placed(box(40, 4, 30), 0, -18, -5)))
    joints = [
        joint("cap", "fixed", ("base", at(0)), ("cap", at(0))),
        joint("turn", "revolute", ("base", at(0)), ("shaft", at(0)), limits=[(0.0, 1.0)]),
    ]
    shaft: TriMesh = box(60, 20, 20)
    return of(("base", post), ("cap", cap), ("shaft", shaft), joints=joints)


@pytest.mark.parametrize(("cap_gap", "ok"), [(0.15, True), (0.1, False)])
def test_a_clearance_is_that_of_the_whole_bearing_if_bodies_are_meant(cap_gap: float, ok: bool) -> None:
    row = {"kind": "gap", "joint": {"type": "revolute"}, "mm": [0.13, 0.17]}

    assert form(row | {"bodies": True}).judge(bearing(cap_gap)).ok is ok
    assert form(row).judge(bearing(cap_gap)).ok  # the base alone
