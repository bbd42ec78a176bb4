from build123d import Align, Box, Cylinder, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Rot(X=90) * Cylinder(5, 3, align=LOW) + Box(5, 3, d["arm"], align=(Align.CENTER, Align.MAX, Align.MAX))
    body -= Rot(X=90) * Cylinder(d["lever_pin"] + 0.2, 30)

    return body, {"lever": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)}}
