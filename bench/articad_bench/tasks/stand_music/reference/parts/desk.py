from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
BACK = (Align.CENTER, Align.MAX, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(0, -24, -20) * Box(d["desk_width"], 6, d["desk_height"], align=(Align.CENTER, Align.CENTER, Align.MIN)) + Pos(
        0, -22, -20
    ) * Box(d["desk_width"], 35, 6, align=BACK)
    for side in (-1, 1):
        body += Pos(side * (d["eye"] / 2 + 4.5), 9, 0) * Box(8, 34, 22, align=(Align.CENTER, Align.MAX, Align.CENTER))
        for z in (0, 150):
            body += Pos(side * (d["desk_width"] / 2 + d["edge"]), d["back"] - 24, z) * (
                Cylinder(5, 30, align=LOW)
                + Cylinder(d["hinge_pin"], 58, align=LOW)
                + Pos(-side * (d["edge"] + 3), 0, 0)
                * Box(d["edge"] + 4, 9, 30, align=(Align.MIN if side > 0 else Align.MAX, Align.MAX, Align.MIN))
            )
    body += Rot(Y=90) * Cylinder(d["tilt_pin"], d["eye"] + 17)

    return body, {
        "tilt": {"o": (0, 0, 0), "z": (-1, 0, 0), "x": (0, 1, 0)},
        "flap": {"o": (d["desk_width"] / 2 + d["edge"], d["back"] - 24, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "left_flap": {"o": (-d["desk_width"] / 2 - d["edge"], d["back"] - 24, 0), "z": (0, 0, 1), "x": (-1, 0, 0)},
    }
