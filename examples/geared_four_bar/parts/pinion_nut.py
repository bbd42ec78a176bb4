from build123d import Align, Cylinder, chamfer

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    nut = Cylinder(d["radius"], d["length"], align=HIGH)
    nut = chamfer(nut.edges(), 1) - Cylinder(d["hole_radius"], d["hole_depth"], align=HIGH)
    return nut, {"face": {"o": (0, 0, 0), "z": (0, 0, -1), "x": (1, 0, 0)}}
