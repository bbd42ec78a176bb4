"""The time that a confined process may take: processor time, so that a busy machine changes no verdict.

The wall clock may be `WAITING` times as long: a process that needs more waits for something that does not come. Whoever started the
process kills it a little later if it defies both timers.
"""

from __future__ import annotations

import signal
from typing import Final

__all__ = ["OUT_OF_TIME", "WAITING", "allow", "processor_time", "unlimited"]

WAITING: Final = 5.0
"""Wall clock over processor time, at most."""
OUT_OF_TIME: Final = ("SIGPROF", "SIGALRM", "SIGXCPU")
"""The signals that end a process whose time is over."""


def allow(seconds: float) -> None:
    """Let this process end by SIGPROF after so much more processor time, or by SIGALRM after `WAITING` times as much wall clock."""
    processor_time(seconds)
    signal.setitimer(signal.ITIMER_REAL, WAITING * seconds)


def processor_time(seconds: float) -> None:
    """Let this process end by SIGPROF after so much more processor time; its wall clock stays as it is."""
    signal.setitimer(signal.ITIMER_PROF, seconds)


def unlimited() -> None:
    """Stop both timers."""
    signal.setitimer(signal.ITIMER_PROF, 0)
    signal.setitimer(signal.ITIMER_REAL, 0)
