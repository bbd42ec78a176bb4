"""A part with a real thread is turned out of it: sampled, so permitted and not proven."""

from __future__ import annotations

import math

import manifold3d as m3
import numpy as np
import pytest

from articad.assembly import Assembly
from articad.connectors.se3 import SE3
from articad.disassembly.steps import AssemblyOrder, Move, words_of
from articad.geometry.part import Part
from articad.interference.body import body_of
from articad.interference.overlap import overlap
from tests.interference.mechanisms import joint, manifold_mesh

LEAD = 4.0
HEAD = m3.Manifold.cylinder(4, 9, 9, 32)


def thread(radius: float, length: float, sense: float = 1.0) -> m3.Manifold:
    """Return a round thread: an eccentric circle that turns once in each lead."""
    section = m3.CrossSection.circle(radius, 32).translate((0.8, 0))
    turns = length / LEAD
    return m3.Manifold.extrude(section, length, n_divisions=int(24 * turns), twist_degrees=sense * 360 * turns)


def nut(sense: float = 1.0) -> m3.Manifold:
    """Return a block from z = 0 to 12 with a threaded bore."""
    return m3.Manifold.cube([24, 24, 12]).translate([-12, -12, 0]) - thread(5.25, 20, sense).translate([0, 0, -LEAD])


def screwed(bolt: m3.Manifold, block: m3.Manifold, lead: float = LEAD) -> Assembly:
    parts = [Part.from_mesh(name, manifold_mesh(solid)) for name, solid in {"block": block, "bolt": bolt}.items()]
    turn = joint("turn", "screw", "block", "bolt", lower=(-0.01,), upper=(0.01,), lead=lead)
    return Assembly.from_parts("screwed", parts=parts, joints=[turn], ground="block")


def deepest(assembly: Assembly, move: Move) -> float:
    """Return the deepest overlap at 17 places of each turn, which are not those of the search, by the formula of a helix."""
    scene, worst = assembly.scene(), 0.0
    for turned in np.arange(1, 17 * abs(move.turns)) / 17:
        c, s = math.cos(2 * math.pi * turned * math.copysign(1, move.turns)), math.sin(2 * math.pi * turned * math.copysign(1, move.turns))
        up = -move.direction[2]
        T = np.array([[c, -up * s, 0, 0], [up * s, c, 0, 0], [0, 0, 1, up * turned * LEAD], [0, 0, 0, 1]])
        worst = max(worst, overlap(body_of(scene.meshes["block"]), body_of(scene.meshes["bolt"]), SE3.from_matrix(T)).depth)
    return worst


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_bolt_is_turned_into_its_thread_from_the_side_of_its_head(sense: float) -> None:
    assembly = screwed(thread(5, 20, sense) + HEAD.translate([0, 0, 20]), nut(sense), sense * LEAD)
    order = assembly.assembly_order()
    assert order.ok
    step = order.steps[1]
    assert (step.parts, step.strength, step.permitted) == (("bolt",), "permitted", (("bolt", "block", "screw"),))
    outside, move = step.moves
    assert (outside.kind, move.kind, move.direction, move.turns) == ("straight", "screw", (0, 0, -1), sense * 4)
    assert move.length_mm == pytest.approx(4 * LEAD)
    assert deepest(assembly, move) <= assembly.scene().passable("block", "bolt")
    hand = "" if sense > 0 else " of a left-hand thread"
    assert words_of(step) == f"Put bolt in place: from above, then turned in from above by 4 turns{hand}."
    assert AssemblyOrder.from_json(order.to_json()) == order


def test_a_thread_of_the_other_hand_does_not_come_out() -> None:
    assert not screwed(thread(5, 20) + HEAD.translate([0, 0, 20]), nut(), -LEAD).assembly_order().ok


def test_a_bolt_with_two_heads_does_not_come_out() -> None:
    both = thread(5, 20) + HEAD.translate([0, 0, 20]) + HEAD.translate([0, 0, -4])
    assert not screwed(both, nut()).assembly_order().ok


def test_what_is_beside_its_thread_already_is_not_turned_out_of_a_closed_cage() -> None:
    """A bolt above its block in a cage that is fixed to the block: nothing lets it out, and no step has a way without a direction."""
    cage = m3.Manifold.cube([44, 44, 40]) - m3.Manifold.cube([40, 40, 36]).translate([2, 2, 2])
    solids = {"block": nut() - HEAD, "bolt": HEAD.translate([0, 0, 20]), "cage": cage.translate([-22, -22, 13])}
    parts = [Part.from_mesh(name, manifold_mesh(solid)) for name, solid in solids.items()]
    joints = [joint("turn", "screw", "block", "bolt", lower=(-0.01,), upper=(0.01,), lead=LEAD), joint("held", "fixed", "block", "cage")]
    order = Assembly.from_parts("caged", parts=parts, joints=joints, ground="block").assembly_order()

    assert not order.ok
    assert all(math.isfinite(number) for step in order.steps for move in step.moves for number in move.direction)
