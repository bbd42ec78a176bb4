"""Threads of FreeCAD documents without articad's records: a screw beside a cylindrical joint, and a screw between a part that turns and one that slides."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Literal

import numpy as np
import pytest

from articad.assembly import Assembly
from articad.connectors.se3 import SE3
from articad.errors import ReadError
from articad.export.freecad import write_freecad_alone
from articad.importers.freecad import read_freecad
from articad.importers.freecad_couplings import Stated, threaded
from articad.kinematics import declare
from articad.kinematics.declare import MateName
from articad.kinematics.joints import Coupling, JointType
from tests.assemblies import block
from tests.bench.forms import rewrite, switch_on
from tests.random_mechanisms import random_frame as random_matrix


def random_frame(rng: np.random.Generator, size: float) -> SE3:
    return SE3.from_matrix(random_matrix(rng, size))


def read_back(assembly: Assembly, folder: Path) -> Assembly:
    """Return what a document says without articad's records, its threads switched on."""
    (file,) = write_freecad_alone(assembly).write(folder)
    switch_on(file)
    return read_freecad(file, metadata=False)


def screw(seed: int) -> Assembly:
    """A bolt in a plate: random frames, hand, lead, rest and limits, declared from either side."""
    rng = np.random.default_rng(seed)
    plate, bolt = block("plate", (40, 40, 8), on=random_frame(rng, 30.0)), block("bolt", (6, 6, 30), on=random_frame(rng, 30.0))
    rest, lead = rng.uniform(-9.0, 9.0), float(rng.choice([-1.0, 1.0])) * rng.uniform(0.4, 6.0)
    sides = [plate["on"], bolt["on"]]
    if rng.random() < 0.4:
        sides.reverse()
    limits: tuple[float, float] | Literal["endless"] = (
        "endless" if rng.random() < 0.2 else (rest - rng.uniform(0.1, 20.0), rest + rng.uniform(0.1, 20.0))
    )
    mate: MateName = "opposed" if rng.random() < 0.5 else "aligned"
    joint = declare.screw("thread", *sides, lead=lead, limits=limits, rest=rest, mate=mate)
    return Assembly.from_parts("screw", parts=[plate, bolt], joints=[joint], ground="plate", T_ground=random_frame(rng, 10.0))


@pytest.mark.parametrize("seed", range(12))
def test_a_screw_beside_a_cylindrical_joint_is_a_screw_joint(seed: int, tmp_path: Path) -> None:
    assembly = screw(seed)
    (joint,), (read,) = assembly.joints, read_back(assembly, tmp_path).joints
    again = read_freecad(next(tmp_path.glob("*.FCStd")), metadata=False)

    assert read.type is JointType.SCREW
    assert read.lead == pytest.approx(joint.lead)
    for value in joint.rest[0] + np.array([-3.0, 0.0, 0.7, 5.0]):
        for name in ("plate", "bolt"):
            offset = value - joint.rest[0]
            assert again.poses([read.rest[0] + offset])[again.mechanism.parts.index(name)].allclose(
                assembly.poses([value])[assembly.mechanism.parts.index(name)], mm=1e-6, rad=1e-8
            )
    spans = [np.subtract((j.limits.lower[0], j.limits.upper[0]), j.rest[0]) for j in (joint, read)]
    assert spans[1] == pytest.approx(spans[0], abs=1e-7)


@pytest.mark.parametrize("seed", range(8))
def test_a_thread_between_a_part_that_turns_and_one_that_slides_keeps_its_hand(seed: int, tmp_path: Path) -> None:
    rng = np.random.default_rng(seed)
    at = random_frame(rng, 20.0)
    flipped = SE3.rot_x(math.pi) if rng.random() < 0.5 else SE3.identity()
    base = block("base", (60, 60, 10), on=at, along=at @ flipped)
    spindle, nut = block("spindle", (6, 6, 60), on=random_frame(rng, 9.0)), block("nut", (20, 20, 10), on=random_frame(rng, 9.0))
    joints = [
        declare.revolute("turn", base["on"], spindle["on"], limits=(-30.0, 30.0), driver=True),
        declare.slider("shift", base["along"], nut["on"], limits=(-50.0, 50.0)),
    ]
    ratio = float(rng.choice([-1.0, 1.0])) * rng.uniform(0.1, 1.0)
    thread = Coupling("thread", "screw", "turn", "shift", ratio)
    assembly = Assembly.from_parts("spindle", parts=[base, spindle, nut], joints=joints, couplings=[thread], ground="base")

    (coupling,) = read_back(assembly, tmp_path).mechanism.couplings
    assert (coupling.a, coupling.b) == ("turn", "shift")
    assert coupling.ratio == pytest.approx(ratio)


