from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, width, thickness, hub_radius = d["length"], d["width"], d["thickness"], d["hub_radius"]
    shape = Cylinder(hub_radius, thickness, align=LOW) + Pos(length / 2, 0, thickness / 2) * Box(length, width, thickness)

    return shape, {"stem": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
