from build123d import Align, Box, Cylinder, Pos, Rot

CCM = (Align.CENTER, Align.CENTER, Align.MIN)


def rod(r, y0, y1):
    return Pos(0, y0, 0) * Rot(X=-90) * Cylinder(r, y1 - y0, align=CCM)


def build(part):
    d = part.dimensions
    t = d["thickness"]
    shape = Box(2 * d["half_x"], t, d["height"], align=(Align.CENTER, Align.MIN, Align.MIN))
    for x in (-d["pillar_x"], d["pillar_x"]):
        for z in (d["pillar_low"], d["pillar_high"]):
            shape += Pos(x, 0, z) * rod(d["pillar_radius"], t - 0.5, d["pillar_end"])
    w, g, e, p = d["wheel_x"], d["great_z"], d["escape_z"], d["pallet_z"]
    for x, z, r in ((w, g, d["hub_bore_radius"]), (w, e, d["bore_radius"]), (0, e, d["bore_radius"]), (0, p, d["bore_radius"])):
        shape -= Pos(x, 0, z) * rod(r, -1, t + 1)
    y = d["axis_y"]

    def frame(o, z):
        return {"o": o, "z": z, "x": (1, 0, 0)}

    return shape, {
        "foot": frame((0, 0, 0), (0, 0, 1)),
        "pillar": frame((d["pillar_x"], d["pillar_end"], d["pillar_low"]), (0, 1, 0)),
        "great": frame((w, y, g), (0, 1, 0)),
        "intermediate": frame((w, y, e), (0, 1, 0)),
        "escape": frame((0, y, e), (0, 1, 0)),
        "pallet": frame((0, y, p), (0, 1, 0)),
    }
