"""Drivers of linkages whose file states none: those that a person would turn, whatever the order of the joints in the file."""

from __future__ import annotations

import itertools
from pathlib import Path
from typing import Any

import pytest

from articad.assembly import Assembly
from articad.connectors.se3 import SE3
from articad.export.freecad import write_freecad_alone
from articad.importers.freecad import read_freecad
from articad.importers.mjcf import read_mjcf
from articad.kinematics import declare
from tests.assemblies import block
from tests.bench.forms import switch_on

ORDERS = list(itertools.permutations(range(4)))
ALONG, BACK = SE3.from_translation((90, 0, 20)) @ SE3.rot_y(1.5707963267948966), SE3.rot_y(1.5707963267948966)


def pump(order: tuple[int, ...], crank: Any, *, seat: bool) -> Assembly:
    """A crank of 20 mm that pushes a slide by a rod of 80 mm; perhaps in a seat that is fixed to the ground."""
    base = block("base", (60, 60, 10), crank=SE3.from_translation((0, 0, 20)), way=ALONG, seat=SE3.identity())
    carrier = block("seat", (10, 10, 5), foot=SE3.identity(), crank=SE3.from_translation((0, 0, 20)))
    wheel = block("wheel", (20, 4, 4), hub=SE3.identity(), pin=SE3.from_translation((20, 0, 0)))
    rod = block("rod", (80, 4, 4), big=SE3.identity(), small=SE3.from_translation((80, 0, 0)))
    slide = block("slide", (10, 10, 10), way=BACK, pin=SE3.identity())
    joints = [
        declare.slider("push", base["way"], slide["way"], limits=(-50.0, 50.0), rest=10.0),
        declare.revolute("wrist", slide["pin"], rod["small"], limits="endless"),
        declare.revolute("knee", rod["big"], wheel["pin"], limits="endless"),
        declare.revolute("turn", (carrier if seat else base)["crank"], wheel["hub"], limits=crank),
    ]
    joints = [joints[i] for i in order]
    if seat:
        joints.append(declare.fixed("seated", base["seat"], carrier["foot"]))
    parts = [base, wheel, rod, slide, *([carrier] if seat else [])]
    return Assembly.from_parts("pump", parts=parts, joints=joints, ground="base")


@pytest.mark.parametrize("order", ORDERS[::3])
@pytest.mark.parametrize("seat", [False, True])
def test_a_crank_that_turns_without_end_on_the_ground_drives_a_freecad_document(order: tuple[int, ...], seat: bool, tmp_path: Path) -> None:
    (file,) = write_freecad_alone(pump(order, "endless", seat=seat)).write(tmp_path)
    switch_on(file)

    (driver,) = read_freecad(file, metadata=False).drivers

    assert driver.joint == "turn"


SLIDE = '<body name="slide" pos="0.1 0 0"><joint name="push" type="slide" axis="1 0 0"/><geom size=".01"/>{rod}</body>'
ROD = '<body name="rod"><joint name="wrist" axis="0 0 1"/><geom size=".01"/></body>'
WHEEL = '<body name="wheel"><joint name="turn" axis="0 0 1"/><geom size=".01"/></body>'
TIE = '<equality><connect body1="rod" body2="wheel" anchor="-.08 .02 0"/></equality>'


@pytest.mark.parametrize("bodies", [(SLIDE, WHEEL), (WHEEL, SLIDE)])
@pytest.mark.parametrize(("actuator", "driver"), [("", "turn"), ('<actuator><motor joint="push"/></actuator>', "push")])
def test_it_drives_an_mjcf_model_unless_an_actuator_says_otherwise(
    bodies: tuple[str, str], actuator: str, driver: str, tmp_path: Path
) -> None:
    file = tmp_path / "pump.xml"
    tree = "".join(bodies).format(rod=ROD)
    file.write_text(f"<mujoco><worldbody>{tree}</worldbody>{TIE}{actuator}</mujoco>")

    assert [each.joint for each in read_mjcf(file).drivers] == [driver]
