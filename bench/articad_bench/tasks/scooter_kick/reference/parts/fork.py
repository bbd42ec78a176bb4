from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    body = Pos(0, 0, -4) * Cylinder(d["stem"], d["stem_length"] + 4, align=LOW) + Box(40, d["wheel_width"] + 28, 8, align=HIGH)
    for side in (-1, 1):
        body += Pos(0, side * (d["wheel_width"] / 2 + 8), 0) * Box(26, 12, d["axle_drop"] + 12, align=HIGH)
    body += Pos(0, 0, -d["axle_drop"]) * Rot(X=90) * Cylinder(d["axle"], d["wheel_width"] + 20)
    body -= Pos(0, 0, d["stem_length"] - 250) * Cylinder(d["bar"] + d["clearance"], 400, align=LOW)

    return body, {
        "steer": {"o": (0, 0, 0.5), "z": (0, 0, 1), "x": (1, 0, 0)},
        "front_wheel": {"o": (0, 0, -d["axle_drop"]), "z": (0, 1, 0), "x": (1, 0, 0)},
        "height": {"o": (0, 0, d["stem_length"]), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
