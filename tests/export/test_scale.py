"""Exports and sweeps of long chains: the work grows as the number of parts, counted in calls, never in seconds."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from itertools import combinations
from typing import Any

import numpy as np
import pytest

from articad.assembly import Assembly
from articad.export.contacts import ContactSearch
from articad.formats import NAMED
from articad.interference.boxes import meeting_boxes
from tests.chains import chain

FEW, MANY = 40, 160
MOST_PER_PART = 1.3  # calls per part of the long chain to those of the short one
EXPORTS = ("urdf", "mjcf", "sdf", "usd", "glb", "3mf", "plan")


def calls_of(work: Callable[[], Any]) -> int:
    """Return how many functions, Python's and C's, a piece of work calls."""
    count = 0

    def seen(_frame: object, event: str, _argument: object) -> None:
        nonlocal count
        count += event in {"call", "c_call"}

    sys.setprofile(seen)
    try:
        work()
    finally:
        sys.setprofile(None)
    return count


def resting(count: int) -> Assembly:
    assembly = chain(count)
    assembly.mechanism.rest_poses()
    return assembly


@pytest.mark.parametrize("name", EXPORTS)
def test_an_export_calls_as_much_per_part_of_a_long_chain_as_of_a_short_one(name: str) -> None:
    write = NAMED[name].writer
    write(resting(3))  # imports and caches
    few, many = (calls_of(lambda count=count: write(resting(count))) for count in (FEW, MANY))  # type: ignore[misc]
    assert many / MANY <= MOST_PER_PART * few / FEW


@pytest.mark.parametrize("name", EXPORTS)
def test_an_export_is_as_large_per_part(name: str) -> None:
    few, many = (sum(map(len, NAMED[name].writer(chain(count)).files.values())) for count in (FEW, MANY))
    assert many / MANY <= MOST_PER_PART * few / FEW


def test_the_search_for_contacts_asks_in_proportion_to_the_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[str] = []
    look = ContactSearch._first_contact

    def counted(self: ContactSearch, a: str, b: str, near: Any) -> Any:
        asked.append(a)
        return look(self, a, b, near)

    monkeypatch.setattr(ContactSearch, "_first_contact", counted)
    counts = []
    for count in (FEW, MANY):
        asked.clear()
        NAMED["urdf"].writer(chain(count))
        counts.append(len(asked) / count)
    assert counts[1] <= MOST_PER_PART * max(counts[0], 0.1)


@pytest.mark.parametrize("seed", range(20))
def test_boxes_that_meet_are_those_that_a_comparison_of_all_finds(seed: int) -> None:
    rng = np.random.default_rng(seed)
    count = int(rng.integers(0, 40))
    low = rng.integers(-5, 5, (count, 3)).astype(float) * rng.choice([0.1, 1.0, 10.0], 3)
    high = low + rng.integers(0, 4, (count, 3))
    expected = [(i, j) for i, j in combinations(range(count), 2) if ((low[i] <= high[j]) & (low[j] <= high[i])).all()]
    assert list(map(tuple, meeting_boxes(low, high).tolist())) == expected


@pytest.mark.soak
@pytest.mark.parametrize("name", [*EXPORTS, "step"])
def test_two_thousand_parts_are_written(name: str) -> None:
    assert math.isfinite(len(NAMED[name].writer(chain(2000)).files))
