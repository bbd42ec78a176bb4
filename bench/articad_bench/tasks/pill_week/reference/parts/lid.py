from build123d import Align, Box, Cylinder, Pos, Rot

BACK = (Align.CENTER, Align.MAX, Align.MIN)


def build(part):
    d = part.dimensions
    gap = d["cell"] - d["ear"] - 0.8
    body = Pos(0, -4 - d["wall"] - 0.5, -1.6) * Box(d["cell"] - 1, d["depth"] - d["wall"], d["lid"], align=BACK) + Pos(0, 0, -1.6) * Box(
        gap, 8, d["lid"], align=BACK
    )
    body += Rot(Y=90) * Cylinder(3, gap) + Rot(Y=90) * Cylinder(d["pin_radius"], d["cell"] - 1)

    return body, {"hinge": {"o": (0, 0, 0), "z": (-1, 0, 0), "x": (0, 1, 0)}}
