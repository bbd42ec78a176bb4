from build123d import Align, Cylinder, Pos, Rot, Sphere

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, apart, housing, under, over = d["diameter"], d["apart"], d["housing"], d["under"], d["over"]
    socket = d["socket"]
    shape = Pos(0, 0, (over - under) / 2) * Rot(Y=90) * Cylinder(diameter / 2, apart)
    shape += [Pos(x, 0, -under) * Cylinder(housing / 2, under + over, align=LOW) for x in (-apart / 2, apart / 2)]
    shape -= [Pos(x, 0, 0) * Sphere(socket / 2) for x in (-apart / 2, apart / 2)]
    return shape, {
        "left": {"o": (-apart/2, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "right": {"o": (apart/2, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
