from build123d import Align, Box, Cylinder, Pos, Rot

LEFT = (Align.MIN, Align.CENTER, Align.CENTER)


def build(part):
    d = part.dimensions
    body = (
        Rot(X=90) * Cylinder(13, 28)
        + Box(d["head"], 28, 20, align=LEFT)
        + Pos(d["head"], 0, 10) * Cylinder(19, 80)
        - Rot(X=90) * Cylinder(d["neck_pin"] + d["clearance"], 60)
        - Pos(d["head"], 0, 0) * Cylinder(d["stem"] + d["clearance"], 300)
    )
    return body, {
        "fold": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "steer": {"o": (d["head"], 0, -30), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
