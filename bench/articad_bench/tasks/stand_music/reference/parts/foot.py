from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
LEFT_LOW = (Align.MIN, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(0, 0, 40) * Cylinder(15, d["tube_top"] - 40, align=LOW) + Pos(0, 0, d["tube_top"] - 45) * Cylinder(20, 30, align=LOW)
    for i in range(3):
        body += Rot(Z=120 * i + 90) * (
            Pos(0, 0, 50) * Box(d["reach"] - 20, 24, 16, align=LEFT_LOW) + Pos(d["reach"] - 30, 0, 0) * Box(30, 24, 66, align=LEFT_LOW)
        )
    body -= Pos(0, 0, 60) * Cylinder(d["rod"] + d["clearance"], 2 * d["tube_top"], align=LOW) + Pos(0, 0, d["tube_top"] - 30) * Rot(
        Y=90
    ) * Cylinder(d["clamp"] + d["clearance"], 80, align=LOW)

    return body, {
        "clamp": {"o": (20, 0, d["tube_top"] - 30), "z": (1, 0, 0), "x": (0, 1, 0)},
        "height": {"o": (0, 0, d["tube_top"]), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
