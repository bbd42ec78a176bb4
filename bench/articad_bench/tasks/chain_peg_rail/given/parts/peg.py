from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, start, end = d["diameter"], d["start"], d["end"]
    shape = Pos(0, 0, start) * Cylinder(diameter / 2, end - start, align=LOW)
    return shape, {"seat": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
