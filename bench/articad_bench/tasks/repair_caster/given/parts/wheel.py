from build123d import Cylinder


def build(part):
    d = part.dimensions
    diameter, width, bore = d["diameter"], d["width"], d["bore"]
    shape = Cylinder(diameter / 2, width) - Cylinder(bore / 2, 4 * width)
    return shape, {"axle": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
