from build123d import Box, Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    length, width, height, rail_hole, rail_pitch = d["length"], d["width"], d["height"], d["rail_hole"], d["rail_pitch"]
    screw_hole = d["screw_hole"]
    shape = Pos(length / 2, 0, 0) * Box(length, width, height)
    shape -= [Pos(0, y, 0) * Rot(Y=90) * Cylinder(rail_hole / 2, 4 * length) for y in (-rail_pitch / 2, rail_pitch / 2)]
    shape -= Rot(Y=90) * Cylinder(screw_hole / 2, 4 * length)
    return shape, {"base": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
