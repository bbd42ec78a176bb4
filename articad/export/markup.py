"""XML with numbers at full precision: reading returns exactly what was written."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from typing import Any

from lxml import etree

from articad.connectors.se3 import SE3
from articad.texts import escaped

DUST_DIGITS = 12  # a billionth of a mm
DUST = 0.5 * 10.0**-DUST_DIGITS
_DIGITS_OF_R = 15  # of the components of a rotation


def number(value: float) -> str:
    """Return the shortest text that reads back as the same float; −0 becomes 0, and whole numbers have no ".0"."""
    text = repr(float(value) + 0.0)
    return text.removesuffix(".0")


def texts(values: Iterable[float]) -> list[str]:
    """Return the texts of many numbers, each as `number` returns it."""
    form = repr([value + 0.0 for value in map(float, values)])  # of all at once: a call for each takes four times as long
    return form[1:-1].replace(".0,", ",").removesuffix(".0").split(", ") if len(form) > 2 else []


def numbers(values: Iterable[float]) -> str:
    """Return numbers separated by spaces."""
    return " ".join(texts(values))


def tidy(values: Iterable[float], scale: float = 1.0) -> list[float]:
    """Return lengths in m, angles and components of unit vectors without rounding noise: 1e-17 is 0, 0.9999999999999998 is 1.

    Args:
        values: The numbers.
        scale: The size to which their noise is proportional, in their unit; 0 if it is each number's own.
    """
    found = []
    for value in map(float, values):
        rounded = round(value, DUST_DIGITS)
        dusty = abs(value) < DUST * scale or abs(value - rounded) <= 2e-15 * max(scale, abs(value))
        found.append((rounded if dusty else value) + 0.0)
    return found


def rounded(values: Iterable[float]) -> list[float]:
    """Return lengths in m, or components of unit vectors, with `DUST_DIGITS` digits after the point."""
    return [round(float(value), DUST_DIGITS) + 0.0 for value in values]


def rounded_angles(values: Iterable[float]) -> list[float]:
    """Return angles [rad] of `DUST_DIGITS` digits that are whole degrees where they were: 90° is π/2 in all of its digits, and −180° is 180°."""
    degrees = [round(math.degrees(value), DUST_DIGITS - 1) for value in values]
    return [math.radians(180.0 if value == -180.0 else value) + 0.0 for value in degrees]


def rounded_quaternion(T: SE3) -> list[float]:
    """Return a rotation as a quaternion (x, y, z, w) with `DUST_DIGITS` digits: of the two, that whose last component other than 0 is positive."""
    found = rounded(T.quaternion)
    sign = next((math.copysign(1.0, value) for value in reversed(found) if value), 1.0)
    return [sign * value + 0.0 for value in found]


def comment(text: str) -> Any:
    """Return a comment with any text in one line: names and reasons of waivers are anybody's, and a comment may hold no two hyphens in a row."""
    line = " ".join(escaped(text).splitlines())
    return etree.Comment(f" {re.sub('-(?=-)', '- ', line)} ")


def rpy(T: SE3) -> tuple[float, float, float]:
    """Return (roll, pitch, yaw) with R = Rz(yaw) · Ry(pitch) · Rx(roll) [rad], exact also at pitch = ±90°.

    Roll is computed from R with the yaw removed, so that the product is R even where the two cannot be separated. There yaw has only the
    digits that are certain, so that rounding does not divide the sum of both otherwise on another processor.
    """
    R = T.rotation
    level = math.hypot(R[0, 0], R[1, 0])
    pitch = math.atan2(-R[2, 0], level)
    certain = _DIGITS_OF_R + math.floor(math.log10(level)) if level > 0 else -1
    yaw = round(math.atan2(R[1, 0], R[0, 0]), certain) if certain > 0 else 0.0
    s, c = math.sin(yaw), math.cos(yaw)
    roll = math.atan2(s * R[0, 2] - c * R[1, 2], c * R[1, 1] - s * R[0, 1])
    return roll, pitch, yaw


def wxyz(T: SE3) -> list[float]:
    """Return the rotation as a rounded quaternion, w first."""
    x, y, z, w = rounded_quaternion(T)
    return [w, x, y, z]


def rgba(color: str) -> str:
    """Turn "#rrggbb" into four numbers from 0 to 1."""
    return numbers([*(int(color[at : at + 2], 16) / 255 for at in (1, 3, 5)), 1.0])


def child(parent: Any, tag: str, attributes: dict[str, str] | None = None, text: str | None = None) -> Any:
    """Append an element; lxml escapes the strings."""
    element = etree.SubElement(parent, tag, attributes or {})
    element.text = text
    return element


def document(root: Any) -> bytes:
    """Return the document as indented UTF-8."""
    return bytes(etree.tostring(root, pretty_print=True, xml_declaration=True, encoding="utf-8"))
