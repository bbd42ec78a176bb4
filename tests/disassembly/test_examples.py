"""Orders of assembly of the examples: those that can be built, and those with parts that block each other; each path is sampled again."""

from __future__ import annotations

import time
from functools import cache

import numpy as np
import pytest

from articad import examples, read
from articad.assembly import Assembly
from articad.connectors.se3 import SE3
from articad.disassembly.poses import poses_at
from articad.disassembly.steps import AssemblyOrder, AssemblyStep
from articad.disassembly.ways import Ways
from articad.interference.body import body_of
from articad.interference.overlap import overlap

BUILT = ["four_bar", "geared_four_bar", "jansen_leg", "toggle_clamp", "wardrobe", "desk_lamp"]
# Looked at in section: the metronome's case is one hollow piece around its nut and barrel; the rod of the slider-crank has an eye in one
# piece about the crank pin, and its piston stays in the cylinder at every angle of the crank, so that the eye never gets past the pin.
BLOCKED = {
    "metronome": {"case", "scale", "pendulum", "nut", "barrel"},
    "slider_crank": {"frame", "crankshaft", "rod", "piston", "gudgeon"},
}
PLACES = 24  # on each move of a path


@cache
def product(name: str) -> Assembly:
    return read(examples.folder(name)).product()


@cache
def ordered(name: str) -> tuple[AssemblyOrder, float]:
    begun = time.process_time()
    return product(name).assembly_order(), time.process_time() - begun


def deepest(assembly: Assembly, step: AssemblyStep) -> float:
    """Return how much deeper than allowed parts overlap on the path of a step, by Booleans of the solids [mm]."""
    scene, poses = assembly.scene(), poses_at(assembly.mechanism, step.at)
    ways, permitted = Ways(scene, poses), {frozenset(pair[:2]) for pair in step.permitted}
    boxes = {name: np.array([(p := ways.points(name)).min(axis=0), p.max(axis=0)]) for name in (*step.parts, *step.onto)}
    worst, beyond = -np.inf, np.zeros(3)
    for move in reversed(step.moves):  # out again
        for share in np.linspace(0, 1, PLACES):
            offset = beyond - share * move.length_mm * np.array(move.direction)
            for part in step.parts:
                for other in step.onto:
                    near = (boxes[part][0] + offset <= boxes[other][1]).all() and (boxes[part][1] + offset >= boxes[other][0]).all()
                    if near and frozenset((part, other)) not in permitted:
                        T = poses[other].inverse() @ SE3.from_translation(offset) @ poses[part]
                        found = overlap(body_of(scene.meshes[other]), body_of(scene.meshes[part]), T)
                        worst = max(worst, found.depth - ways.depth(part, other))
        beyond = beyond - move.length_mm * np.array(move.direction)
    return worst


@pytest.mark.soak
@pytest.mark.parametrize("name", BUILT)
def test_an_example_can_be_built_in_a_minute_of_search(name: str) -> None:
    order, seconds = ordered(name)
    assert order.ok, order.findings
    assert sorted(part for step in order.steps if step.assembly == order.name for part in step.parts) == sorted(product(name).parts)
    assert seconds < 60


@pytest.mark.soak
@pytest.mark.parametrize("name", BUILT)
def test_each_path_of_an_example_is_free_where_it_is_sampled(name: str) -> None:
    for step in ordered(name)[0].steps:
        if step.moves:
            assert deepest(product(name), step) <= 1e-6, step


@pytest.mark.soak
@pytest.mark.parametrize("name", BLOCKED)
def test_an_example_that_cannot_be_built_names_what_blocks(name: str) -> None:
    order, _ = ordered(name)
    assert {part for blocked in order.blocked for part in blocked.parts} == BLOCKED[name]
    assert order.findings.codes == ("W_NOT_INSERTABLE",)
