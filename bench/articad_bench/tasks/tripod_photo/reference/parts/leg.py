from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Rot(X=90) * Cylinder(8, d["eye_width"]) + Pos(0, 0, -d["leg_length"]) * Cylinder(d["leg_radius"], d["leg_length"] - 5, align=LOW)
    body -= Rot(X=90) * Cylinder(d["pin_radius"] + d["clearance"], d["eye_width"] + 10)
    body -= Pos(0, 0, -d["leg_length"] - 1) * Cylinder(d["rod_radius"] + d["clearance"], d["leg_length"] - 29, align=LOW)

    return body, {
        "hinge": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (0, 0, 1)},
        "extend": {"o": (0, 0, -d["leg_length"]), "z": (0, 0, -1), "x": (1, 0, 0)},
    }
