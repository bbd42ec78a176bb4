from build123d import Align, Box, Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    length, t = d["length"], d["thickness"]
    shape = Box(d["bar_width"], t, length, align=(Align.CENTER, Align.CENTER, Align.MIN))
    for z in (0, length):
        shape += Pos(0, 0, z) * Rot(X=90) * Cylinder(d["eye_radius"], t)
    shape -= Rot(X=90) * Cylinder(d["lower_bore_radius"], t + 2)
    shape -= Pos(0, 0, length) * Rot(X=90) * Cylinder(d["upper_bore_radius"], t + 2)
    z, x = (0, -1, 0), (1, 0, 0)
    return shape, {
        "lower": {"o": (0, 0, 0), "z": z, "x": x},
        "upper": {"o": (0, 0, length), "z": z, "x": x},
    }
