from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    body = Box(20, 700, d["rail_height"], align=LOW) - Pos(0, 0, 30) * Box(40, 640, d["rail_height"] - 60, align=LOW)
    for y in (-250, 250):
        body += Pos(0, y, 1) * Cylinder(d["rail_post"], 260, align=HIGH)

    return body, {"rail": {"o": (0, 0, -190), "z": (0, 0, -1), "x": (1, 0, 0)}}
