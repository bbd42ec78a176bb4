from build123d import Align, Box, Cylinder, Pos, Rot

CCM = (Align.CENTER, Align.CENTER, Align.MIN)


def rod(r, y0, y1):
    return Pos(0, y0, 0) * Rot(X=-90) * Cylinder(r, y1 - y0, align=CCM)


def build(part):
    d = part.dimensions
    t = d["thickness"]
    shape = Box(2 * d["half_x"], t, d["height"], align=(Align.CENTER, Align.MIN, Align.MIN))
    w, g, e, p = d["wheel_x"], d["great_z"], d["escape_z"], d["pallet_z"]
    for x, z, r in ((w, g, d["hub_bore_radius"]), (w, e, d["bore_radius"]), (0, e, d["bore_radius"]), (0, p, d["bore_radius"])):
        shape -= Pos(x, 0, z) * rod(r, -1, t + 1)
    return shape, {"seat": {"o": (d["seat_x"], 0, d["seat_z"]), "z": (0, 1, 0), "x": (1, 0, 0)}}
