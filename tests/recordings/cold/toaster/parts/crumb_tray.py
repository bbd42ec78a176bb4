from build123d import *

SIDE = (Align.MIN, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, width, height, wall = d["length"], d["width"], d["height"], d["wall"]
    plate = d["plate_thickness"]
    shape = Box(length, width, height, align=SIDE)
    shape += Pos(-plate, 0, 0) * Box(plate + wall / 2, width, height, align=SIDE)
    shape += Pos(-plate, 0, 0) * Box(plate, d["plate_width"], d["plate_height"], align=SIDE)
    shape += Pos(-plate - d["grip_length"], 0, d["plate_height"] - d["grip_thickness"]) * Box(
        d["grip_length"] + 1, d["grip_width"], d["grip_thickness"], align=SIDE)
    shape -= Pos(wall, 0, wall) * Box(length - 2 * wall, width - 2 * wall, height - wall + 1, align=SIDE)
    return shape, {"slide": {"o": (0, 0, 0), "z": (-1, 0, 0), "x": (0, 0, 1)}}
