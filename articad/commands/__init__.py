"""The commands of `articad`, one module for each kind; a command imports what it needs when it runs.

Importing this package registers them all. The distribution `articad-bench` adds its own if it is installed.
"""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec

from articad.commands import (  # noqa: F401 - registers them
    assembling,
    auditing,
    batching,
    building,
    completing,
    files,
    machine,
    models,
    papers,
    parts,
    pictures,
    proving,
    remembering,
    serving,
    showing,
)

if find_spec("articad_bench"):
    import_module("articad_bench.commands")
