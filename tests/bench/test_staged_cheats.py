"""What was there already, or all but one of the changes, is no answer to a task that begins with a product or goes on after it."""

from __future__ import annotations

import json
import math
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import articad_bench
from articad.assembly import Assembly
from articad.geometry import Part, box
from articad.kinematics import Coupling, Joint, JointLimits
from articad_bench.cheat_run import _SOURCES, _digest, _judged, run_cheats, the_same
from articad_bench.reference import reference_folders
from articad_bench.staged_cheats import alike, staged_cheats
from articad_bench.task import TASKS, Task, tasks_in
from tests.assemblies import four_bar
from tests.kinematics.linkages import at, joint

STAGED = "chain_tool_tote"


def product(*, plate: float = 80.0, levers: float = 60.0, turn: float = 1.5, ratio: float = -1.0) -> Assembly:
    """A plate with two levers of the same shape that turn against each other."""
    bodies = {"plate": box(plate, 40, 6), "left": box(levers, 8, 8), "right": box(levers, 8, 8)}
    parts = [Part.from_mesh(name, mesh, density=1000) for name, mesh in bodies.items()]
    joints = [
        joint(name, "revolute", ("plate", at(0, 20 * i)), (name, at(0)), limits=[(-turn, turn)]) for i, name in enumerate(("left", "right"))
    ]
    return Assembly.from_parts(
        "levers", parts=parts, joints=joints, ground="plate", couplings=[Coupling("pair", "linear", "left", "right", ratio)]
    )


def made(begun: Assembly | None, *stages: Assembly, kind: str) -> dict[str, Assembly]:
    found = [cheat for cheat in staged_cheats(begun, stages) if cheat.kind == kind]
    products = {f"{cheat.stage}: {cheat.what}": cheat.make() for cheat in found}
    assert len(products) == len(found)
    return {name: each for name, each in products.items() if each is not None}


def test_what_is_given_and_every_other_stage_are_answers_to_each_stage() -> None:
    begun, first, second = product(), product(plate=90), product(plate=100)

    assert made(begun, first, second, kind="given") == {"0: ": begun}
    assert made(begun, first, second, kind="stage") == {
        "0: edit 1 in place of the first product": second,
        "1: what is given in place of edit 1": begun,
        "1: the first product in place of edit 1": first,
    }
    assert made(None, first, kind="stage") == {}
    assert {cheat.before for cheat in staged_cheats(begun, [first, second]) if cheat.stage == 1} == {first}


def test_each_change_is_left_out_once_and_of_parts_that_change_alike_one() -> None:
    begun, right = product(), product(plate=90, levers=70, turn=1.2, ratio=-0.5)

    found = made(begun, right, kind="partly")

    named = {name.removeprefix("0: the first product with ").removesuffix(" as before") for name in found}
    assert named == {"plate", "left", "joint left", "joint right", "the couplings"}
    lever = found["0: the first product with left as before"]
    assert {name: part.mesh and part.mesh.bounds[1, 0] for name, part in lever.parts.items()} == {"plate": 45, "left": 30, "right": 35}
    held = found["0: the first product with joint left as before"]
    assert [each.limits.upper for each in held.joints] == [(1.5,), (1.2,)]
    assert made(begun, product(plate=90), kind="partly") == {}  # without its only change it is what was given


def test_each_side_that_has_changed_with_another_stays_as_long_as_it_was_once() -> None:
    begun, right = product(), product(plate=90, levers=70)
    larger = replace(right, parts={**right.parts, "plate": Part.from_mesh("plate", box(90, 50, 6), density=1000)})

    found = made(begun, larger, kind="side")

    sides = {name: each.parts["plate"].mesh for name, each in found.items()}
    assert {name: mesh and np.ptp(mesh.bounds, axis=0).round(6).tolist() for name, mesh in sides.items()} == {
        "0: the first product with plate along x as before": [80, 50, 6],
        "0: the first product with plate along y as before": [90, 40, 6],
    }
    assert made(begun, right, kind="side") == {}  # of each part one side has changed


def test_joints_that_go_half_as_far_start_where_they_did() -> None:
    (short,) = made(product(), product(plate=90), kind="short").values()
    assert [(each.limits.lower, each.limits.upper) for each in short.joints] == [((-0.75,), (0.75,))] * 2

    pin: Joint = replace(product().joints[0], limits=JointLimits((-math.inf,), (math.inf,)))
    endless = Assembly.from_parts("pin", parts=list(product().parts.values())[:2], joints=[pin], ground="plate")
    (same,) = made(product(), endless, kind="short").values()
    assert the_same("short", endless, same)


