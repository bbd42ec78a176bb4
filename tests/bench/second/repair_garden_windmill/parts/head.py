from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(0, 0, 0.4) * Box(d["length"], 40, 50, align=LOW) + Pos(d["length"] / 2 - 1, 0, 25) * Rot(Y=90) * Cylinder(
        d["shaft"], 31, align=LOW
    )
    body -= Cylinder(d["pin"] + d["clearance"], 41, align=LOW) + Pos(-d["length"] / 2, 0, 0) * Box(60, 4, 200)

    return body, {
        "follow": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "fin": {"o": (-d["length"] / 2 + 30, 0, 25.4), "z": (1, 0, 0), "x": (0, 1, 0)},
        "spin": {"o": (d["length"] / 2, 0, 25), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
