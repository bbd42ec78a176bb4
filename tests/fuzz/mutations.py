"""Changes to a text that keep its form: JSON stays JSON and XML stays XML, so that a fuzzer gets past the parser."""

from __future__ import annotations

import copy
import json
import random
from collections.abc import Callable
from typing import Any

from lxml import etree

HOSTILE: tuple[Any, ...] = (
    None, True, False, 0, -1, 1, 0.5, 1e-300, 1e300, -1e308, 2**31, 2**63, 2**64, 10**400, "", " ", "0", "nan", "inf", "-inf", "1e999",
    "../../etc/passwd", "/etc/passwd", "\x00", "a" * 300, "ü", "\u202e", "__class__", "a.b", "$(x)", "${x}", "{x}", "%s", "1 2 3", "0 0 0",
    [], {}, [[]], [0], [0, 0, 0], [1, 0, 0], ["a"], {"a": 1},
)  # fmt: skip


def mutated(content: bytes, seed: int) -> bytes:
    """Return the content changed in a few places, in its own form if it is JSON or XML, else by bytes."""
    chance = random.Random(seed)
    if chance.random() < 0.9:
        for form in (_json, _xml):
            changed = form(content, chance)
            if changed is not None:
                return changed
    return _bytes(content, chance)


def _json(content: bytes, chance: random.Random) -> bytes | None:
    try:
        lines = [json.loads(content)]
    except (ValueError, RecursionError):
        try:
            lines = [json.loads(line) for line in content.splitlines()]
        except (ValueError, RecursionError):
            return None
        if not lines or not all(isinstance(line, dict) for line in lines):
            return None
    for _ in range(chance.choice((1, 1, 2, 4))):
        _change_json(lines, chance)
    try:
        return b"\n".join(json.dumps(line).encode() for line in lines) + b"\n"
    except (ValueError, RecursionError):
        return None


def _change_json(root: Any, chance: random.Random) -> None:
    places: list[tuple[Any, Any]] = []
    waiting = [root]
    while waiting:
        holder = waiting.pop()
        keys = list(holder) if isinstance(holder, dict) else range(len(holder))
        for key in keys:
            places.append((holder, key))
            if isinstance(holder[key], dict | list):
                waiting.append(holder[key])
    if not places:
        return
    holder, key = chance.choice(places)
    how = chance.randrange(6)
    if how == 0:
        del holder[key]
    elif how == 1 and isinstance(holder, list):
        holder.insert(key, copy.deepcopy(holder[key]))
    elif how == 2:
        other, place = chance.choice(places)
        value = other[place] if (isinstance(other, dict) and place in other) or (isinstance(other, list) and place < len(other)) else None
        holder[key] = copy.deepcopy(value)
    elif how == 3 and isinstance(holder, dict):
        holder[str(chance.choice(places)[1])] = holder.pop(key)
    elif how == 4 and isinstance(holder[key], int | float) and not isinstance(holder[key], bool):
        holder[key] = holder[key] * chance.choice((-1, 0, 0.5, 2, 1000, 1e6)) if abs(holder[key]) < 1e200 else 0
    else:
        holder[key] = copy.deepcopy(chance.choice(HOSTILE))


def _xml(content: bytes, chance: random.Random) -> bytes | None:
    if not content.lstrip().startswith(b"<"):
        return None
    try:
        root = etree.fromstring(content, etree.XMLParser(resolve_entities=False, no_network=True))
    except (etree.XMLSyntaxError, ValueError):
        return None
    for _ in range(chance.choice((1, 1, 2, 4))):
        elements = [element for element in root.iter() if isinstance(element.tag, str)]
        _XML_CHANGES[chance.randrange(len(_XML_CHANGES))](chance.choice(elements), elements, chance)
    return bytes(etree.tostring(root))


def _attribute(element: Any, elements: list[Any], chance: random.Random) -> None:
    if not element.attrib:
        return
    name = chance.choice(sorted(element.attrib))
    words = element.attrib[name].split()
    how = chance.randrange(4)
    if how == 0:
        del element.attrib[name]
    elif how == 1 and words:
        words[chance.randrange(len(words))] = str(chance.choice((0, -1, 1, 1e-9, 1e9, 1e300, "nan", "x", 2**31, 2**63)))
        element.attrib[name] = " ".join(words)
    elif how == 2:
        other = chance.choice(elements)
        if other.attrib:
            element.attrib[name] = other.attrib[chance.choice(sorted(other.attrib))]
    else:
        value = chance.choice([value for value in HOSTILE if isinstance(value, str) and "\x00" not in value])
        element.attrib[name] = value


def _remove(element: Any, _: list[Any], __: random.Random) -> None:
    if element.getparent() is not None:
        element.getparent().remove(element)


def _repeat(element: Any, _: list[Any], __: random.Random) -> None:
    if element.getparent() is not None:
        element.getparent().append(copy.deepcopy(element))


def _move(element: Any, elements: list[Any], chance: random.Random) -> None:
    target = chance.choice(elements)
    if element not in (target, *target.iterancestors()):
        target.append(copy.deepcopy(element))


def _rename(element: Any, elements: list[Any], chance: random.Random) -> None:
    element.tag = chance.choice(elements).tag


def _text(element: Any, elements: list[Any], chance: random.Random) -> None:
    element.text = chance.choice((*(other.text for other in elements), "", "x", "1e999"))


_XML_CHANGES: tuple[Callable[[Any, list[Any], random.Random], None], ...] = (
    _attribute,
    _attribute,
    _attribute,
    _remove,
    _repeat,
    _move,
    _rename,
    _text,
)


def _bytes(content: bytes, chance: random.Random) -> bytes:
    changed = bytearray(content)
    for _ in range(chance.choice((1, 1, 2, 8))):
        if not changed:
            return bytes(chance.randrange(256) for _ in range(8))
        at = chance.randrange(len(changed))
        how = chance.randrange(5)
        if how == 0:
            changed[at] = chance.randrange(256)
        elif how == 1:
            del changed[at : at + chance.choice((1, 4, 16, len(changed)))]
        elif how == 2:
            changed[at:at] = changed[at : at + chance.choice((1, 4, 16, 64))]
        elif how == 3:
            changed[at : at + 4] = chance.choice((b"\xff\xff\xff\xff", b"\0\0\0\0", b"\xff\xff\xff\x7f", b"\0\0\xc0\x7f"))
        else:
            changed[at : at + 1] = chance.choice((b"\0", b" ", b"\n", b"-1", b"nan", b"1e999", b"\xff", b'"', b"<", b"{", b"[" * 100))
    return bytes(changed)
