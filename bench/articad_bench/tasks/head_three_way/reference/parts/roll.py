from build123d import Align, Box, Cylinder, Pos, Rot

LEFT = (Align.MIN, Align.CENTER, Align.CENTER)
LEFT_LOW = (Align.MIN, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Box(20, 40, 40, align=LEFT) + Pos(-18, 0, 18) * Box(64, 52, 8, align=LEFT_LOW)
    for side in (-1, 1):
        body += Pos(-18, side * (d["slot"] / 2 + 3), 26) * Box(64, 6, 8, align=LEFT_LOW)
    body -= Rot(Y=90) * Cylinder(d["roll_pin"] + d["clearance"], 100)

    return body, {"roll": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}, "slide": {"o": (14, 0, 26), "z": (1, 0, 0), "x": (0, 1, 0)}}
