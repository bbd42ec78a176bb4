from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, -d["drop"]) * Box(d["length"], d["width"], d["board"], align=HIGH) + Pos(0, 0, -d["drop"] - 1) * Box(2 * d["end"], d["rail"], d["rail_h"] + 1, align=LOW)
    for side in (-1, 1):
        shape += Pos(side * d["end"], 0, -d["drop"] - 1) * Box(d["block"], 46, d["drop"] + 15, align=LOW)
    shape -= Rot(Y=90) * Cylinder(d["bore"], 1000)
    shape += Pos(d["dial_u"], 0, d["dial_w"]) * Rot(Y=90) * Cylinder(d["pin_r"], d["block"] + 10, align=LOW) + Pos(d["dial_u"], 0, 0) * Box(d["block"], 20, d["dial_w"] + 10, align=LOW) - Rot(Y=90) * Cylinder(d["bore"], 1000)
    return shape, {
        "spindle": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 0, 1)},
        "rib": {"o": (0, 0, -d["drop"]), "z": (1, 0, 0), "x": (0, 0, 1)},
        "dial": {"o": (152, 0, d["dial_w"]), "z": (1, 0, 0), "x": (0, 0, 1)},
    }
