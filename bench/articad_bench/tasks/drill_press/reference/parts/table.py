from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
BACK = (Align.CENTER, Align.MAX, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Cylinder(38, 50)
        + Pos(0, -d["plate_reach"], 9) * Cylinder(d["plate_radius"], 16, align=LOW)
        + Pos(0, 0, 9) * Box(60, d["plate_reach"], 16, align=BACK)
    )
    body -= Cylinder(d["column"] + d["clearance"], 200) + Pos(0, -d["plate_reach"], 0) * Cylinder(12, 200)

    return body, {"table": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
