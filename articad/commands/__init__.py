"""The commands of `articad`, one module for each kind; a command imports what it needs when it runs.

Importing this package registers them all.
"""

from __future__ import annotations

from articad.commands import (  # noqa: F401 - registers them
    auditing,
    benchmarking,
    building,
    completing,
    files,
    machine,
    models,
    parts,
    pictures,
    proving,
    remembering,
    serving,
    showing,
)
