from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(0, 0, 0.02) * Cylinder(d["puck_radius"], 8, align=LOW)
    return body, {"puck": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
