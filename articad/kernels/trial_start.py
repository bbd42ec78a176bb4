"""Do the libraries of the B-rep kernel start? Run in a process of its own, so that a crash is only a line of a report."""

from __future__ import annotations

import importlib
import sys
from typing import Any


def main() -> int:
    """Make a box, with Pinocchio loaded as well, and compare its volume with the product of its sides."""
    build123d: Any = importlib.import_module("build123d")
    importlib.import_module("pinocchio")
    return 0 if abs(build123d.Box(1, 2, 3).volume - 6) < 1e-9 else 1


if __name__ == "__main__":
    sys.exit(main())
