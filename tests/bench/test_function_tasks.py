"""The nearest cheap answers to tasks of function and of stacks fail: an obvious first size, a motion that ends too early, sizes that fit without tolerances."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from typing import Any, Final

import pytest

from articad.assembly import Assembly
from articad_bench.function_checks import Folds
from articad_bench.heading import is_directed
from articad_bench.reference import reference
from articad_bench.subject import Subject
from articad_bench.task import TASKS, tasks_in

IN_CI = ("stack_shaft_two_bearings", "brief_wall_shelf_files")


def sizes(part: str, **values: float) -> dict[str, float]:
    return {f"parts.{part}.dimensions.{name}": value for name, value in values.items()}


CHEAP: dict[str, tuple[dict[str, Any], str]] = {
    # 19 mm chipboard, as it is sold
    "brief_wall_shelf_files": ({key: 19 for name in ("lower", "middle", "upper") for key in sizes(f"board_{name}", high=19)}, "carries"),
    # legs that fold half the way
    "brief_step_stool_folding": ({"joints.swing_l.angle_deg": [-45, 0]}, "folds"),
    # a base as wide as the bed
    "brief_table_bedside": (sizes("base", long=800, deep=720), "passes"),
    # struts that do not come back to the post
    "brief_music_stand_flat": ({"joints.swing_l.angle_deg": [-10, 15]}, "folds"),
    # a crank as short as a hand
    "brief_table_lifting_crank": (sizes("crank", long=150), "effort"),
    # battens of half the height
    "brief_rack_crates": (
        {key: 20 for name in ("low", "mid", "high") for side in ("front", "back") for key in sizes(f"rail_{name}_{side}", high=20)},
        "carries",
    ),
    # no more weight than a hand can lift
    "brief_gate_picket_level": (sizes("weight", long=60), "effort"),
    # a weight as heavy as the head alone
    "brief_lamp_counterweight": (sizes("weight", long=30), "effort"),
    # a thin lid
    "brief_chest_blankets": (sizes("lid", thick=9), "carries"),
    # a board of 12 mm
    "brief_desk_wall_folding": (sizes("flap", thick=12), "carries"),
    # a batten that ends before the leaf
    "brief_trolley_leaf": (sizes("batten", long=200), "carries"),
    # a plank of 28 mm
    "brief_bench_plank": (sizes("plank", high=28), "carries"),
    # a bar that only looks heavy
    "brief_hatch_cellar": (sizes("bar", radius=25), "effort"),
    # rails of 12 mm
    "brief_rack_towels_swinging": (
        {key: 12 for name in ("lower", "middle", "upper") for key in sizes(f"rail_{name}", high=12)},
        "carries",
    ),
    # the sum of the sizes between shoulder and ring, and nothing left
    "stack_shaft_two_bearings": (sizes("spacer", long=30.11), "stack"),
    "stack_drawer_runners": (sizes("drawer", wide=361), "stack"),
    # the fit that is used most
    "stack_hinge_five_knuckles": (
        {"joints.swing.fit.name": "H7/g6"} | sizes("pin", radius=3.996) | sizes("leaf_fixed", bore=7.992) | sizes("ring", inner=3.996),
        "stack",
    ),
    "stack_piston_pin": ({"joints.swing.fit.name": "H7/g6"}, "stack"),
    "stack_plates_on_studs": ({"parameters.bush.value": 26}, "stack"),
    "stack_slide_gib": (sizes("bed", channel=45.0), "stack"),
}


def test_each_task_of_function_has_a_cheap_answer() -> None:
    names = [task.name for _, task in tasks_in(TASKS) if task.name.startswith(("brief_", "stack_"))]

    assert sorted(CHEAP) == names


def test_what_is_folded_all_the_time_is_not_open() -> None:
    """Sides are compared by size: a demand on the longest side alone may be met by the folded product."""
    for _, task in tasks_in(TASKS):
        for check in task.checks:
            if isinstance(check, Folds) and any(check.opens):
                opened = sorted(side or 0.0 for side in check.opens)
                assert any(side > folded for side, folded in zip(opened, sorted(check.into), strict=True)), task.name


DIRECTION: Final = re.compile(r"(?<!\d )(?<![\w.])[-+]?[xy]\b(?! \d)", re.IGNORECASE)
"""The name of an axis, which "900 x 450 mm" is not."""


@pytest.mark.parametrize(
    "name", [task.name for _, task in tasks_in(TASKS) if task.kind == "separating" and not task.images and not task.given]
)
def test_a_text_whose_checks_tell_x_from_y_names_one_of_them(name: str) -> None:
    ((_, task),) = tasks_in(TASKS, names=[name])

    assert task.may_turn or not any(map(is_directed, task.checks)) or DIRECTION.search(task.prompt)


@pytest.mark.slow
@pytest.mark.parametrize("name", [pytest.param(name, marks=() if name in IN_CI else pytest.mark.soak) for name in CHEAP])
def test_the_nearest_cheap_answer_fails_where_it_is_cheap(name: str) -> None:
    ((folder, task),) = tasks_in(TASKS, names=[name])
    changes, kind = CHEAP[name]

    cheap = Subject(reference(folder, task).with_changes(changes))

    failed = [check for check in task.checks if check.kind == kind and not check.judge(cheap).ok]
    assert failed


def resting(assembly: Assembly, joint: str, value: float) -> Assembly:
    """Return an assembly of which one joint rests elsewhere."""
    joints = tuple(replace(each, rest=(value,)) if each.name == joint else each for each in assembly.joints)
    return replace(assembly, mechanism=assembly.mechanism.changed(joints=joints))


SUPPORTED = {"brief_desk_wall_folding": ("swing", -math.pi / 2), "brief_trolley_leaf": ("draw", -200.0)}
"""The joint of the support, and where it is put away."""


@pytest.mark.slow
@pytest.mark.soak
@pytest.mark.parametrize("name", SUPPORTED)
def test_a_leaf_is_proven_to_drop_once_its_support_is_away_and_not_before(name: str) -> None:
    """It is a soak test because the whole product is built. The support moves under the leaf; the leaf moves without it."""
    ((folder, task),) = tasks_in(TASKS, names=[name])
    support, away = SUPPORTED[name]
    drawn = reference(folder, task)

    assert drawn.certify([support], pairs=False, budget=300).ok
    assert resting(drawn, support, away).certify(["drop"], pairs=False, budget=300).ok
    refused = drawn.certify(["drop"], pairs=False, budget=300)
    assert refused.findings.codes == ("E_MOTION_COLLISION",)
