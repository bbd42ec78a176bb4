from build123d import Align, Box, Cylinder, GridLocations, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    width, depth, height, sheet, hole = d["width"], d["depth"], d["height"], d["sheet"], d["hole"]
    pitch = d["pitch"]
    shape = Box(width, depth, height, align=LOW) - Box(2 * width, depth - 2 * sheet, height - sheet, align=LOW)
    shape -= Pos(0, 0, height) * GridLocations(pitch, pitch, 5, 2) * Cylinder(hole / 2, 3 * sheet)
    return shape, {}
