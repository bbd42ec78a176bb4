from build123d import Align, Box, Cylinder, Pos, Rot

LEFT = (Align.MIN, Align.CENTER, Align.CENTER)


def build(part):
    d = part.dimensions
    body = Rot(X=90) * Cylinder(7.5, 14) + Box(d["boom"], 14, 14, align=LEFT) + Pos(d["boom"], 0, 0) * Rot(X=90) * Cylinder(8, 14)
    body -= Pos(d["boom"], 0, 0) * Box(28, 8.6, 40)
    body += Pos(d["boom"], 0, 0) * Rot(X=90) * Cylinder(d["pin"], 14)
    body -= Rot(X=90) * Cylinder(d["root_pin"] + d["clearance"], 40)

    return body, {
        "boom": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "stick": {"o": (d["boom"], 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
