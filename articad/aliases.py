"""Types without NumPy that many rooms use."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

Json = dict[str, Any]

Progress = Callable[[str, str], None]
"""Called with the name of a part or stage, and what happened to it."""
