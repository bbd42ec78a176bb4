from build123d import Align, Box, Cylinder, Pos, Rot

LEFT = (Align.MIN, Align.CENTER, Align.CENTER)


def build(part):
    d = part.dimensions
    body = Box(d["stick"], 8, 12, align=LEFT)
    for x in (0, d["stick"]):
        body += Pos(x, 0, 0) * Rot(X=90) * Cylinder(7, 8)
    for x in (0, d["stick"]):
        body -= Pos(x, 0, 0) * Rot(X=90) * Cylinder(d["pin"] + d["clearance"], 40)

    return body, {
        "stick": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "bucket": {"o": (d["stick"], 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
