from build123d import Align, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, length, bore = d["diameter"], d["length"], d["bore"]
    shape = Cylinder(diameter / 2, length, align=LOW) - Cylinder(bore / 2, 4 * length)
    return shape, {"rod": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (0, 1, 0)}}
