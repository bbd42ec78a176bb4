from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, width, thickness, stem, head = d["length"], d["width"], d["thickness"], d["stem"], d["head"]
    step, bracket, bracket_height, screw_y, screw_z = d["step"], d["bracket"], d["bracket_height"], d["screw_y"], d["screw_z"]
    bore = d["bore"]
    shape = Pos(bracket / 2, 0, 0) * Box(length + bracket, width, thickness, align=LOW)
    shape += Pos(0, 0, thickness) * Box(length, stem, 2 * step, align=LOW) + Pos(0, 0, thickness + step) * Box(length, head, step, align=LOW)
    shape += Pos((length + bracket) / 2, 0, 0) * Box(bracket, width, bracket_height, align=LOW)
    shape -= Pos(length / 2, screw_y, screw_z) * Rot(Y=90) * Cylinder(bore / 2, 4 * bracket)
    return shape, {
        "saddle": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)},
        "screw": {"o": (length/2 + bracket, screw_y, screw_z), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
