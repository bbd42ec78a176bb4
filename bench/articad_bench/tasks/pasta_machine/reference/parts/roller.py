from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Rot(Y=90) * (
        Cylinder(d["roller"], 2 * d["plate_x"] - 1)
        + Pos(0, 0, -d["plate_x"] - d["plate"]) * Cylinder(d["axle"], 2 * d["plate_x"] + 2 * d["plate"] + 20, align=LOW)
    )
    return body, {
        "front": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)},
        "crank": {"o": (d["plate_x"] + d["plate"] + 8, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
