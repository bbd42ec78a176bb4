from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, out, reach = d["diameter"], d["out"], d["reach"]
    shape = Pos(0, 0, -out) * Cylinder(diameter / 2, out + reach, align=LOW)
    return shape, {"block": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (0, 1, 0)}, "hub": {"o": (0, 0, reach), "z": (0, 0, 1), "x": (0, 1, 0)}}
