from math import sqrt

from build123d import Align, Cylinder, Pos, RegularPolygon, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    hh, ls, sd = d["head_height"], d["shank_length"], d["socket_depth"]
    shape = Cylinder(d["head_radius"], hh, align=UP)
    shape += Pos(0, 0, -ls) * Cylinder(d["shank_radius"], ls + hh / 4, align=UP)
    socket = extrude(RegularPolygon(d["socket_flats"] / sqrt(3), side_count=6), amount=sd + 1)
    shape -= Pos(0, 0, hh - sd) * socket
    c = part.connectors["seat"]
    return shape, {"seat": {"o": (0, 0, 0), "z": c.z, "x": c.x}}
