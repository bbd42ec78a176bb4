from build123d import Align, Box, Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    t = d["thickness"]
    shape = Box(2 * d["half_x"], t, 2 * d["half_z"], align=(Align.CENTER, Align.MIN, Align.CENTER))
    hole = Rot(X=-90) * Cylinder(d["hole_radius"], t + 2, align=(Align.CENTER, Align.CENTER, Align.MIN))
    shape -= Pos(d["hole_x"], -1, d["hole_z"]) * hole
    return shape, {"seat": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)}}
