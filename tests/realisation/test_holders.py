"""What other parts do against a motion that a joint leaves free: an eye on a pin, loose washers above it, and a ring above these that lets only the eye through."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
from build123d import Cylinder, Pos

from tests.interference.mechanisms import fixed, joint
from tests.realisation.test_verdicts import judged

THICK, COLLAR = 3.0, 0.2  # mm: of washers; play of the eye above its collar


def ring(radius: float, bore: float, low: float, high: float) -> Any:
    return Pos(0, 0, (low + high) / 2) * (Cylinder(radius, high - low) - Cylinder(bore, 2 * (high - low)))


def stack(gaps: Sequence[float]) -> dict[str, Any]:
    """A pin `a` with a collar below and a ring above, an eye `b`, and a washer between each two gaps; the last gap is below the ring."""
    tops = np.cumsum([0.0, *gaps]) + THICK * np.arange(len(gaps) + 1)
    end = float(tops[-1] - THICK)
    pin = Pos(0, 0, end / 2) * Cylinder(3, end + 60) + ring(7, 2, -14 - COLLAR, -10 - COLLAR)
    post = Pos(15, 0, end / 2 - 6) * Cylinder(2, end + 20) + ring(17, 2, -18, -14 - COLLAR)
    washers = {f"w{n}": ring(11.5, 3.1, low, low + THICK) for n, low in enumerate((tops[1:-1] - THICK).tolist(), 1)}
    return {"a": pin + post + ring(17, 9, end, end + 4), "b": ring(8, 3.1, -10, 0), **washers}


def loose(shapes: dict[str, Any], *, besides: Sequence[str] = ()) -> tuple[Any, ...]:
    return tuple(joint(f"on_{name}", "cylindrical", "a", name) for name in shapes if name.startswith("w") and name not in besides)


CASES = [(seed, tuple(np.round(np.random.default_rng(seed).uniform(0.2, 1.9, 2 + seed % 3), 3).tolist())) for seed in range(6)]


@pytest.mark.parametrize(("seed", "gaps"), CASES)
def test_washers_hold_an_eye_after_the_sum_of_the_gaps(seed: int, gaps: tuple[float, ...]) -> None:
    shapes = stack(gaps)
    row, report = judged(shapes, "revolute", seed=seed, others=loose(shapes), lower=(-1.0,), upper=(1.0,))
    chain = (*(name for name in shapes if name.startswith("w")), "a")
    if max(gaps) < 1.0:  # within reach of the faces
        assert (row.verdict, row.by) == ("held by others", (chain,))
        return
    (up,) = (loss for loss in row.losses if loss.way == "+z")
    (message,) = (finding.message for finding in report.findings if finding.where == "joints.j")
    if sum(gaps) > 5.0:
        assert up.holding is None
        assert "held by" not in message
        return
    assert up.holding is not None
    assert up.holding.parts == chain
    assert up.holding.travel == pytest.approx(sum(gaps), abs=0.01)
    assert f"+z after {sum(gaps):.3g} mm, where b is held by {', which is held by '.join(chain)}." in message


def test_both_kinds_of_stack_are_among_the_cases() -> None:
    kinds = {"near" if max(gaps) < 1.0 else "far" if sum(gaps) > 5.0 else "named" for _, gaps in CASES}
    assert "named" in kinds


@pytest.mark.parametrize("gaps", [(0.3, 0.4), (0.2, 0.5, 0.6)])
def test_a_joint_that_others_make_names_its_chain(gaps: tuple[float, ...]) -> None:
    shapes = stack(gaps)
    row, report = judged(shapes, "revolute", others=loose(shapes), lower=(-1.0,), upper=(1.0,))
    assert (row.verdict, row.by) == ("held by others", ((*(f"w{n}" for n in range(1, len(gaps))), "a"),))
    assert "joints.j" not in [finding.where for finding in report.findings]


def test_the_gap_between_parts_that_are_fixed_together_does_not_count() -> None:
    shapes = stack((1.5, 0.75, 1.25))
    others = (*loose(shapes, besides=["w2"]), fixed("glued", "w1", "w2"))
    row, _ = judged(shapes, "revolute", others=others, lower=(-1.0,), upper=(1.0,))
    (up,) = (loss for loss in row.losses if loss.way == "+z")
    assert up.holding is not None
    assert up.holding.parts == ("w1", "a")
    assert up.holding.travel == pytest.approx(2.75, abs=0.01)


def test_a_part_that_nothing_stops_holds_nothing() -> None:
    shapes = stack((1.5, 1.5))
    shapes["w1"] = ring(8.5, 3.1, 1.5, 4.5)  # leaves through the ring
    row, report = judged(shapes, "revolute", others=loose(shapes), lower=(-1.0,), upper=(1.0,))
    assert [loss.holding for loss in row.losses if loss.way == "+z"] == [None]
    assert not any("held by" in finding.message for finding in report.findings if finding.where == "joints.j")
