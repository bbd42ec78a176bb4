from build123d import Align, Cylinder, Pos

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    head = d["head_bottom"]
    shape = Cylinder(d["pin_radius"], head + (d["length"] - head) / 2, align=UP)
    shape += Pos(0, 0, head) * Cylinder(d["head_radius"], d["length"] - head, align=UP)
    up, x = (0, 0, 1), (1, 0, 0)
    return shape, {
        "seat": {"o": (0, 0, 0), "z": up, "x": x},
        "knob": {"o": (0, 0, d["knob_z"]), "z": up, "x": x},
    }
