from build123d import Align, Box, Cylinder, Pos, Rot

LEFT = (Align.MIN, Align.CENTER, Align.CENTER)


def build(part):
    d = part.dimensions
    body = Cylinder(16, d["eye"]) + Box(d["head_reach"], 26, 26, align=LEFT) + Pos(d["head_reach"], 0, 0) * Rot(X=90) * Cylinder(14, 40)
    body -= Cylinder(d["pin"] + d["clearance"], 2 * d["eye"])
    body -= Pos(d["head_reach"], 0, 0) * Rot(X=90) * Cylinder(d["tilt_pin"] + d["clearance"], 60)

    return body, {
        "swivel": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "tilt": {"o": (d["head_reach"], 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
