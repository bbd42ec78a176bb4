"""Processes that need more time than they get, on a machine of any speed."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

import pytest

from articad.processes import launcher

_NO_LIMITS = launcher.Limits()
_FOR_EVER = "import signal\nwhile True: signal.pause()"


def take(monkeypatch: pytest.MonkeyPatch, process: str, needs: float) -> None:
    """Let the processes of a module end only if their limit is at least so long; others never end, and are given up soon.

    Args:
        monkeypatch: Restores the launcher.
        process: The module that they run.
        needs: The limit [s].
    """
    start = launcher.start

    def started(words: Sequence[str], *, module: str | None = None, limits: launcher.Limits = _NO_LIMITS, **more: Any) -> launcher.Child:
        if module != process or (limits.seconds is not None and limits.seconds >= needs):
            return start(words, module=module, limits=limits, **more)
        return start([sys.executable, "-c", _FOR_EVER], limits=launcher.Limits(seconds=0.02), **more)

    monkeypatch.setattr(launcher, "start", started)
