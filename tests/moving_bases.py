"""Assemblies whose loops and couplings ride on a joint that drives: the base of each loop moves.

Frames of all parts agree with the ground's at rest, so that every loop is closed by construction and a joint's frame is one frame.
"""

from __future__ import annotations

import math

import numpy as np

from articad.assembly import Assembly
from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.geometry.part import Part
from articad.geometry.shapes import box
from articad.kinematics import declare
from articad.kinematics.joints import Coupling, Joint

Point = tuple[float, float, float]
Y, Z = (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


class Sketch:
    """Joints between named parts, each by one frame in the ground's coordinates at rest."""

    def __init__(self) -> None:
        self.frames: dict[str, dict[str, SE3]] = {}
        self.joints: list[tuple[str, str, str, str, dict[str, object]]] = []

    def add(self, kind: str, name: str, parent: str, child: str, o: Point, z: Point = Z, **options: object) -> None:
        for part in (parent, child):
            self.frames.setdefault(part, {})[name] = SE3.from_axes(o, z)
        self.joints.append((kind, name, parent, child, options))

    def assembly(self, name: str, ground: str, couplings: list[Coupling] | None = None) -> Assembly:
        """Every part is a small block at the first of its frames."""
        parts = {}
        for part, frames in self.frames.items():
            block = box(8, 6, 10).transformed(SE3.from_translation(next(iter(frames.values())).translation))
            parts[part] = Part.from_mesh(part, block, density=7850.0, connectors={key: Connector(key, T) for key, T in frames.items()})
        joints: list[Joint] = []
        for kind, joint, parent, child, options in self.joints:
            joints.append(getattr(declare, kind)(joint, parts[parent][joint], parts[child][joint], **options))
        return Assembly.from_parts(name, parts=parts.values(), joints=joints, ground=ground, couplings=couplings or [])


def gripper_arm() -> Assembly:
    """A turning, lifting arm; one finger follows the other."""
    s = Sketch()
    s.add("revolute", "swing", "base", "column", (0, 0, 0), limits=(-2.0, 2.0))
    s.add("revolute", "lift", "column", "arm", (0, 0, 80), Y, limits=(-1.0, 1.0))
    s.add("slider", "left", "arm", "finger_l", (150, 10, 80), Y, limits=(-5.0, 40.0))
    s.add("slider", "right", "arm", "finger_r", (150, -10, 80), Y, limits=(-40.0, 5.0))
    return s.assembly("gripper_arm", "base", [Coupling("mirror", "linear", "left", "right", -1.0)])


def four_bar_on_turntable() -> Assembly:
    """A turntable that carries a four-bar 30/90/70/100 in its xz plane, and a knob on the rocker."""
    a, c = _pin(30.0, 90.0, 70.0, 100.0, math.radians(60))
    s = Sketch()
    s.add("revolute", "swivel", "base", "table", (20, 0, 0), limits=(-2.0, 2.0))
    s.add("revolute", "crank", "table", "crank", (0, 0, 20), Y, limits="endless", driver=True)
    s.add("revolute", "pin_b", "crank", "coupler", (a[0], 0, 20 + a[1]), Y, limits="endless")
    s.add("revolute", "pin_c", "coupler", "rocker", (c[0], 0, 20 + c[1]), Y, limits="endless")
    s.add("revolute", "rocker", "table", "rocker", (100, 0, 20), Y, limits="endless")
    s.add("revolute", "knob", "rocker", "knob", (110, 5, 40), Z, limits=(-1.0, 1.0))
    return s.assembly("turntable", "base")


def excavator() -> Assembly:
    """A house that swings, a boom and a stick, each with its own cylinder: two loops, one on the moving part of the other."""
    s = Sketch()
    s.add("revolute", "swing", "base", "house", (0, 0, 30), limits=(-3.0, 3.0))
    s.add("revolute", "boom", "house", "boom", (40, 0, 60), Y, limits=(-1.0, 1.0))
    _cylinder(s, "lift", "house", "boom", (70, 0, 40), (140, 0, 120))
    s.add("revolute", "stick", "boom", "stick", (300, 0, 160), Y, limits=(-1.2, 1.2))
    _cylinder(s, "crowd", "boom", "stick", (180, 0, 170), (290, 0, 200))
    s.add("revolute", "bucket", "stick", "bucket", (340, 0, 40), Y, limits=(-1.0, 1.0))
    return s.assembly("excavator", "base")


def _cylinder(s: Sketch, name: str, base: str, arm: str, foot: Point, head: Point) -> None:
    """Add a barrel, a rod that drives, and its pin: they close a loop with the hinge between base and arm."""
    along = tuple(float(v) for v in np.subtract(head, foot))
    s.add("revolute", f"{name}_foot", base, f"{name}_barrel", foot, Y, limits="endless")
    s.add("slider", f"{name}_rod", f"{name}_barrel", f"{name}_rod", foot, (along[0], along[1], along[2]), limits=(-25.0, 25.0), driver=True)
    s.add("revolute", f"{name}_head", f"{name}_rod", arm, head, Y, limits="endless")


def _pin(a: float, b: float, c: float, d: float, crank: float) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the two moving pins of a four-bar (circles)."""
    p = np.array([a * math.cos(crank), a * math.sin(crank)])
    to_d = np.array([d, 0.0]) - p
    e = float(np.hypot(*to_d))
    u = (b * b - c * c + e * e) / (2 * e)
    h = math.sqrt(b * b - u * u)
    q = p + (u * to_d + h * np.array([-to_d[1], to_d[0]])) / e
    return (float(p[0]), float(p[1])), (float(q[0]), float(q[1]))


ALL = {"gripper arm": gripper_arm, "four-bar on a turntable": four_bar_on_turntable, "excavator": excavator}
