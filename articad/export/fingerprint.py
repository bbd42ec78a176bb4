"""A fingerprint of what an XML file says, whatever its layout: tells whether somebody has edited it since it was written."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from typing import Any

_PLACES = frozenset({"filename", "file"})  # meshes may be moved without changing what the file says


def fingerprint(elements: Iterable[Any]) -> str:
    """Return SHA-256 over tags, attributes and text of elements and all below them; order counts, white space and file names do not."""
    total = hashlib.sha256()
    for element in elements:
        for below in element.iter():
            attributes = sorted((name, value) for name, value in below.attrib.items() if name not in _PLACES)
            total.update(repr((below.tag, attributes, (below.text or "").strip())).encode())
    return total.hexdigest()