def test_a_product_is_itself_in_shapes_joints_and_couplings() -> None:
    assert alike(product(), product())
    assert [alike(product(), other) for other in (product(plate=90), product(turn=1.0), product(ratio=1.0))] == [False] * 3


@pytest.mark.parametrize(("wider", "same"), [("right", True), ("left", True), ("both", False)])
def test_limits_that_another_joint_decides_make_no_other_product(wider: str, same: bool) -> None:
    limits = JointLimits((-1.8,), (1.8,))
    joints = [replace(each, limits=limits) if wider in (each.name, "both") else each for each in product().joints]
    assert alike(product(), replace(product(), mechanism=product().mechanism.changed(joints=joints))) is same


@pytest.mark.parametrize("name", ["b", "c"])
def test_where_a_joint_of_a_loop_is_said_to_rest_makes_no_other_product(name: str) -> None:
    known = four_bar()
    joints = [replace(each, rest=(each.rest[0] + 0.01,)) if each.name == name else each for each in known.joints]
    assert alike(known, replace(known, mechanism=known.mechanism.changed(joints=joints)))


def test_every_module_of_checks_and_every_folder_of_a_stage_makes_answers_of_before_old(tmp_path: Path) -> None:
    modules = {file.name for file in Path(articad_bench.__file__).parent.glob("*checks.py")}
    assert modules <= set(_SOURCES)

    ((folder, task),) = tasks_in(TASKS, names=[STAGED])
    copy = tmp_path / STAGED
    shutil.copytree(folder, copy)
    before = _digest(copy, task)
    places = reference_folders(copy, task)
    assert [place.name for place in places] == ["given", "reference", "edited_1", "edited_2", "edited_3", "edited_4"]
    for place in places:
        (place / "plan.json").write_text((place / "plan.json").read_text() + "\n")
        assert _digest(copy, task) != before, place.name
        before = _digest(copy, task)


@pytest.mark.slow
def test_the_product_as_it_was_given_is_refused_and_passes_where_nothing_is_asked_for(tmp_path: Path) -> None:
    chosen = tasks_in(TASKS, names=["repair_bookcase"])

    (row,) = (row for row in run_cheats(chosen, tmp_path, every=chosen)["rows"] if row["cheat"] == "given")

    assert row["refused_by"] == "size"
    folder, task = chosen[0]
    nothing = task.model_copy(update={"checks": tuple(check for check in task.checks if check.kind in {"parts", "solids"})})
    report = run_cheats([(folder, nothing)], tmp_path, every=[(folder, nothing)])
    assert ["repair_bookcase", "given"] in report["passed"]
    assert "- `repair_bookcase`: given" in (tmp_path / "cheats.md").read_text()
    assert json.loads((tmp_path / "cheats.json").read_text())["ok"] is False


def test_an_answer_of_a_stage_is_held_to_the_checks_of_that_stage() -> None:
    edit = {"prompt": "100 mm long.", "checks": [{"kind": "size", "mm": [100, None, None]}], "reference": "edited"}
    rows = {"name": "levers", "kind": "separating", "product": "levers", "checks": [{"kind": "parts", "number": [3, 3]}], "edits": [edit]}
    task = Task.model_validate(rows)

    found = [_judged(task, cheat, "") for cheat in staged_cheats(None, [product(plate=90), product(plate=100)])]

    assert {(row.what, row.refused_by) for row in found if row and row.cheat == "stage"} == {
        ("edit 1 in place of the first product", None),
        ("the first product in place of edit 1", "size"),
    }


def test_crumbs_stay_where_parts_were_to() -> None:
    first, second = product(), product(plate=90)
    (cheat,) = (cheat for cheat in staged_cheats(None, [first, second]) if cheat.kind == "crumbs")
    after = cheat.make()
    assert after is not None
    assert cheat.before is not None
    shapes = [{part.mesh.digest for part in each.parts.values() if part.mesh is not None} for each in (cheat.before, after)]

    assert len(after.parts) == len(cheat.before.parts) == 3 + 2
    assert len(shapes[0] & shapes[1]) == 1  # the crumbs alone, which are all alike
    assert [cheat for cheat in staged_cheats(first, [second]) if cheat.kind == "crumbs"] == []
