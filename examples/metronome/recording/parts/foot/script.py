from build123d import Align, Cylinder


def build(part):
    d = part.dimensions
    shape = Cylinder(d["radius"], d["height"], align=(Align.CENTER, Align.CENTER, Align.MAX))
    return shape, {"seat": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
