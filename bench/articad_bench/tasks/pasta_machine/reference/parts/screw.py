from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Pos(0, 0, -60) * Cylinder(d["screw"], 90, align=LOW)
        + Pos(0, 0, -64) * Box(40, 8, 8, align=LOW)
        + Pos(0, 0, 27) * Cylinder(d["plate_radius"], 5, align=LOW)
    )
    return body, {"clamp": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
