from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    hub, height, hole, arm, width = d["hub"], d["height"], d["hole"], d["arm"], d["width"]
    shape = Cylinder(hub / 2, height, align=LOW) + Pos(0, arm / 2, height / 2) * Box(width, arm, height / 2)
    shape -= Cylinder(hole / 2, 3 * height)
    return shape, {"shaft": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
