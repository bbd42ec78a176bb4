from build123d import Align, Axis, Cylinder, Pos, Rot, chamfer

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    hl, sl, r = d["head_length"], d["shaft_length"], d["thread_radius"]
    head = Pos(0, 0, -hl) * Cylinder(d["head_radius"], hl, align=UP)
    shaft = Pos(0, 0, -1) * Cylinder(r, sl + 1, align=UP)
    shaft = chamfer(shaft.edges().group_by(Axis.Z)[-1], length=d["tip_chamfer"])
    shape = Rot(X=-90) * (head + shaft)
    shape -= Pos(0, -hl / 2, 0) * Rot(Y=90) * Cylinder(d["cross_radius"], 2 * d["head_radius"] + 4)
    along = {"z": (0, 1, 0), "x": (1, 0, 0)}
    return shape, {
        "thread": {"o": (0, d["nut_y"], 0), **along},
        "journal": {"o": (0, d["bearing_y"], 0), **along},
        "collar_seat": {"o": (0, d["collar_y"], 0), **along},
        "cross_hole": {"o": (0, -hl / 2, 0), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
