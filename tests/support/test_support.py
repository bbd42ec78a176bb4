"""What carries parts, what falls, and what falls out when a product is turned over."""

from __future__ import annotations

import math
from collections.abc import Mapping

import manifold3d as m3
import numpy as np
import pytest

from articad.connectors import SE3
from articad.disassembly.poses import OtherPose
from articad.interference.scene import Scene
from articad.kinematics.joints import Joint
from articad.support.check import BodySupport, Support, check_support
from tests.disassembly.test_order import BOX, INSIDE, LID, block
from tests.interference.mechanisms import IDENTITY, fixed, joint, manifold_mesh
from tests.obedience import assert_heals


def supported(
    solids: Mapping[str, m3.Manifold], joints: list[Joint], ground: str, *, made: tuple[str, ...] = (), others: tuple[OtherPose, ...] = ()
) -> Support:
    scene = Scene.of({name: manifold_mesh(solid) for name, solid in solids.items()}, joints)
    return check_support(
        scene, dict.fromkeys(solids, IDENTITY), ground, others=others, made=made, centre_of_mass=lambda _: np.array([20.0, 20.0, 15.0])
    )


def row(support: Support, part: str) -> BodySupport:
    return next(one for one in support.bodies if part in one.parts)


FREE = joint("loose", "free", "box", "thing", lower=(-math.inf,) * 6, upper=(math.inf,) * 6)


def test_a_thing_in_an_open_box_is_carried_by_it_and_falls_out_when_that_is_turned_over() -> None:
    support = supported({"box": BOX, "thing": INSIDE}, [FREE], "box")
    found = row(support, "thing")
    assert found.falls == 0
    assert found.rests_on == ("box",)
    assert math.isinf(found.turned_over)
    assert found.kept_by is None
    assert found.ways_out == ((0.0, 0.0, 1.0),)
    assert not support.findings


def test_a_lid_keeps_it_in_and_is_named() -> None:
    support = supported({"box": BOX, "lid": LID, "thing": INSIDE}, [FREE, fixed("closed", "box", "lid")], "box")
    found = row(support, "thing")
    assert found.turned_over == pytest.approx(10.0, abs=0.1)
    assert found.kept_by == "lid"
    assert found.ways_out == ()


def test_a_shelf_beside_its_pegs_falls_and_is_named() -> None:
    walls = block((0, 5), (0, 40), (0, 100)) + block((95, 100), (0, 40), (0, 100)) + block((0, 100), (0, 40), (0, 5))
    pegs = block((4, 10), (5, 35), (45, 50)) + block((90, 96), (5, 35), (45, 50))
    shelf = block((6, 94), (2, 38), (50, 54))
    loose = joint("lies", "free", "case", "shelf", lower=(-math.inf,) * 6, upper=(math.inf,) * 6)
    assert not supported({"case": walls + pegs, "shelf": shelf}, [loose], "case").findings
    support = supported({"case": walls, "shelf": shelf}, [loose], "case")
    (finding,) = support.findings
    assert finding.code == "W_NOT_CARRIED"
    assert finding.parts == ("shelf",)
    assert finding.value == pytest.approx(45.0, abs=0.1)  # onto the bottom


def test_a_joint_that_is_made_carries_and_one_that_is_not_does_not() -> None:
    solids = {"box": BOX, "thing": block((60, 70), (10, 20), (20, 30))}
    slide = joint(
        "slide", "slider", "box", "thing", at_parent=SE3.rot_y(math.pi / 2), at_child=SE3.rot_y(math.pi / 2), lower=(0,), upper=(5,)
    )
    assert not supported(solids, [slide], "box", made=("slide",)).findings
    (finding,) = supported(solids, [slide], "box").findings
    assert finding.code == "W_NOT_CARRIED"


def test_what_falls_at_an_end_of_a_range_only_is_found_there() -> None:
    table = block((0, 40), (0, 40), (0, 10))
    thing = block((10, 20), (10, 20), (10, 20))
    loose = joint("lies", "free", "table", "thing", lower=(-math.inf,) * 6, upper=(math.inf,) * 6)
    beyond = {"table": IDENTITY, "thing": SE3.from_translation(np.array([50.0, 0, 0]))}
    support = supported({"table": table, "thing": thing}, [loose], "table", others=(OtherPose({"push": 50.0}, beyond),))
    (finding,) = support.findings
    assert finding.pose == {"push": 50.0}


HINTS = {  # what a reader of the hint makes of the base, the place of the arm's end, and its travel [mm]
    "Widen the base": (120.0, 0.0, 50.0),
    "move mass over it": (40.0, 0.0, 0.0),
    "or shorten the travel": (40.0, 0.0, 10.0),
}


def slide(base: float, reach: float, travel: float) -> Support:
    """A block that slides out over a base by a travel; all the mass is in it."""
    solids = {"base": block((-base / 2, base / 2), (-20, 20), (0, 10)), "slide": block((-5, 5), (-5, 5), (10, 20))}
    start, end = ({"base": IDENTITY, "slide": SE3.trans(x, 0, 0)} for x in (reach, reach + travel))
    scene = Scene.of({name: manifold_mesh(solid) for name, solid in solids.items()}, [fixed("rail", "base", "slide")])
    return check_support(
        scene,
        start,
        "base",
        others=(OtherPose({"push": travel}, end),),
        made=("rail",),
        centre_of_mass=lambda poses: poses["slide"].translation,
    )


@pytest.mark.parametrize("words", HINTS)
def test_a_product_that_is_made_as_the_hint_says_tips_over_no_more(words: str) -> None:
    """Planted: the block is over the base at rest and 30 mm beyond its edge at the end, or beyond it at rest where mass is to move."""
    before = slide(40.0, 60.0 if words == "move mass over it" else 0.0, 50.0).findings
    (finding,) = before.of("W_TIPS_OVER")
    assert words in finding.hint
    assert_heals(finding, before, slide(*HINTS[words]).findings)
