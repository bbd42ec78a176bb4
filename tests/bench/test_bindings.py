"""Bindings: which words of a prompt tell a product from its mirror image."""

from __future__ import annotations

import pytest

from articad_bench.bindings import shows_hands
from tests.bench.test_cheats import task


@pytest.mark.parametrize(
    ("prompt", "shown"),
    [
        ("A gate on pins at the left post.", True),
        ("The right-hand door opens first.", True),
        ("Its hands turn clockwise.", True),
        ("Choose it so that 0.02 to 0.09 mm are left sideways.", False),
        ("The pack has 0.05 to 0.50 mm left in every case.", False),
        ("Wheels may be left out, 100 mm being left out after each.", False),
    ],
)
def test_what_is_left_over_is_on_no_side(prompt: str, shown: bool) -> None:
    assert shows_hands(task(prompt=prompt)) is shown
