from build123d import Align, Box, Cylinder, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Rot(X=90) * Cylinder(16, 8, align=LOW) + Box(d["reach"], 8, 20, align=(Align.MIN, Align.MAX, Align.CENTER))
    body -= Rot(X=90) * Cylinder(d["latch_pin"] + d["clearance"], 40)

    return body, {"latch": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)}}
