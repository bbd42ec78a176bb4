from build123d import Align, Box, Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    body = Pos(0, d["arm"], 0) * Rot(Y=90) * Cylinder(7, 148)
    for x in (-70, 70):
        body += Pos(x, 0, 0) * (Rot(Y=90) * Cylinder(6.5, 8) + Box(8, d["arm"], 10, align=(Align.CENTER, Align.MIN, Align.CENTER)))
    for x in (-70, 70):
        body -= Pos(x, 0, 0) * Rot(Y=90) * Cylinder(d["hinge_pin"] + d["clearance"], 10)

    return body, {"carry": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
