from build123d import Align, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, height, bore = d["diameter"], d["height"], d["bore"]
    shape = Cylinder(diameter / 2, height, align=LOW) - Cylinder(bore / 2, 4 * height)
    return shape, {"body": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
