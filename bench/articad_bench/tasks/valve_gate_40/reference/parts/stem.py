from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    diameter, below, above, collar, collar_top = d["diameter"], d["below"], d["above"], d["collar"], d["collar_top"]
    collar_height = d["collar_height"]
    shape = Pos(0, 0, -below) * Cylinder(diameter / 2, below + above, align=LOW)
    shape += Pos(0, 0, collar_top) * Cylinder(collar / 2, collar_height, align=HIGH)
    return shape, {"bonnet": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}, "wheel": {"o": (0, 0, 2), "z": (0, 0, 1), "x": (1, 0, 0)}}
