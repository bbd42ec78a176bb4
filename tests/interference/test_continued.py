"""A search that ran out is continued where it ended: the result is that of one search from the beginning, and no work is done twice."""

from __future__ import annotations

import math

import numpy as np
import pytest

from articad.certificates import linkage
from articad.certificates import proof as proving
from articad.certificates.clearing import Cleared, Ranges, clear
from articad.certificates.linkage import LinkageProver
from articad.certificates.profile import Forest
from articad.certificates.proof import cuts_of
from articad.certificates.spread import Spread
from articad.connectors import SE3
from articad.geometry import TriMesh, box
from articad.interference.motion import Chain, routes
from articad.interference.scene import Scene
from articad.interference.surface import whole_surface
from articad.interference.work import WorkBudget
from articad.kinematics.mechanism import Mechanism
from tests.interference.mechanisms import manifold_mesh, random_rotation
from tests.interference.test_linkage import four_bar, way_of
from tests.interference.test_slides import drawn, mixed

MOST = 4_000  # rows
SHARE = 17  # rows, after which a search is stopped
FIRST, LOOK = 2, 6  # rows of a linkage: of a first share, and after which a few poses are looked at
MIXED = 100  # seeds from here on: joints of all kinds


def searched(meshes: tuple[TriMesh, TriMesh], chain: Chain, shares: list[int]) -> tuple[Cleared, WorkBudget]:
    """Return the result of a search that is stopped after each share of rows and continued, and the budget that it spent."""
    a, b = (Forest.plain(whole_surface(mesh)) for mesh in meshes)
    bounds, budget = np.array([(f.lower, f.upper) for f in chain.freedoms]), WorkBudget(math.inf)
    found = clear(a, b, Ranges(Spread(chain), bounds), 1e-3, epsilon=1e-3, budget=budget, most=shares[0])
    for share in shares[1:]:
        found = found.continued(budget, share)
    return found, budget


def told(found: Cleared, budget: WorkBudget) -> list[bytes]:
    """Return all that a search found and spent."""
    assert found.course is not None
    numbers = (found.out_of_budget, found.box, found.pairs, found.boxes, found.contact, budget.work, budget.queries)
    rows = [] if found.trail is None else [*found.trail.written()[:2]]
    return [repr(numbers).encode(), *(array.tobytes() for array in (*rows, *cuts_of(found.course)))]


def posed(seed: int) -> tuple[tuple[TriMesh, TriMesh], Chain]:
    """Return two bodies on slides, which just touch or just pass each other, or two boxes on joints that also turn."""
    if seed < MIXED:
        a, b, chain, towards = drawn(seed)
        return (manifold_mesh(a.translate((-0.05 if seed % 4 else 0.05) * towards)), manifold_mesh(b)), chain
    rng = np.random.default_rng(seed)
    chain = mixed(rng)
    where = SE3.from_translation(rng.normal(size=3) * 25.0) @ random_rotation(rng)
    return (box(8, 6, 20).transformed(where), box(6, 12, 9)), chain


@pytest.mark.parametrize(("seed", "is_met"), [(0, True), (1, False), (4, True), (6, False), (MIXED + 10, False), (MIXED + 24, False)])
def test_a_continued_search_equals_one_from_the_beginning(seed: int, is_met: bool) -> None:
    meshes, chain = posed(seed)
    whole, parts = (searched(meshes, chain, shares) for shares in ([MOST], [*range(0, MOST, SHARE), MOST]))
    assert told(*parts) == told(*whole)
    assert whole[0].pairs > 3 * SHARE
    assert (whole[0].contact is not None, whole[0].is_complete) == (is_met, not is_met)


def test_a_search_that_ended_is_not_continued() -> None:
    a, b, chain, towards = drawn(0)
    meshes = manifold_mesh(a.translate(-0.05 * towards)), manifold_mesh(b)
    found, budget = searched(meshes, chain, [MOST, 2 * MOST])
    assert found.is_complete
    assert found.left is None
    assert budget.queries == found.pairs


def test_a_pair_that_a_linkage_moves_is_proven_with_the_same_rows_however_often_its_search_is_stopped(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    meshes, joints = four_bar((0.0, 5.0, 0.0))
    mechanism = Mechanism(tuple(meshes), "frame", joints)
    scene, route, way = Scene.of(meshes, joints), routes(mechanism.joints, "crank")["rocker"], way_of(mechanism)
    provers = [LinkageProver(scene, route, [one.name for one in joints], [way]) for _ in range(2)]
    whole = provers[0].prove()
    for module, name, value in ((proving, "LOOK_PAIRS", LOOK), (linkage, "LOOKS", 1)):
        monkeypatch.setattr(module, name, value)
    stopped = provers[1].prove(most=FIRST)
    assert stopped.out_of_budget
    parts = provers[1].prove()  # stopped once more, to look at a few poses
    rows = [claim.course.rows for proof in (whole, parts) for claim in proof.claims if claim.course is not None]
    assert len(rows) == 2
    assert [part.tobytes() for part in rows[1][:2]] == [part.tobytes() for part in rows[0][:2]]
    queries = [prover.budget.queries for prover in provers]
    assert queries[0] > 2 * LOOK
    assert queries[1] == queries[0]  # no row is examined twice
