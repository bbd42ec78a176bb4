from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    shape = Rot(Y=90) * Cylinder(d["radius"], 2 * d["half"]) + Pos(-d["neck_end"], 0, 0) * Rot(Y=90) * Cylinder(d["neck_r"], d["neck_end"] + d["shaft_end"], align=LOW)
    shape += Pos(d["shaft_end"] - d["bar_r"], 0, 0) * Rot(X=90) * Cylinder(d["bar_r"], d["bar_l"])
    return shape, {
        "axis": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 0, 1)},
    }
