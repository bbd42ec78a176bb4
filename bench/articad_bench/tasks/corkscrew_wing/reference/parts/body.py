from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Cylinder(13, 84, align=LOW)
        + Cylinder(d["bell_radius"], 30, align=LOW)
        - Cylinder(15, 26, align=LOW)
        - Cylinder(d["bore"] + d["clearance"], 300)
    )
    for x in (-1, 1):
        for y in (-1, 1):
            body += Pos(x * 8, y * (d["wing_thick"] / 2 + 2.4), 70) * Box(
                d["pin_x"] + 4, 4, 28, align=(Align.MIN if x > 0 else Align.MAX, Align.CENTER, Align.MIN)
            )
        body += Pos(x * d["pin_x"], 0, d["pin_z"]) * Rot(X=90) * Cylinder(d["pin"], d["wing_thick"] + 8)
    body -= Cylinder(d["bore"] + d["clearance"], 300)
    body += Pos(0, d["bore"] - 1.4, 35) * Box(2.6, 4, 30, align=(Align.CENTER, Align.MIN, Align.MIN))  # key

    return body, {
        "spindle": {"o": (0, 0, 0), "z": (0, 0, -1), "x": (1, 0, 0)},
        "wing": {"o": (d["pin_x"], 0, d["pin_z"]), "z": (0, -1, 0), "x": (1, 0, 0)},
        "left_wing": {"o": (-d["pin_x"], 0, d["pin_z"]), "z": (0, 1, 0), "x": (-1, 0, 0)},
    }
