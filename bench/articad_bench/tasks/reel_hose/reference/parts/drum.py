from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Rot(Y=90) * (
        Cylinder(60, 2 * d["inner"] - 4)
        + Pos(0, 0, -d["inner"] - d["plate"]) * Cylinder(d["drum_axle"], 2 * d["inner"] + 2 * d["plate"] + 20, align=LOW)
    )
    for side in (-1, 1):
        body += Pos(side * (d["inner"] - 5), 0, 0) * Rot(Y=90) * Cylinder(d["flange_radius"], 6)
    body += Pos(d["inner"] + d["plate"] + 10, 0, 10) * Box(10, 20, d["throw"] + 20, align=(Align.MIN, Align.CENTER, Align.MAX)) + Pos(
        d["inner"] + d["plate"] + 15, 0, -d["throw"]
    ) * Rot(Y=90) * Cylinder(d["grip_pin"], 85, align=LOW)

    return body, {
        "drum": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)},
        "grip": {"o": (d["inner"] + d["plate"] + 20, 0, -d["throw"]), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
