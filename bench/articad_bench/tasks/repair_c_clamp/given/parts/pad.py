from build123d import Align, Cylinder, Pos, Sphere

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, under, over, socket = d["diameter"], d["under"], d["over"], d["socket"]
    shape = Pos(0, 0, -under) * Cylinder(diameter / 2, under + over, align=LOW) - Sphere(socket / 2)
    return shape, {"ball": {"o": (0, 0, 0), "z": (0, 0, -1), "x": (1, 0, 0)}}
