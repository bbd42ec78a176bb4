from build123d import Align, Box, Cylinder, Pos, Rot

CCM = (Align.CENTER, Align.CENTER, Align.MIN)


def rod(r, y0, y1):
    return Pos(0, y0, 0) * Rot(X=-90) * Cylinder(r, y1 - y0, align=CCM)


def build(part):
    d = part.dimensions
    y, h, wx = d["handle_y"], d["handle_half"], d["wing_x"]
    shape = Pos(0, y, 0) * Box(2 * wx, 2 * d["web_half"], 2 * h)
    for x in (-wx, wx):
        shape += Pos(x, y, 0) * Cylinder(d["wing_radius"], 2 * h)
    shape += rod(d["boss_radius"], d["boss_y"], y)
    shape += rod(d["shaft_radius"], d["shaft_front"], d["boss_y"] + (y - d["boss_y"]) / 2)
    for x in (-wx, wx):
        shape -= Pos(x, y, 0) * Cylinder(d["wing_hole_radius"], 2 * h + 2)
    return shape, {"axis": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)}}
