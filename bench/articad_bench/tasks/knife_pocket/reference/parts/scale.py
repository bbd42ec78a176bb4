from build123d import Align, Box, Cylinder, Pos, Rot

BACK = (Align.CENTER, Align.MAX, Align.MIN)


def build(part):
    d = part.dimensions
    body = Box(d["length"], 3, d["height"], align=BACK)
    for x in (-d["length"] / 2, d["length"] / 2):
        body -= Pos(x, 0, d["height"]) * Rot(X=90) * Cylinder(d["radius"], 20)
    return body, {"glue": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)}}
