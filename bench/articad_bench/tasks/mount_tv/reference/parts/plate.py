from build123d import Align, Box, Cylinder, Pos, Rot

LEFT = (Align.MIN, Align.CENTER, Align.CENTER)


def build(part):
    d = part.dimensions
    body = Pos(20, 0, 0) * Box(6, d["side"], d["side"], align=LEFT)
    for y in (-100, 100):
        for z in (-100, 100):
            body -= Pos(20, y, z) * Rot(Y=90) * Cylinder(3, 20)
    for y in (-24.5, 24.5):
        body += Pos(0, y, 0) * (Box(21, 8, 24, align=LEFT) + Rot(X=90) * Cylinder(12, 8))
    body += Rot(X=90) * Cylinder(d["tilt_pin"], 57)

    return body, {"tilt": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)}}
