from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = (Align.CENTER, Align.MIN, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(0, 0, d["base"]) * Box(d["width"], d["depth"], d["height"], align=FRONT) - Pos(0, -1, d["base"] + d["wall"]) * Box(
        d["width"] - 2 * d["wall"], d["depth"] - d["wall"] + 1, d["height"] - 2 * d["wall"], align=FRONT
    )
    for x in (-80, 80):
        body += Pos(x, d["depth"] - 30, 160) * Box(26, 30, d["base"] + d["height"] - 161, align=FRONT)
    for z in (100, 400):
        body += Pos(d["hinge_x"], 0, z) * (Cylinder(6, 50, align=LOW) + Cylinder(d["hinge_pin"], 90, align=LOW)) + Pos(
            d["hinge_x"], 0, z
        ) * Box(-d["hinge_x"] - d["width"] / 2 + 3, 6, 50, align=(Align.MIN, Align.MIN, Align.MIN))
    for x in (-80, 80):
        body -= Pos(x, d["depth"] - 15, d["height"] + d["base"] - 330) * Cylinder(d["tube"] + d["clearance"], 400, align=LOW)
        body += Pos(x * 1.6, d["depth"] - 26, 18) * Box(14, 24, d["base"] - 16, align=FRONT) + Pos(x * 1.6, d["depth"] - 14, 30) * Rot(
            Y=90 if x > 0 else -90
        ) * Cylinder(d["axle"], 40, align=LOW)
    for x in (-60, 60):
        body += Pos(x, 40, d["base"] - 1 + d["height"]) * Box(8, 14, 19, align=LOW)
    body += Pos(0, 40, d["base"] + 10 + d["height"]) * Rot(Y=90) * Cylinder(d["hinge_pin"], 156)

    return body, {
        "book": {"o": (d["hinge_x"], 0, 0), "z": (0, 0, -1), "x": (1, 0, 0)},
        "first": {"o": (0, d["depth"] - 15, d["height"] + d["base"]), "z": (0, 0, 1), "x": (1, 0, 0)},
        "wheel": {"o": (153, d["depth"] - 14, 30), "z": (1, 0, 0), "x": (0, 1, 0)},
        "left_wheel": {"o": (-153, d["depth"] - 14, 30), "z": (1, 0, 0), "x": (0, 1, 0)},
        "carry": {"o": (0, 40, d["height"] + d["base"] + 10), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
