from build123d import Align, Box, Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    body = Pos(0, -d["arm"], 0) * Rot(Y=90) * Cylinder(5, 108)
    for x in (-50, 50):
        body += Pos(x, 0, 0) * (Rot(Y=90) * Cylinder(6, 8) + Box(8, d["arm"], 8, align=(Align.CENTER, Align.MAX, Align.CENTER)))
    for x in (-50, 50):
        body -= Pos(x, 0, 0) * Rot(Y=90) * Cylinder(d["handle_pin"] + d["clearance"], 12)

    return body, {"handle": {"o": (0, 0, 0), "z": (-1, 0, 0), "x": (0, 1, 0)}}
