from build123d import Align, Cylinder, Rot, chamfer

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    nut = Cylinder(d["radius"], d["length"], align=LOW)
    nut = chamfer(nut.edges(), 1) - Cylinder(d["hole_radius"], d["hole_depth"], align=LOW)
    return Rot(X=-90) * nut, {"face": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (0, 0, 1)}}
