from math import cos, radians, sin

from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
LEFT_LOW = (Align.MIN, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(0, 0, d["hub_low"]) * Cylinder(24, d["hub_top"] - d["hub_low"], align=LOW)
    for i in range(5):
        arm = Box(d["reach"] + 14, d["arm_width"], 25, align=LEFT_LOW) - Pos(d["reach"], 0, 0) * Cylinder(
            d["stem_radius"] + d["clearance"], 100
        )
        body += Rot(Z=72 * i) * Pos(0, 0, d["arm_z"]) * arm
    body -= Pos(0, 0, d["hub_low"] - 1) * Cylinder(d["column_radius"] + d["clearance"], d["hub_top"], align=LOW)

    return body, {
        "swivel_0": {
            "o": (d["reach"] * cos(radians(0)), d["reach"] * sin(radians(0)), d["arm_z"]),
            "z": (0, 0, 1),
            "x": (cos(radians(0)), sin(radians(0)), 0),
        },
        "swivel_1": {
            "o": (d["reach"] * cos(radians(72)), d["reach"] * sin(radians(72)), d["arm_z"]),
            "z": (0, 0, 1),
            "x": (cos(radians(72)), sin(radians(72)), 0),
        },
        "swivel_2": {
            "o": (d["reach"] * cos(radians(144)), d["reach"] * sin(radians(144)), d["arm_z"]),
            "z": (0, 0, 1),
            "x": (cos(radians(144)), sin(radians(144)), 0),
        },
        "swivel_3": {
            "o": (d["reach"] * cos(radians(216)), d["reach"] * sin(radians(216)), d["arm_z"]),
            "z": (0, 0, 1),
            "x": (cos(radians(216)), sin(radians(216)), 0),
        },
        "swivel_4": {
            "o": (d["reach"] * cos(radians(288)), d["reach"] * sin(radians(288)), d["arm_z"]),
            "z": (0, 0, 1),
            "x": (cos(radians(288)), sin(radians(288)), 0),
        },
        "lift": {"o": (0, 0, d["hub_top"]), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
