from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    body = Cylinder(d["seat_radius"], 70, align=LOW) + Pos(0, 0, 1) * Cylinder(d["spindle"], 241, align=HIGH)
    return body, {"spindle": {"o": (0, 0, -30), "z": (0, 0, 1), "x": (1, 0, 0)}}
