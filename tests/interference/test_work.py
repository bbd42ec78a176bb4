"""Budgets count work: a verdict and its work are the same whatever else the machine does, and whatever its clock shows."""

from __future__ import annotations

import contextlib
import itertools
import math
import subprocess
import sys
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import pytest

from articad.auditing import contact_motion
from articad.auditing.examine import AuditOptions, audit_file
from articad.certificates import certificate as certifying
from articad.certificates.certificate import Certificate, certify
from articad.geometry import box, cylinder
from articad.interference.work import BRAKE, BRAKE_SECONDS, PIECES_PER_SECOND, WorkBudget, look_price
from articad.kinematics.mechanism import Mechanism
from tests.audit import defects
from tests.interference.mechanisms import at, block_with_bore, joint

BUSY = 8
TIGHT_S = 0.03  # nominal seconds: enough for some pairs of the arm, not for all


def arm(budget: float) -> Certificate:
    """Prove two links that turn beside a post, with a little room."""
    meshes = {
        "base": block_with_bore(40, 20, 10.2, 48),
        "upper": cylinder(10, 60, segments=48).transformed(at(0, 0, 0)),
        "fore": box(8, 60, 8).transformed(at(0, 40, 34)),
        "post": box(6, 6, 60).transformed(at(30.0, 84.0, 0)),
    }
    joints = [
        joint("shoulder", "revolute", "base", "upper"),
        joint("elbow", "revolute", "upper", "fore", at_parent=at(0, 10, 34), at_child=at(0, 10, 34), lower=(-1.0,), upper=(1.0,)),
        joint("slot", "slider", "base", "post", lower=(0.0,), upper=(2.0,)),
    ]
    return certify(meshes, Mechanism(tuple(meshes), "base", joints), budget=budget)


def verdict(certificate: Certificate) -> tuple[Any, ...]:
    """Return all that a certificate says, but for the time it took."""
    return certificate.to_json(), certificate.work, certificate.queries


@contextlib.contextmanager
def busy(count: int) -> Iterator[None]:
    """Keep the machine busy."""
    loops = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(count)]
    try:
        yield
    finally:
        for loop in loops:
            loop.kill()
        for loop in loops:
            loop.wait()


def jumping(step: float) -> Callable[[], float]:
    """Return a clock that jumps at every look."""
    times = itertools.count()
    return lambda: next(times) * step


def test_a_tight_budget_proves_some_pairs_and_not_all() -> None:
    kinds = {pair.strength.kind for pair in arm(TIGHT_S).pairs}
    assert kinds >= {"certified", "not_checked"}  # else the tests below would say nothing


def test_the_verdict_and_the_work_are_the_same_beside_eight_busy_processes() -> None:
    alone = verdict(arm(TIGHT_S))
    with busy(BUSY):
        assert verdict(arm(TIGHT_S)) == alone


def test_the_verdict_and_the_work_do_not_follow_the_clock(monkeypatch: pytest.MonkeyPatch) -> None:
    still = verdict(arm(TIGHT_S))
    monkeypatch.setattr(certifying, "WorkBudget", partial(WorkBudget, clock=jumping(0.01)))
    assert verdict(arm(TIGHT_S)) == still


def test_the_emergency_brake_says_that_the_clock_stopped_the_work(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(certifying, "WorkBudget", partial(WorkBudget, clock=jumping(BRAKE * TIGHT_S + BRAKE_SECONDS)))
    stopped = arm(TIGHT_S)
    assert not stopped.ok
    assert all("stopped by the clock" in finding.message for finding in stopped.findings)
    assert "may differ on another machine" in str(stopped.findings)


def test_a_budget_ends_by_its_work_and_not_by_its_clock() -> None:
    budget = WorkBudget(1.0, clock=jumping(1e-3))
    while not budget.is_spent:
        budget.spend(1000)
    assert budget.work == PIECES_PER_SECOND
    assert "stopped by the clock" not in budget.ended()
    assert budget.stopped_after is None


def test_an_endless_budget_is_never_spent() -> None:
    budget = WorkBudget(math.inf, clock=jumping(1e9))
    budget.spend(1e12)
    assert not budget.is_spent


def test_a_look_costs_more_the_larger_the_meshes_are() -> None:
    assert look_price(12, 12) < look_price(12, 2000) < look_price(2000, 2000)


def test_an_audit_looks_at_the_same_motion_whatever_the_clock_shows(tmp_path: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    path = defects.write(defects.stand(tmp_path), tmp_path)
    choices = AuditOptions(engines=False, budget=1e-4)
    alone = [finding.to_json() for finding in audit_file(path, choices).findings]
    assert "W_AUDIT_NOT_CHECKED" in str(alone)
    monkeypatch.setattr(contact_motion, "WorkBudget", partial(WorkBudget, clock=jumping(0.01)))
    assert [finding.to_json() for finding in audit_file(path, choices).findings] == alone
    with busy(BUSY):
        assert [finding.to_json() for finding in audit_file(path, choices).findings] == alone
