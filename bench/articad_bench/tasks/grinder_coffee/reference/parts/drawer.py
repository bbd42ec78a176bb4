from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = (Align.CENTER, Align.MIN, Align.MIN)


def build(part):
    d = part.dimensions
    body = Box(d["drawer_width"], d["drawer_depth"], d["drawer_height"], align=FRONT) - Pos(0, d["wall"], d["wall"]) * Box(
        d["drawer_width"] - 2 * d["wall"], d["drawer_depth"] - 2 * d["wall"], d["drawer_height"], align=FRONT
    )
    body += Pos(0, 0, d["drawer_height"] / 2) * Rot(X=90) * Cylinder(7, 14, align=LOW)

    return body, {"drawer": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)}}
