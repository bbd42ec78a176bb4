from build123d import Align, Cylinder, Pos, Rot

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    start, end = d["head_start"], d["head_end"]
    shape = Rot(Y=90) * Cylinder(d["radius"], start + 1, align=UP)
    shape += Pos(start, 0, 0) * Rot(Y=90) * Cylinder(d["head_radius"], end - start, align=UP)
    shape += Pos(d["bar_x"], 0, 0) * Cylinder(d["bar_radius"], 2 * d["bar_half"])
    return shape, {"thread": {"o": (0, 0, 0), "z": (-1, 0, 0), "x": (0, 1, 0)}}
