"""Records which tasks pass the long tests, if ARTICAD_SUITES_WRITE is 1; see `suites`."""

from __future__ import annotations

import os
from collections.abc import Generator
from typing import Final

import pytest

from articad_bench.task import TASKS
from tests.bench.suites import record, state, suite_of

WRITES: Final = os.environ.get("ARTICAD_SUITES_WRITE") == "1"
BEGUN: Final[dict[str, str]] = {}
"""Digests of the tasks as they were read: what changes while the tests run has not passed."""


def pytest_collection_finish(session: pytest.Session) -> None:
    found = [suite_and_task(item) for item in session.items] if WRITES else []
    BEGUN.update({each[1]: state(TASKS / each[1]) for each in found if each is not None})


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    report = yield
    found = suite_and_task(item) if WRITES and report.when == "call" and report.passed else None
    if found is not None:
        record(*found, BEGUN[found[1]])
    return report


def suite_and_task(item: pytest.Item) -> tuple[str, str] | None:
    """Return the suite and the task of a test; None if it has none."""
    parameters = getattr(getattr(item, "callspec", None), "params", {})
    return suite_of(item.originalname, parameters) if isinstance(item, pytest.Function) else None
