"""Large products: the nearest cheap answer to each is refused, by a check that looks at the module in question."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Final, NamedTuple

import numpy as np
import pytest

from articad.assembly import Assembly
from articad.connectors import SE3
from articad.geometry import cylinder
from articad_bench.reference import reference
from articad_bench.subject import Subject
from articad_bench.task import TASKS, tasks_in
from tests.bench.wrong import changed, shaped_as

pytestmark = pytest.mark.slow
LARGE: Final = {task.name: (folder, task) for folder, task in tasks_in(TASKS) if task.name.startswith("large_")}


class Module(NamedTuple):
    """Parts of a reference that its wrong variants change.

    Attributes:
        parts: One module: left out, or beside its place.
        aside: By how much it lies beside its place [mm].
        turned: What is turned round, upside down too where it is a single part.
        bought: A bought part, in whose place a plain cylinder of another size lies.
    """

    parts: Sequence[str]
    aside: tuple[float, float, float]
    turned: Sequence[str]
    bought: str


def numbered(number: int, *names: str) -> list[str]:
    return [f"{name}_{number}" for name in names]


COUNTER: Final = ("pedestal_a", "pedestal_b", "bearing_a", "bearing_b", "countershaft", "driven", "work")
STAND: Final = ("tray", "post", "jaw", "bolt", "nut", "knob", "screw_a", "screw_b")
MODULES: Final = {
    "large_conveyor": Module(
        numbered(7, "axle", "roller", "bearing_left", "bearing_right", "screw_left", "screw_right"), (5, 0, 0), ["screw_left_5"], "bearing_left_3"
    ),
    "large_drawers": Module(numbered(6, "box", "face", "knob", "screw_a", "screw_b"), (0, 0, 8), ["box_9"], "knob_4"),
    "large_bookcase": Module(numbered(3, "door", "handle", "pivot_low", "pivot_top"), (15, 0, 0), ["handle_2"], "pin_20"),
    "large_louvre": Module(numbered(9, "blade", "pin_left", "pin_right", "bush_left", "bush_right"), (0, 0, 4), ["bush_left_4"], "pin_left_12"),
    "large_lineshaft": Module(numbered(3, *COUNTER), (20, 0, 0), numbered(2, *COUNTER), "main_bearing_2"),
    "large_crane": Module(["wheel_left_1", "axle_left_1"], (30, 0, 0), ["wheel_right_2"], "runner_1_2"),
    "large_rover": Module(["motor_middle_l", "wheel_middle_l"], (20, 0, 0), ["wheel_rear_r"], "ring_front_l"),
    "large_carillon": Module(
        numbered(5, "bracket_low", "pin_low", "lever_low", "stick_low"), (3, 0, 0), numbered(7, "bracket_low", "pin_low", "lever_low", "stick_low"), "pin_high_4"
    ),
    "large_bike_rack": Module(numbered(6, *STAND), (20, 0, 0), numbered(4, *STAND), "nut_3"),
}  # fmt: skip
CI: Final = ("large_carillon", "beside")


@cache
def built(name: str) -> Assembly:
    return reference(*LARGE[name])


def left_out(assembly: Assembly, module: Module) -> Assembly:
    gone = set(module.parts)
    joints = [joint for joint in assembly.joints if not gone & {joint.parent, joint.child}]
    names = {joint.name for joint in joints}
    couplings = [each for each in assembly.mechanism.couplings if {each.a.split(".")[0], each.b.split(".")[0]} <= names]
    return changed(assembly, [part for part in assembly.parts.values() if part.name not in gone], joints, couplings=couplings)


def beside(assembly: Assembly, module: Module) -> Assembly:
    return moved(assembly, module.parts, SE3.from_translation(np.array(module.aside, dtype=np.float64)))


def turned_round(assembly: Assembly, module: Module) -> Assembly:
    middle = SE3.from_translation(Subject(assembly).corners(Subject(assembly).rest, module.turned).mean(axis=0))
    return moved(assembly, module.turned, middle @ SE3.rot_z(np.pi) @ middle.inverse())


def replaced(assembly: Assembly, module: Module) -> Assembly:
    mesh = assembly.parts[module.bought].mesh
    assert mesh is not None
    place = SE3.from_translation(mesh.bounds.mean(axis=0))
    plain = cylinder(0.6 * float(np.ptp(mesh.bounds, axis=0).max()), float(np.ptp(mesh.bounds, axis=0).min())).transformed(place)
    return changed(assembly, [shaped_as(part, plain) if part.name == module.bought else part for part in assembly.parts.values()])


def moved(assembly: Assembly, names: Sequence[str], motion: SE3) -> Assembly:
    """Return an assembly in which parts lie elsewhere at rest; their joints stay."""
    rest, parts = Subject(assembly).rest, []
    for part in assembly.parts.values():
        own = rest[part.name].inverse() @ motion @ rest[part.name]
        parts.append(shaped_as(part, part.mesh.transformed(own)) if part.name in names and part.mesh is not None else part)
    return changed(assembly, parts)


ANSWERS: Final = {"left_out": left_out, "beside": beside, "turned_round": turned_round, "replaced": replaced}
REFUSED_BY: Final = {"left_out": {"parts"}, "beside": {"spaced"}, "turned_round": {"turned", "spaced"}, "replaced": {"part_size"}}


@pytest.mark.parametrize(
    ("name", "answer"),
    [pytest.param(name, answer, marks=() if (name, answer) == CI else pytest.mark.soak) for name in LARGE for answer in ANSWERS],
)
def test_one_wrong_module_is_refused(name: str, answer: str) -> None:
    task, assembly = LARGE[name][1], built(name)
    wrong = Subject(ANSWERS[answer](assembly, MODULES[name]))

    assert any(not check.judge(wrong).ok for check in task.checks if check.kind in REFUSED_BY[answer])


def test_every_large_product_has_thirty_to_a_hundred_and_fifty_parts_and_its_wrong_modules() -> None:
    counts = {name: next(check.number for check in task.checks if check.kind == "parts") for name, (_, task) in LARGE.items()}

    assert set(MODULES) == set(LARGE)
    assert all(30 <= low <= high <= 150 for low, high in counts.values()), counts
