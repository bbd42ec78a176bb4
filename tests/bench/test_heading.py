"""A product may point where it likes, unless a text says what lies along x or y."""

from __future__ import annotations

import math
from typing import Any

import pytest

from articad.connectors import SE3
from articad.geometry import box
from articad_bench.heading import is_directed, names_direction
from articad_bench.subject import Subject
from articad_bench.task import Task
from tests.bench.test_checks import form
from tests.bench.test_function_checks import LEVEL, of, placed
from tests.kinematics.linkages import joint

FREE = "A flap on a level pin, 300 x 100 mm; it swings by 80 degrees."
NAMED = "A flap on a level pin along y, 300 x 100 mm; it swings by 80 degrees."


def flap(quarters: int) -> Subject:
    """A bar of 260 mm that swings on a pin along y, on a post; the whole turned."""
    bodies = ("post", placed(box(40, 100, 40), 0, 0, -40)), ("bar", placed(box(260, 20, 20), 150, 0, 0))
    pin = joint("pin", "revolute", ("post", LEVEL), ("bar", LEVEL), limits=[(-math.radians(80), 0.0)])
    return Subject(of(*bodies, joints=[pin])).turned(quarters)


def task(prompt: str, **also: Any) -> Task:
    rows = [
        {"kind": "size", "mm": [300, 100, 70]},
        {"kind": "joints", "joint": {"type": "revolute", "axis": [0, 1, 0], "span": [79, 81]}, "number": [1, 1]},
        {"kind": "reaches", "joint": {"type": "revolute"}, "toward": [-1, 0, 0], "mm": [100, 140]},
        {"kind": "parts", "number": [2, 2]},
    ]
    return Task.model_validate({"name": "flap", "kind": "articulated", "product": "flap", "prompt": prompt, "checks": rows} | also)


@pytest.mark.parametrize("quarters", range(4))
def test_a_product_may_stand_turned_where_no_text_names_a_direction(quarters: int) -> None:
    wrong = [str(row) for row in task(FREE).judge(flap(quarters)) if not row.ok]

    assert wrong == []


@pytest.mark.parametrize("quarters", range(1, 4))
@pytest.mark.parametrize("also", [{"prompt": NAMED}, {"given": "given"}, {"edits": [{"prompt": "Make it longer along x.", "checks": []}]}])
def test_it_may_not_where_a_text_names_one_or_a_product_is_there(also: dict[str, Any], quarters: int) -> None:
    assert not all(row.ok for row in task(**({"prompt": FREE} | also)).judge(flap(quarters)))


@pytest.mark.parametrize("mm", [[300, 101, 80], [100, 300, 80], [300, 100, 60]])
def test_no_turn_mends_a_wrong_size(mm: list[float]) -> None:
    asked = task(FREE)
    checks = (form({"kind": "size", "mm": mm, "tolerance": 1e-3}), *asked.checks[1:])

    assert not all(row.ok for row in asked.model_copy(update={"checks": checks}).judge(flap(0)))


def test_a_turn_keeps_what_the_product_is() -> None:
    first, second = flap(0), flap(1)
    corner = SE3.rot_z(math.pi / 2).apply(first.corners(first.rest))

    assert sorted(map(abs, corner.ravel())) == pytest.approx(sorted(map(abs, second.corners(second.rest).ravel())))
    assert second.assembly.parts is not None
    assert {name: part.mesh.digest for name, part in second.assembly.parts.items() if part.mesh} == {
        name: part.mesh.digest for name, part in first.assembly.parts.items() if part.mesh
    }


@pytest.mark.parametrize("text", ["slides along x", "(front -y)", "about Y,", "its X axis", "toward +x is"])
def test_a_text_names_an_axis(text: str) -> None:
    assert names_direction(["A box.", text])


@pytest.mark.parametrize("text", ["300 x 100 mm", "700 mm x 200 mm", "an x-ray lamp"[:2], "a box by 20x30", "upright (z)", "a boxy car"])
def test_a_text_names_none(text: str) -> None:
    assert not names_direction([text])


@pytest.mark.parametrize(
    ("row", "directed"),
    [
        ({"kind": "size", "mm": [10, 20, 5]}, True),
        ({"kind": "size", "mm": [10, 10, 5]}, False),
        ({"kind": "rise", "axis": "x", "mm": [1, 2]}, True),
        ({"kind": "rise", "mm": [1, 2]}, False),
        ({"kind": "stack", "along": [1, 0, 0], "mm": [0, 1]}, True),
        ({"kind": "stack", "mm": [0, 1]}, False),
        ({"kind": "travel", "joint": {"type": "slider", "axis": [0, 1, 0]}, "by": [1, 2]}, True),
        ({"kind": "travel", "joint": {"type": "slider", "axis": [0, 0, 1]}, "by": [1, 2]}, False),
        ({"kind": "extent", "side": "y", "mm": [1, 2]}, True),
        ({"kind": "stack", "plays": [{"joint": {"type": "revolute", "axis": [1, 0, 0]}}], "mm": [0, 1]}, True),
        ({"kind": "parts", "number": [1, 2]}, False),
    ],
)
def test_a_check_tells_x_from_y(row: dict[str, Any], directed: bool) -> None:
    assert is_directed(form(row)) is directed
