"""The frames of an SDFormat file: poses that are relative to each other, in nested models.

A name means a link, joint, frame or model of the model in which it is used; `a::b` is b in the model a; `__model__` is the model's own frame.
Without `relative_to`, a link, a frame and a model are posed in the model around them (an attached frame, in what it is attached to), a
joint in its child. The pose of a model is that of its `placement_frame`, if it has one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from articad.connectors.se3 import SE3
from articad.importers.reading import LARGEST_MM, MM_PER_M, unreadable

__all__ = ["MODEL", "WORLD", "Scope", "numbers_of", "pose_of"]

WORLD = "world"
MODEL = "__model__"
_IDENTITY = SE3.identity()


@dataclass
class Scope:
    """A model, or the world, with the frames in it.

    Attributes:
        element: `<model>` or `<world>`.
        path: The file that contains it.
        prefix: Prefix of the names of its links: "" or `a::`.
        parent: The scope around it.
        static: Whether it, or a model around it, is static.
        version: Version of the file.
        models: Models in it, by name.
    """

    element: Any
    path: Path
    prefix: str = ""
    parent: Scope | None = None
    static: bool = False
    version: tuple[int, ...] = (1, 11)
    models: dict[str, Scope] = field(default_factory=dict)
    _posed: dict[str, tuple[str, SE3]] = field(default_factory=dict)  # name -> the frame it is relative to, and its pose in that
    _attached: dict[str, str] = field(default_factory=dict)  # name -> the frame it is attached to; a link to itself
    _known: dict[str, SE3] = field(default_factory=lambda: {MODEL: _IDENTITY})

    def fault(self, element: Any, reason: str) -> Exception:
        """Return the error that says where this file is wrong."""
        return unreadable(self.path, f"line {element.sourceline}", reason)

    def add(self, element: Any, name: str, relative_to: str, pose: SE3, attached_to: str) -> None:
        """Add a frame.

        Raises:
            ReadError: If the name is taken.
        """
        if name in self._posed or name == MODEL:
            raise self.fault(element, f"Two links, joints, frames or models have the name {name!r}.")
        self._posed[name] = relative_to, pose
        self._attached[name] = attached_to

    def local(self, name: str, element: Any) -> SE3:
        """Return the pose of a frame in this model's own frame [mm].

        Raises:
            ReadError: If there is no such frame, or frames form a cycle.
        """
        chain: list[tuple[str, SE3]] = []
        at, seen = name, set()
        while at not in self._known:
            head, _, rest = at.partition("::")
            if at in seen:
                raise self.fault(element, f"The frame {name!r} is posed relative to itself.")
            seen.add(at)
            if at in self._posed:
                relative_to, pose = self._posed[at]
                chain.append((at, pose))
                at = relative_to
            elif rest and head in self.models:
                chain.append((at, self.models[head].local(rest, element)))
                at = head
            else:
                raise self.fault(element, f"There is no frame {at!r} in {self.element.get('name') or 'the world'!r}.")
        T = self._known[at]
        for frame, pose in reversed(chain):
            T = T @ pose
            if not abs(T.translation).max() <= LARGEST_MM:
                raise self.fault(element, f"The frame {frame!r} has a position that is not plausible.")
            self._known[frame] = T
        return T

    def world(self, name: str, element: Any) -> SE3:
        """Return the pose of a frame in the world [mm]."""
        if name == WORLD and WORLD not in self._posed:
            return _IDENTITY
        T, scope = self.local(name, element), self
        while scope.parent is not None:
            T = scope.parent.local(scope.element.get("name"), element) @ T
            scope = scope.parent
        return T

    def body(self, name: str, element: Any) -> str:
        """Return the link, by its full name, to which a frame is attached; "" for the world.

        Raises:
            ReadError: If there is none.
        """
        at, seen = name, set()
        while True:
            head, _, rest = at.partition("::")
            if at in seen:
                raise self.fault(element, f"The frame {name!r} is attached to itself.")
            seen.add(at)
            if at == WORLD and WORLD not in self._posed:
                return ""
            if self._attached.get(at) == at:
                return self.prefix + at
            if at in self.models:
                return self.models[at].body(MODEL, element)
            if at in self._attached:
                at = self._attached[at]
            elif at == MODEL:
                if self.parent is None:
                    return ""
                at = self.canonical(element)
            elif rest and head in self.models:
                return self.models[head].body(rest, element)
            else:
                raise self.fault(element, f"There is no link or frame {at!r} in {self.element.get('name') or 'the world'!r}.")

    def canonical(self, element: Any) -> str:
        """Return the link that carries the model's own frame: the named one, else its first.

        Raises:
            ReadError: If the model has no link.
        """
        stated = self.element.get("canonical_link")
        first = next((link.get("name") for link in self.element.iterfind("link")), None) or next(iter(self.models), None)
        if not stated and first is None:
            raise self.fault(element, f"The model {self.element.get('name')!r} has no link.")
        return str(stated or first)


def numbers_of(element: Any, count: int, scope: Scope) -> list[float]:
    """Return the numbers in an element's text.

    Raises:
        ReadError: If they are not `count` finite numbers.
    """
    try:
        numbers = [float(word) for word in (element.text or "").split(None, count)]
    except ValueError:
        numbers = []
    if len(numbers) != count or not all(map(math.isfinite, numbers)) or any(abs(number) > LARGEST_MM for number in numbers):
        raise scope.fault(element, f"<{element.tag}> holds {(element.text or '').strip()[:60]!r}, not {count} plausible numbers.")
    return numbers


def pose_of(above: Any, scope: Scope) -> tuple[SE3, str]:
    """Return the pose in an element's `<pose>` [mm], and the frame it is relative to ("" if none is stated).

    Raises:
        ReadError: If it is not a pose.
    """
    element = above.find("pose")
    if element is None or (not (element.text or "").strip() and not element.attrib):
        return _IDENTITY, ""
    relative_to = element.get("relative_to") or element.get("frame") or ""
    if not (element.text or "").strip():
        return _IDENTITY, relative_to
    if element.get("rotation_format", "euler_rpy") == "quat_xyzw":
        x, y, z, *xyzw = numbers_of(element, 7, scope)
        length = math.hypot(*xyzw)
        if not length > 1e-9:
            raise scope.fault(element, "Its quaternion is not a rotation.")
        turn = SE3.from_quaternion([number / length for number in xyzw])
    else:
        x, y, z, roll, pitch, yaw = numbers_of(element, 6, scope)
        unit = math.pi / 180 if element.get("degrees", "").strip() in {"true", "1"} else 1.0
        turn = SE3.rot_z(yaw * unit) @ SE3.rot_y(pitch * unit) @ SE3.rot_x(roll * unit)
    return SE3.trans(x * MM_PER_M, y * MM_PER_M, z * MM_PER_M) @ turn, relative_to
