"""Settings of the whole suite."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

# "ci": the same examples on every run, no deadline on a loaded machine. "dev": fresh examples each time.
settings.register_profile("ci", deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow])
settings.register_profile("dev", deadline=None)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "dev"))


@pytest.fixture(autouse=True, scope="session")
def memory_of_the_tests(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Keep tests out of the experience of whoever runs them, and that out of the tests."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ARTICAD_MEMORY", str(tmp_path_factory.mktemp("memory") / "store"))
        yield


SLOW = Path(__file__).with_name("slow.txt")
"""Test functions that take longer than `scripts/durations.py` allows a fast one, as it measured them."""


SAMPLED = Path(__file__).with_name("sampled.txt")
"""Test functions of which CI runs some parameters only, with their number."""


def leave_to_the_long_run(items: list[pytest.Item]) -> None:
    """Mark the tests with `soak` of which `sampled.txt` says that CI does not run them."""
    of_function: dict[str, list[pytest.Item]] = {}
    for item in items:
        if item.get_closest_marker("soak") is None:
            of_function.setdefault(item.nodeid.partition("[")[0], []).append(item)
    for line in SAMPLED.read_text(encoding="utf-8").splitlines():
        if line.startswith("#"):
            continue
        number, name = line.split(maxsplit=1)
        mine = [item for item in of_function.get(name.partition("[")[0], []) if item.nodeid.startswith(name)]
        stay = {index * len(mine) // int(number) for index in range(int(number))}
        for index, item in enumerate(mine):
            if index not in stay:
                item.add_marker(pytest.mark.soak)


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--fast", action="store_true", help="leave out the tests that tests/slow.txt lists")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    leave_to_the_long_run(items)
    if not config.getoption("--fast"):
        return
    slow = {line.split()[1] for line in SLOW.read_text(encoding="utf-8").splitlines() if not line.startswith("#")}
    marks = {"slow", "freecad", "engines"}
    late = [item for item in items if item.nodeid.partition("[")[0] in slow or marks & {mark.name for mark in item.iter_markers()}]
    config.hook.pytest_deselected(items=late)
    items[:] = [item for item in items if item not in set(late)]
