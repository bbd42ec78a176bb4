"""Papers for a workshop: the parts list, the cut list, and dimensioned drawings.

`items` decides what is one item and numbers it; all papers use its numbers.
"""

from __future__ import annotations

from typing import Final

EXTRA: Final = "pip install 'articad[papers]'"
