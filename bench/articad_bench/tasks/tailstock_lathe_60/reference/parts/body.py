from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    length, sole, sole_height, web, axis_z = d["length"], d["sole"], d["sole_height"], d["web"], d["axis_z"]
    barrel, bore, bore_depth, journal, lever_x = d["barrel"], d["bore"], d["bore_depth"], d["journal"], d["lever_x"]
    lever_bore, top = d["lever_bore"], d["top"]
    shape = Box(length, sole, sole_height, align=LOW) + Box(length, web, axis_z, align=LOW)
    shape += Pos(0, 0, axis_z) * Rot(Y=90) * Cylinder(barrel / 2, length)
    shape += Pos(lever_x, 0, axis_z) * Cylinder(lever_bore, top - axis_z, align=LOW)
    shape -= Pos(-length / 2, 0, axis_z) * Rot(Y=90) * Cylinder(bore / 2, bore_depth, align=LOW)
    shape -= Pos(0, 0, axis_z) * Rot(Y=90) * Cylinder(journal / 2, length, align=LOW)
    shape -= Pos(lever_x, 0, top) * Cylinder(lever_bore / 2, 14, align=HIGH)
    return shape, {
        "quill": {"o": (-length/2, 0, axis_z), "z": (-1, 0, 0), "x": (0, 1, 0)},
        "wheel": {"o": (length/2, 0, axis_z), "z": (1, 0, 0), "x": (0, 1, 0)},
        "lever": {"o": (lever_x, 0, top), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
