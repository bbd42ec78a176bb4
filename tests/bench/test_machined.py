"""Parts are inspected as a workshop would: each hole and shoulder in its place, each fitted diameter within its limits."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest

from articad.assembly import Assembly
from articad.connectors import SE3
from articad.geometry import TriMesh, box, cylinder
from articad.kernels.choice import kernel_named
from articad.plan.amending import amended
from articad.plan.schema import AssemblyPlan
from articad_bench.cheat_run import refused_by
from articad_bench.checks import Parts
from articad_bench.machined_checks import Machined, Toleranced, machined
from articad_bench.reference import reference, reference_folder
from articad_bench.sentences import numbers_of
from articad_bench.subject import Subject
from articad_bench.task import TASKS, Task, tasks_in
from tests.bench.test_cheats import TURN, made, of, placed, solid
from tests.kinematics.linkages import at, joint

HOLES = ((20.0, 10.0, 9.0, 6.0), (-20.0, 10.0, 9.0, 6.0), (-24.0, -12.0, 5.0, 4.0))  # x, y, depth, diameter


def plate(
    holes: tuple[tuple[float, float, float, float], ...] = HOLES, *, counterbore: float = 3.0, at_z: float = 10.0, segments: int = 48
) -> TriMesh:
    """A plate of 80 x 50 x 20 mm with blind holes from above, and one that is counterbored."""
    tools = [solid(placed(cylinder(d / 2, 2 * depth, segments), x, y, at_z)) for x, y, depth, d in holes]
    tools += [solid(placed(cylinder(3.5, 60, segments), 26, -15, 0))]
    tools += [solid(placed(cylinder(6, 2 * counterbore, segments), 26, -15, at_z))] if counterbore else []
    return made("Subtract", solid(box(80, 50, 20)), *tools)


def one(mesh: TriMesh) -> Subject:
    return of(("plate", mesh), joints=[])


@pytest.mark.parametrize("segments", [48, 60])
def test_a_part_is_the_same_in_any_frame_and_tessellation(segments: int) -> None:
    (check,) = machined(one(plate()))

    assert check.judge(one(plate(segments=segments))).ok
    assert check.judge(one(plate().transformed(TURN))).ok


@pytest.mark.parametrize(
    ("name", "mesh"),
    [
        ("its mirror image", plate().reflected(np.diag([1.0, -1.0, 1.0, 1.0]))),
        ("a mirrored pattern", plate(tuple((-x, y, depth, d) for x, y, depth, d in HOLES))),
        ("no counterbore", plate(counterbore=0)),
        ("a through hole for a blind one", plate((*HOLES[:2], (-24.0, -12.0, 40.0, 4.0)))),
        ("a hole beside its place", plate((*HOLES[:2], (-23.0, -12.0, 5.0, 4.0)))),
        ("a hole of another diameter", plate((*HOLES[:2], (-24.0, -12.0, 5.0, 4.4)))),
        ("a hole of another depth", plate((*HOLES[:2], (-24.0, -12.0, 6.0, 4.0)))),
        ("a hole too many", plate((*HOLES, (0.0, 0.0, 1.0, 4.0)))),
        ("a hole less", plate(HOLES[:2])),
        ("holes from below, which is its mirror image", plate(at_z=-10.0)),
    ],
)
def test_what_is_nearly_the_part_is_refused(name: str, mesh: TriMesh) -> None:
    (check,) = machined(one(plate()))
    judged = check.judge(one(mesh))

    assert not judged.ok, name


def test_equal_parts_are_counted_and_parts_without_holes_told_by_volume() -> None:
    held = [joint(name, "fixed", ("a", at(0)), (name, at(0))) for name in "bc"]
    subject = of(("a", box(10, 10, 10)), ("b", placed(box(10, 10, 10), 30, 0, 0)), ("c", placed(box(10, 10, 12), 60, 0, 0)), joints=held)

    assert [(check.cm3, check.number) for check in machined(subject)] == [(1.0, (2.0, 2.0)), (1.2, (1.0, 1.0))]
    assert all(check.judge(subject).ok for check in machined(subject))


def test_a_block_of_the_same_volume_is_another_part() -> None:
    """Sides of 10, 10 and 12 mm, and of 9, 10 and 13.33 mm: radii of gyration of 4.08 to 4.51 mm, and of 3.88 to 4.81 mm."""
    (check,) = machined(one(box(10, 10, 12)))

    assert check.spread == pytest.approx((math.sqrt(200 / 12), math.sqrt(244 / 12), math.sqrt(244 / 12)), rel=1e-4)
    assert check.judge(one(box(10.05, 10, 11.95).transformed(TURN))).ok
    judged = check.judge(one(box(9, 10, 12 * 10 / 9)))
    assert not judged.ok
    assert "radii of gyration" in judged.measured


def test_a_turned_part_is_told_by_its_shoulders_and_by_their_order() -> None:
    def turned(*steps: tuple[float, float]) -> TriMesh:
        start, bodies = 0.0, []
        for diameter, length in steps:
            bodies.append(solid(placed(cylinder(diameter / 2, length, 48), 0, 0, start + length / 2)))
            start += length
        return made("Add", *bodies)

    steps = ((30.0, 10.0), (20.0, 25.0), (18.0, 2.0), (20.0, 6.0))
    (check,) = machined(one(turned(*steps)))

    assert check.judge(one(turned(*steps[::-1]).transformed(TURN))).ok
    assert not check.judge(one(turned(steps[1], steps[0], *steps[2:]))).ok
    assert not check.judge(one(turned(steps[0], steps[1], steps[3]))).ok


def bearing(bore: float, pin: float) -> Subject:
    ring = made("Subtract", solid(cylinder(25, 20, 96)), solid(cylinder(bore / 2, 40, 96)))
    turn = joint("turn", "revolute", ("ring", at(0)), ("pin", at(0)), limits=[(0.0, 3.0)])
    return of(("ring", ring), ("pin", placed(cylinder(pin / 2, 60, 96), 0, 0, 10)), joints=[turn])


@pytest.mark.parametrize(
    ("bore", "pin", "ok"), [(20.010, 19.970, True), (20.0, 19.98, True), (20.0, 20.0, False), (20.05, 19.97, False), (20.01, 19.95, False)]
)
def test_a_fit_is_held_by_both_of_its_diameters(bore: float, pin: float, ok: bool) -> None:
    """20 H7 is 20.000 to 20.021 mm, f7 19.959 to 19.980 mm (ISO 286-2)."""
    judged = Toleranced(nominal=20, bore="H7", pin="f7", number=(1, 1)).judge(bearing(bore, pin))
    assert judged.ok is ok, judged.measured


def test_a_pin_beside_a_bore_is_no_fit() -> None:
    aside = bearing(20.01, 19.97).assembly
    moved = [(name, part.mesh.transformed(SE3.trans(0, 0, 60.0 * (name == "pin")))) for name, part in aside.parts.items() if part.mesh]
    judged = Toleranced(nominal=20, bore="H7", pin="f7", number=(1, 1)).judge(of(*moved, joints=list(aside.joints)))
    assert not judged.ok
    assert judged.measured == "0 (no pin in a bore)"


# ---------------------------------------------------------------------- the tasks

NEAR: dict[str, tuple[dict[str, float], ...]] = {
    "sheet_housing_flanged": ({"housing.dowel_hole_depth": 30}, {"housing.counterbore_diameter": 9}, {"housing.square_pitch": 85}),
    "sheet_plate_fixture": ({"plate.tapped_depth": 40}, {"plate.counterbore_diameter": 6.6}, {"plate.slot_depth": 18}),
    "sheet_body_gear_pump": ({"body.blind_bearing_depth": 40}, {"body.spacing": 31}, {"body.dowel_depth": 13}),
    "sheet_block_pillow": ({"shaft.journal_diameter": 30, "ring.inside_diameter": 30}, {"block.counterbore_diameter": 11}),
    "sheet_block_v": ({"block.tapped_depth": 100}, {"block.relief_depth": 46}, {"screw.cross_hole_diameter": 5}),
    "sheet_spindle_stepped": ({"spindle.journal_diameter": 20}, {"spindle.centre_bore_depth": 120}),
    "sheet_stage_dovetail": ({"base.dowel_depth": 30}, {"carriage.bore_depth": 14}),
    "sheet_clamp_pipe": ({"upper.bore_diameter": 8, "bolt.bore_diameter": 8}, {"lower.foot_pitch_x": 79}),
    "sheet_hinge_bushed": ({"bushing_lower.bore_diameter": 10.06}, {"leaf_moving.counterbore_depth": 6}),
    "sheet_clamp_quick": ({"lever.bore_diameter": 10.3}, {"collar.lip_diameter": 34.9}),
    "sheet_clevis_rod": ({"eye.bore_diameter": 10.2, "fork.bore_diameter": 10.2}, {"pin.grease_hole_depth": 60}, {"eye.cross_hole_x": 64}),
    "photo_trolley_sack": ({"wheel_left.diameter": 200}, {"frame.height": 1000}),
    "photo_swing_garden": ({"bench.drop": 1000}, {"stand.spread": 400}),
    "photo_barrier_boom": ({"cabinet.height": 1300}, {"boom.weight_length": 60}),
    "photo_chest_blanket": ({"lid.depth": 700}, {"lid.thickness": 120}),
    "photo_mill_pepper": ({"body.foot_diameter": 44}, {"crank.dome_diameter": 30}),
    "photo_cabinet_card": ({"drawer.width": 150}, {"drawer.height": 70}),
}
"""The nearest cheap answers by task: the reference with other dimensions."""
MIRRORED = ("sheet_plate_fixture", "sheet_housing_flanged", "sheet_body_gear_pump")


@cache
def task_of(name: str) -> Task:
    ((_, task),) = tasks_in(TASKS, names=[name])
    return task


def changed(name: str, values: dict[str, float]) -> Assembly:
    place = reference_folder(TASKS / name, task_of(name))
    rows = {f"parts.{part}.dimensions.{dimension}": value for (part, dimension), value in ((k.split("."), v) for k, v in values.items())}
    plan = AssemblyPlan.from_json(amended(AssemblyPlan.load(place).to_json(), rows))
    return Assembly.from_plan(plan, place / "parts", kernel=kernel_named(plan.kernel))


def test_sheets_hold_every_part_and_photos_have_one_dimension_alone() -> None:
    for _, task in tasks_in(TASKS, kind="separating"):
        if task.drawing is None:
            continue
        kinds = [check.kind for check in task.checks]
        if task.drawing.form == "sheets":
            parts = sum(check.number[0] for check in task.checks if isinstance(check, Machined))
            assert {(parts, parts)} == {check.number for check in task.checks if isinstance(check, Parts)}, task.name
        if task.drawing.form == "photos":
            lengths = [number for number in numbers_of(task) if number.unit == "mm"]
            assert len(lengths) == 1, task.name
            assert not {"machined", "toleranced", "gap", "links", "volume", "mass"} & set(kinds), task.name


@pytest.mark.slow
@pytest.mark.soak
@pytest.mark.parametrize("name", NEAR)
def test_what_is_nearly_drawn_does_not_pass(name: str) -> None:
    for values in NEAR[name]:
        assert refused_by(task_of(name), Subject(changed(name, values))) is not None, values


@pytest.mark.slow
@pytest.mark.soak
@pytest.mark.parametrize("name", MIRRORED)
def test_a_mirrored_pattern_of_holes_does_not_pass(name: str) -> None:
    subject = Subject(reference(TASKS / name, task_of(name)))
    (part,) = subject.shaped
    mesh = subject.assembly.parts[part].mesh
    assert mesh is not None
    assert refused_by(task_of(name), one(mesh.reflected(np.diag([1.0, -1.0, 1.0, 1.0])))) is not None
