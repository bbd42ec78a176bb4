from build123d import Align, Box, Cylinder, Pos, Rot

BACK = (Align.CENTER, Align.MAX, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(0, -8, -2) * Box(d["width"], d["depth"] + 2, d["lid"], align=BACK) + Pos(0, 0, -2) * Box(
        d["ear_gap"], 10, d["lid"], align=BACK
    )
    body += Rot(Y=90) * Cylinder(4, d["ear_gap"]) + Rot(Y=90) * Cylinder(d["pin_radius"], d["ear_gap"] + 14)

    return body, {"lid": {"o": (0, 0, 0), "z": (-1, 0, 0), "x": (0, 1, 0)}}
