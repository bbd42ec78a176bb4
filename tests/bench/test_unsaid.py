"""What formats cannot state is said where a check fails for it, and in the how-to."""

from __future__ import annotations

from pathlib import Path

import pytest

from articad_bench.scoring import score_files
from articad_bench.task import Task
from articad_bench.unsaid import MOTION, UNSAID

HOW_TO = Path(__file__).parents[2] / "docs/how-to/benchmark.md"
RING = {
    "name": "ring",
    "kind": "articulated",
    "product": "linkage",
    "prompt": "A four-bar linkage.",
    "checks": [{"kind": "parts", "number": [4, 4]}, {"kind": "loops", "number": [1, 1]}],
    "reference": None,
}
BLOCK = '<robot name="ring"><link name="a"><visual><geometry><box size=".1 .1 .1"/></geometry></visual></link></robot>'


def test_a_check_that_a_format_cannot_state_fails_and_says_why(tmp_path: Path) -> None:
    (tmp_path / "ring.urdf").write_text(BLOCK)

    (row,) = score_files([(tmp_path, Task.model_validate(RING))], tmp_path)

    assert [(each.kind, each.ok, "URDF" in each.measured) for each in row.judgements] == [("parts", False, False), ("loops", False, True)]


@pytest.mark.parametrize("rule", UNSAID, ids=lambda rule: f"{rule.format}-{rule.asked}")
def test_the_how_to_shows_every_rule(rule: object) -> None:
    (row,) = (line for line in HOW_TO.read_text().splitlines() if rule.why in line)  # type: ignore[attr-defined]

    assert row.casefold().startswith(f"| {rule.format} |")  # type: ignore[attr-defined]
    said = MOTION if "all checks of joints and motion" in row else frozenset()
    assert all(f"*{kind}*" in row for kind in rule.kinds - said)  # type: ignore[attr-defined]
