from math import atan2, cos, degrees, hypot, radians, sin

from build123d import Align, Circle, Cylinder, Pos, SlotCenterToCenter, extrude

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
UP = {"z": (0, 0, 1), "x": (1, 0, 0)}


def bar(p, q, width):
    """Outline of a bar with round ends from p to q."""
    length, angle = hypot(q[0] - p[0], q[1] - p[1]), degrees(atan2(q[1] - p[1], q[0] - p[0]))
    return Pos((p[0] + q[0]) / 2, (p[1] + q[1]) / 2) * SlotCenterToCenter(length, width, rotation=angle)


def build(part):
    d = part.dimensions
    angle, low, level = radians(d["toe_angle_deg"]), d["play"] / 2, d["thickness"] + d["play"]
    knee, ankle, toe = (0, 0), (d["side_g"], 0), (d["side_i"] * cos(angle), d["side_i"] * sin(angle))

    outline = bar(knee, ankle, d["width"]) + bar(ankle, toe, d["width"]) + bar(toe, knee, d["width"])
    outline += Pos(*toe) * Circle(d["toe_radius"])
    foot = Pos(0, 0, low) * extrude(outline, d["thickness"])
    foot += Pos(0, 0, low) * Cylinder(d["boss_radius"], 2 * level - d["play"], align=LOW)
    foot -= [Pos(*point, 0) * Cylinder(d["bore_radius"], 8 * level) for point in (knee, ankle)]
    return foot, {"knee": {"o": (0, 0, 0), **UP}, "ankle": {"o": (*ankle, 0), **UP}}
