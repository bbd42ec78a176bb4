from build123d import Align, Box, Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    w, l, h, wall = d["width"], d["length"], d["height"], d["wall"]
    top = (Align.CENTER, Align.CENTER, Align.MAX)
    up = (Align.CENTER, Align.CENTER, Align.MIN)
    shape = Box(w, l, h, align=top)
    shape = shape - Pos(0, 0, -h + d["bottom"]) * Box(w - 2 * wall, l - 2 * wall, h, align=up)
    s = d["shaft_y"]
    for y in (-s, 0, s):
        shape = shape - Pos(0, y, 0) * Rot(Y=90) * Cylinder(d["notch_radius"], w + 2)
    x = (0, 0, 1)
    return shape, {
        "rim": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "rear_shaft": {"o": (0, s, 0), "z": (1, 0, 0), "x": x},
        "front_shaft": {"o": (0, -s, 0), "z": (1, 0, 0), "x": x},
        "idler_shaft": {"o": (0, 0, 0), "z": (1, 0, 0), "x": x},
    }
