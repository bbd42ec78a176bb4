from build123d import Align, Cylinder, Pos, Rot

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length = d["length"]
    ring = Cylinder(d["outer_radius"], length, align=UP)
    ring -= Pos(0, 0, -1) * Cylinder(d["bore_radius"], length + 2, align=UP)
    return Rot(X=-90) * ring, {"seat": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)}}
