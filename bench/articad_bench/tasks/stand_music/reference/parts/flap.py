from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
LEFT_LOW = (Align.MIN, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(7, -d["back"], -20) * Box(d["flap_width"], 4, 260, align=LEFT_LOW)
    for z in (30.5, 180.5):
        body += Pos(0, 0, z) * (
            Cylinder(5, 26, align=LOW)
            + Pos(0, 0, 0) * Box(11, d["back"] + 2, 26, align=(Align.MIN, Align.MAX, Align.MIN))
            - Cylinder(d["hinge_pin"] + d["clearance"], 100)
        )

    return body, {"flap": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
