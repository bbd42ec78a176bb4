from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
BACK = (Align.CENTER, Align.MAX, Align.MIN)


def build(part):
    d = part.dimensions
    gap = d["width"] - 70
    body = Pos(0, -12, -1.5) * Box(d["width"], d["depth"], d["lid_height"], align=BACK) - Pos(0, -12 - d["wall"], -2) * Box(
        d["width"] - 2 * d["wall"], d["depth"] - 2 * d["wall"], d["lid_height"] - d["wall"] + 0.5, align=BACK
    )
    body += Pos(0, 0, -1.5) * Box(gap, 13, 4, align=BACK) + Rot(Y=90) * Cylinder(5, gap) + Rot(Y=90) * Cylinder(d["pin"], gap + 17)
    for x in (-62, 62):
        body += Pos(x, -12 - d["depth"] / 2, d["lid_height"] - 2.5) * Box(6, 14, 15, align=LOW)
    body += Pos(0, -12 - d["depth"] / 2, d["lid_height"] + 6) * Rot(Y=90) * Cylinder(d["handle_pin"], 130)

    return body, {
        "lid": {"o": (0, 0, 0), "z": (-1, 0, 0), "x": (0, 1, 0)},
        "handle": {"o": (0, -12 - d["depth"] / 2, d["lid_height"] + 6), "z": (-1, 0, 0), "x": (0, 1, 0)},
    }
