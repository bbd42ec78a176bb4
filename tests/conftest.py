"""Settings of the whole suite."""

from __future__ import annotations

import os
from collections.abc import Iterator

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
