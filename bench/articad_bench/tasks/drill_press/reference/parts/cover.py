from build123d import Align, Box, Cylinder, Pos, Rot

BACK = (Align.CENTER, Align.MAX, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(0, -9, -2.5) * Box(106, 200, d["hood_height"], align=BACK) - Pos(0, -13, -3) * Box(98, 192, d["hood_height"] - 4, align=BACK)
    body += (
        Pos(0, 0, -2.5) * Box(80, 20, 5, align=(Align.CENTER, Align.MAX, Align.MIN))
        + Rot(Y=90) * Cylinder(5, 80)
        + Rot(Y=90) * Cylinder(d["cover_pin"], 98)
    )

    return body, {"cover": {"o": (0, 0, 0), "z": (-1, 0, 0), "x": (0, 1, 0)}}
