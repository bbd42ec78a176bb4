from build123d import Align, Box, Cone, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    body = (
        Cylinder(d["shaft"], d["worm_length"], align=HIGH)
        + Pos(0, 0, -1) * Cylinder(d["shaft"], 5, align=LOW)
        + Pos(0, 0, 1) * Box(70, 12, 12, align=LOW)
    )
    body += Pos(0, 0, -d["worm_length"] - 8) * Cone(0.5, d["shaft"], 8, align=LOW)

    return body, {"worm": {"o": (0, 0, 0.5), "z": (0, 0, 1), "x": (1, 0, 0)}}
