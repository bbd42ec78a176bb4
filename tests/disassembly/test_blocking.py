"""The sets that leave, found with few questions, are those of the whole graph."""

from __future__ import annotations

import numpy as np
import pytest

from articad.disassembly.blocking import Blocking


def closed_sets(blocks: np.ndarray) -> set[frozenset[int]]:
    """Return the sets that reach each other and nothing else, by Warshall's closure."""
    reaches = blocks | np.eye(len(blocks), dtype=bool)
    for via in range(len(blocks)):
        reaches |= reaches[:, via : via + 1] & reaches[via]
    return {frozenset(np.flatnonzero(row).tolist()) for row in reaches if (reaches[row] == row).all()}


@pytest.mark.parametrize("seed", range(200))
def test_closed_sets_are_those_of_the_whole_graph(seed: int) -> None:
    rng = np.random.default_rng(seed)
    count = int(rng.integers(1, 14))
    blocks = rng.random((count, count)) < rng.choice([0.02, 0.1, 0.2, 0.5])
    np.fill_diagonal(blocks, val=False)
    asked: list[tuple[int, int]] = []
    liking = rng.random((count, count))

    def ask(i: int, j: int) -> bool:
        asked.append((i, j))
        return bool(blocks[i, j])

    graph = Blocking(count, ask, lambda i, j: float(liking[i, j]))
    assert {frozenset(each) for each in graph.closed(range(count))} == closed_sets(blocks)
    some = sorted(rng.permutation(count)[: int(rng.integers(1, count + 1))].tolist())
    expected = {frozenset(some[at] for at in each) for each in closed_sets(blocks[np.ix_(some, some)])}
    assert {frozenset(each) for each in graph.closed(some)} == expected
    assert len(asked) == len(set(asked))  # no question twice


def test_things_that_all_hold_each_other_take_few_questions() -> None:
    """A ring of 40 things: one question for each, if the likeliest one is asked first."""
    asked: list[tuple[int, int]] = []

    def ask(i: int, j: int) -> bool:
        asked.append((i, j))
        return (i + 1) % 40 == j

    graph = Blocking(40, ask, lambda i, j: float((i + 1) % 40 == j))
    assert graph.closed(range(40)) == [list(range(40))]
    assert len(asked) == 40
