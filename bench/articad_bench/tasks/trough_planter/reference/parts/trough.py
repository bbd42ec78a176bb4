from build123d import Align, Box, Cylinder, GridLocations, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, width, height, wall, floor = d["length"], d["width"], d["height"], d["wall"], d["floor"]
    foot, foot_height, hole, pitch = d["foot"], d["foot_height"], d["hole"], d["pitch"]
    shape = Pos(0, 0, foot_height) * Box(length, width, height - foot_height, align=LOW)
    shape += [Pos(x, 0, 0) * Box(foot, width, foot_height, align=LOW) for x in (foot - length / 2, length / 2 - foot)]
    shape -= Pos(0, 0, foot_height + floor) * Box(length - 2 * wall, width - 2 * wall, height, align=LOW)
    shape -= GridLocations(pitch, 0, 5, 1) * Cylinder(hole / 2, 3 * height)
    return shape, {}
