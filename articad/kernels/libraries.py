"""The system libraries that the B-rep kernel is linked against, looked up by the dynamic loader without importing the kernel."""

from __future__ import annotations

import ctypes
import os
import sys
from collections.abc import Collection

PACKAGES = {"libGL.so.1": "libgl1", "libX11.so.6": "libx11-6", "libexpat.so.1": "libexpat1", "libgomp.so.1": "libgomp1"}
"""Shared library to the Debian and Ubuntu package that contains it."""


def missing_libraries() -> list[str]:
    """Return the names of the libraries that the loader does not find; empty on systems other than Linux."""
    return [name for name in PACKAGES if not _loads(name)] if sys.platform == "linux" else []


def install_line(missing: Collection[str]) -> str:
    """Return the command that installs libraries on Debian and Ubuntu."""
    return f"apt-get install --no-install-recommends {' '.join(sorted(PACKAGES[name] for name in missing))}"


def _loads(name: str) -> bool:
    try:
        ctypes.CDLL(name, mode=os.RTLD_LAZY)
    except OSError:
        return False
    return True
