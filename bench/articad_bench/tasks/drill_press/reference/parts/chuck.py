from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    body = (
        Pos(0, 0, -0.4) * Cylinder(d["chuck_radius"], 40, align=HIGH)
        + Pos(0, 0, -40) * Cylinder(9, 15, align=HIGH)
        + Pos(0, 0, -2) * Cylinder(d["spindle"], 132, align=LOW)
    )
    return body, {"chuck": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
