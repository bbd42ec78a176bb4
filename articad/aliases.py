"""Types without NumPy that many rooms use."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal

Json = dict[str, Any]

Progress = Callable[[str, str], None]
"""Called with the name of a part or stage, and what happened to it."""

Fastening = Literal["snap", "press", "circlip", "screw", "adhesive", "purchased"]
"""How the two parts of a joint are held together: by a snap fit, by interference, by a circlip, a screw or adhesive, or bought as one."""
