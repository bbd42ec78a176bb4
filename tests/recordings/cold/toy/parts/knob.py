from build123d import Align, Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    length = d["length"]
    low = (Align.CENTER, Align.CENTER, Align.MIN)
    shape = Rot(Y=90) * Cylinder(d["radius"], length, align=low)
    shape = shape - Pos(-1, 0, 0) * Rot(Y=90) * Cylinder(d["bore_radius"], length + 2, align=low)
    return shape, {"bore": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 0, 1)}}
