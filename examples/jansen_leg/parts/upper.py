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
    angle, low, level = radians(d["hip_angle_deg"]), d["play"] / 2, d["thickness"] + d["play"]
    pivot, top, hip = (0, 0), (d["side_b"], 0), (d["side_d"] * cos(angle), d["side_d"] * sin(angle))
    head = 2 * level + low  # shoulder above plane 3

    outline = bar(pivot, top, d["width"]) + bar(top, hip, d["width"]) + bar(hip, pivot, d["width"])
    outline -= [Pos(*point) * Circle(d["bore_radius"]) for point in (pivot, hip)]
    triangle = Pos(0, 0, low) * extrude(outline, d["thickness"])
    triangle += Pos(*top, low) * Cylinder(d["pin_radius"], head - low, align=LOW)
    triangle += Pos(*top, low) * Cylinder(d["spigot_radius"], head - low + d["spigot_length"], align=LOW)
    return triangle, {
        "pivot": {"o": (0, 0, 0), **UP},
        "top": {"o": (*top, level), **UP},
        "hip": {"o": (*hip, 0), **UP},
        "cap": {"o": (*top, head), "z": (0, 0, 1)},
    }
