import math

from build123d import Align, Box, Cylinder, Pos, Rot

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    beam_diameter, beam_length, height, leg_diameter, leg_x, spread = d["beam_diameter"], d["beam_length"], d["height"], d["leg_diameter"], d["leg_x"], d["spread"]
    bar_height = d["bar_height"]
    shape = Pos(0, 0, height) * Rot(Y=90) * Cylinder(beam_diameter / 2, beam_length)
    lean = math.degrees(math.atan2(spread, height))
    length = math.hypot(spread, height)
    for x in (-leg_x, leg_x):
        for side in (-1, 1):
            shape += Pos(x, 0, height) * Rot(X=side * lean) * Cylinder(leg_diameter / 2, length, align=HIGH)
        shape += Pos(x, 0, bar_height) * Rot(X=90) * Cylinder(leg_diameter / 3, 2 * spread * (1 - bar_height / height))
    shape -= Box(4 * beam_length, 4 * spread, leg_diameter, align=HIGH)
    return shape, {
        "beam": {"o": (0, 0, height), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
