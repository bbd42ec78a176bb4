from build123d import Align, Box, Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    diameter, half, groove, web = d["diameter"], d["half"], d["groove"], d["web"]
    shape = Rot(Y=90) * Cylinder(diameter / 2, 2 * half)
    shape -= Pos(-web, 0, 0) * Box(2 * half, groove, 2 * diameter, align=(Align.MAX, Align.CENTER, Align.CENTER))
    shape -= Pos(web, 0, 0) * Box(2 * half, 2 * diameter, groove, align=(Align.MIN, Align.CENTER, Align.CENTER))
    return shape, {"first": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}, "second": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)}}
