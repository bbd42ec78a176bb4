"""A fingerprint of the content of an XML file, independent of its layout: shows whether it was edited after it was written."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from typing import Any

from lxml import etree

_PLACES = frozenset({"filename", "file"})  # meshes may be moved without changing the content


def fingerprint(elements: Iterable[Any]) -> str:
    """Return SHA-256 over tags, attributes and text of elements and all below them; order matters, white space, comments and file names do not."""
    total = hashlib.sha256()
    for element in elements:
        for below in element.iter(etree.Element):
            attributes = sorted((name, value) for name, value in below.attrib.items() if name not in _PLACES)
            total.update(repr((below.tag, attributes, (below.text or "").strip())).encode())
    return total.hexdigest()