def stages(seed: int) -> Assembly:
    """Stages that slide one on the other, across or along each other; a spindle that turns in the stage below moves each."""
    rng = np.random.default_rng(seed)
    number, ratios = int(rng.integers(2, 5)), []
    turned = [SE3.identity() if rng.random() < 0.4 else SE3.from_axis_angle(rng.normal(size=3), 1.2) for _ in range(number)]
    ways = [random_frame(rng, 20.0) for _ in range(number)]
    ways = [ways[level - 1] if level and turned[level].allclose(SE3.identity()) else way @ turned[level] for level, way in enumerate(ways)]
    on = [SE3.identity(), *(random_frame(rng, 9.0) for _ in range(number))]
    parts = [block(f"stage_{i}", (60, 60, 10), on=on[i], up=ways[min(i, number - 1)]) for i in range(number + 1)]
    spindles = [block(f"spindle_{i}", (6, 6, 60), on=random_frame(rng, 9.0)) for i in range(number)]
    joints, couplings = [], []
    for i in range(number):
        joints.append(declare.revolute(f"turn_{i}", parts[i]["up"], spindles[i]["on"], limits=(-30.0, 30.0), driver=True))
        joints.append(declare.slider(f"shift_{i}", parts[i]["up"], parts[i + 1]["on"], limits=(-50.0, 50.0)))
        ratios.append(float(rng.choice([-1.0, 1.0])) * rng.uniform(0.1, 1.0))
        couplings.append(Coupling(f"thread_{i}", "screw", f"turn_{i}", f"shift_{i}", ratios[-1]))
    if rng.random() < 0.5:  # the topmost spindle turns in a bearing block that is fixed to its stage
        parts.append(block("bearing", (9, 9, 9), on=SE3.identity(), bore=SE3.identity()))
        joints[-2] = declare.revolute(f"turn_{number - 1}", parts[-1]["bore"], spindles[-1]["on"], limits=(-30.0, 30.0), driver=True)
        joints.append(declare.fixed("bearing_held", parts[number - 1]["up"], parts[-1]["on"]))
    order = rng.permutation(number)
    return Assembly.from_parts(
        "stages", parts=[*parts, *spindles], joints=joints, couplings=[couplings[i] for i in order], ground="stage_0"
    )


@pytest.mark.parametrize("seed", range(12))
def test_a_thread_moves_the_stage_that_slides_where_its_spindle_turns(seed: int, tmp_path: Path) -> None:
    assembly = stages(seed)
    wanted = {(each.a, each.b): each.ratio for each in assembly.mechanism.couplings}

    read = {(each.a, each.b): each.ratio for each in read_back(assembly, tmp_path).mechanism.couplings}

    assert read == pytest.approx(wanted)


def test_a_thread_without_lead_is_refused(tmp_path: Path) -> None:
    (file,) = write_freecad_alone(screw(0)).write(tmp_path)
    switch_on(file)
    rewrite(file, rb'(name="Distance"[^>]*>\s*<Float value=")[^"]+', rb"\g<1>0")

    with pytest.raises(ReadError, match="has a lead that is zero"):
        read_freecad(file, metadata=False)


@pytest.mark.parametrize("lead", [4.0, -4.0])
def test_the_limits_of_a_slide_bound_the_turn_of_its_thread(lead: float) -> None:
    plate, bolt = block("plate", (40, 40, 8), on=SE3.identity()), block("bolt", (6, 6, 30), on=SE3.identity())
    rod = declare.cylindrical("rod", plate["on"], bolt["on"], travel=(-10.0, 20.0), angle=(-20.0, 12.0), rest=(2.0, 0.5))
    stated = Stated("thread", "Screw", ("plate", "bolt"), (SE3.identity(), SE3.identity()), lead, 0.0)

    others = [replace(stated, parts=("plate", "nut")), replace(stated, kind="Gears"), replace(stated, distance=0.0), stated]
    (read,), runs = threaded([rod], [*others, stated], {"plate": SE3.identity()})
    assert runs == [False, False, False, True, False], "one thread runs on a joint"
    turn = read.rest[0]
    ends = sorted(turn + (slide - 2.0) * math.tau / lead for slide in (-10.0, 20.0))
    assert math.cos(turn) == pytest.approx(math.cos(0.5))
    assert (read.limits.lower[0], read.limits.upper[0]) == pytest.approx((max(-20.0, ends[0]), min(12.0, ends[1])))
