from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, below, out = d["diameter"], d["below"], d["out"]
    shape = Pos(0, 0, -below) * Cylinder(diameter / 2, below + out, align=LOW)
    return shape, {"body": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (0, 1, 0)}}
