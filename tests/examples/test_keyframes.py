"""Every keyframe sheet of every product of the examples and recordings shows what moves, judged by the pixels that are drawn.

A pixel shows the mover where it changes with the mover's colour: nothing that chose the view is asked.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from _pytest.mark import ParameterSet

from articad.agents.pictures import KEYFRAMES, SIZE
from articad.agents.pipeline import replay
from articad.assembly import Assembly
from articad.plan.schema import AssemblyPlan
from articad.render import motion_frames, render_motion
from articad.runs.record import assembly_of
from articad.runs.run import Run

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = sorted(path.parent for path in ROOT.glob("examples/*/plan.json") if path.parent.name != "recording")
ANSWERED = sorted({path.parent for path in (ROOT / "tests" / "recordings").rglob("request.json")})
RECORDED = sorted(path.parent for path in ROOT.glob("examples/*/recording/request.json"))
TITLE = 48  # rows that the caption and what is looked through may take
DIFFERENT = 12  # of 255
LEAST_SEEN = 40  # pixels of 320 × 320 that change with the mover's colour
LEAST_CHANGED = 15  # pixels that differ from one keyframe to the next

LONG = {"table_football", "stewart_platform", "desk_lamp", "metronome", "drill", "tempo", "whisk"}  # a minute or more each

pytestmark = pytest.mark.slow


def named(paths: list[Path], name: Callable[[Path], str]) -> list[ParameterSet]:
    """Return the paths as parameters; those that take long are for the long run."""
    return [pytest.param(path, id=name(path), marks=[pytest.mark.soak] if name(path) in LONG else []) for path in paths]


def in_colour(assembly: Assembly, moving: set[str], color: str) -> Assembly:
    """Return the assembly with the moving parts in one colour."""
    parts = {
        name: replace(part, color=color, visuals=tuple(replace(shape, color=color) for shape in part.visuals)) if name in moving else part
        for name, part in assembly.parts.items()
    }
    return replace(assembly, parts=parts)


def sheets_that_show_nothing(assembly: Assembly) -> list[str]:
    """Return the joints with a keyframe in which the mover is not seen, or that is like the one before."""
    failing = []
    for joint in assembly.mechanism.driving_joints:
        _, q = motion_frames(assembly, joint, KEYFRAMES)
        poses = [assembly.poses(row) for row in q]
        moving = {name for i, name in enumerate(assembly.mechanism.parts) if not all(pose[i].allclose(poses[0][i]) for pose in poses)}
        blue, red = (
            [
                np.asarray(frame, dtype=np.float64)[TITLE:]
                for frame in render_motion(in_colour(assembly, moving, color), joint, frames=KEYFRAMES, size=SIZE, supersample=1)
            ]
            for color in ("#2060e0", "#e04020")
        )
        seen = [int((np.abs(a - b).max(axis=-1) > DIFFERENT).sum()) for a, b in zip(blue, red, strict=True)]
        changed = [int((np.abs(a - b).max(axis=-1) > DIFFERENT).sum()) for a, b in itertools.pairwise(blue)]
        if min(seen) < LEAST_SEEN or min(changed) < LEAST_CHANGED:
            failing.append(f"{joint}: seen {seen}, changed {changed}")
    return failing


@pytest.mark.parametrize("example", named(EXAMPLES, lambda path: path.name))
def test_keyframes_of_an_example_show_what_moves(example: Path) -> None:
    assert sheets_that_show_nothing(Assembly.from_plan(AssemblyPlan.load(example), example / "parts")) == []


@pytest.mark.parametrize("recording", named(RECORDED, lambda path: path.parent.name))
def test_keyframes_of_a_recorded_example_show_what_moves(recording: Path) -> None:
    with Run.view(recording) as run:
        assert sheets_that_show_nothing(assembly_of(run)) == []


@pytest.mark.parametrize("recording", named(ANSWERED, lambda path: path.name))
def test_keyframes_of_a_recorded_run_show_what_moves(recording: Path, tmp_path: Path) -> None:
    made = replay(recording, out=tmp_path / "run")
    with Run.view(made.run.path) as run:
        assert sheets_that_show_nothing(assembly_of(run)) == []
