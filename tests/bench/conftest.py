"""Records which tasks pass the long tests, if ARTICAD_SUITES_WRITE is 1; see `suites`."""

from __future__ import annotations

import os
from collections.abc import Generator

import pytest

from tests.bench.suites import record, suite_of


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    report = yield
    if report.when == "call" and report.passed and os.environ.get("ARTICAD_SUITES_WRITE") == "1" and isinstance(item, pytest.Function):
        found = suite_of(item.originalname, item.callspec.params if hasattr(item, "callspec") else {})
        if found is not None:
            record(*found)
    return report
