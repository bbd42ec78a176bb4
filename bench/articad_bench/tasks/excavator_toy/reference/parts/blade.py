from build123d import Align, Box, Cylinder, Pos, Rot

LEFT = (Align.MIN, Align.CENTER, Align.CENTER)


def build(part):
    d = part.dimensions
    body = Rot(X=90) * Cylinder(9, 28) + Pos(-30, 0, 0) * Box(30, 28, 8, align=LEFT) + Pos(-32, 0, -1) * Box(6, d["width"], 32)
    body -= Rot(X=90) * Cylinder(d["root_pin"] + d["clearance"], 60)

    return body, {"blade": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)}}
