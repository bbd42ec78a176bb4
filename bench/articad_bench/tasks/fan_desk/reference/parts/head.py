from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(0, 0, 0.3) * Cylinder(20, 34, align=LOW) - Cylinder(d["post"] + d["clearance"], 30.5, align=LOW)
    for side in (-1, 1):
        body += Pos(side * (d["eye"] / 2 + 4.5), 0, 10) * Box(8, 20, d["tilt_z"], align=LOW)
    body += (
        Pos(0, 0, 11) * Cylinder(20, 20, align=LOW)
        - Pos(0, 0, 34.3) * Box(d["eye"] + 1, 60, 60, align=LOW)
        - Cylinder(d["post"] + d["clearance"], 30.5, align=LOW)
    )
    body += Pos(0, 0, d["tilt_z"] + 3) * Rot(Y=90) * Cylinder(d["tilt_pin"], d["eye"] + 17)

    return body, {
        "swing": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "tip": {"o": (0, 0, d["tilt_z"] + 3), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
