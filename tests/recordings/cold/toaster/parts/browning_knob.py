from math import cos, radians, sin

from build123d import *

BOTTOM = (Align.CENTER, Align.CENTER, Align.MIN)


def rod(x0, x1, radius):
    return Pos(x0, 0, 0) * Rot(Y=90) * Cylinder(radius, x1 - x0, align=BOTTOM)


def build(part):
    d = part.dimensions
    end, skirt, r = d["grip_length"], d["skirt_thickness"], d["grip_radius"]
    shape = rod(0, end, r)
    n = d["flute_count"]
    for i in range(n):
        a = radians(360 * i / n)
        shape -= Pos(0, r * sin(a), r * cos(a)) * rod(skirt, end + 1, d["flute_radius"])
    shape += rod(0, skirt, d["skirt_radius"])
    shape += rod(-d["spindle_length"], 1, d["spindle_radius"])
    shape += Pos(end - 1, 0, d["pointer_start"]) * Box(
        d["pointer_height"] + 1, d["pointer_width"], d["pointer_end"] - d["pointer_start"],
        align=(Align.MIN, Align.CENTER, Align.MIN))
    return shape, {"spindle": {"o": (0, 0, 0), "z": (-1, 0, 0), "x": (0, 0, 1)}}
