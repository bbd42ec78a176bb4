from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Cylinder(d["radius"], 26, align=LOW) - Cylinder(d["pan_pin"] + d["clearance"], 20.5, align=LOW)
    for side in (-1, 1):
        body += Pos(0, side * (d["eye_width"] / 2 + 4.5), 20) * Box(24, 8, 32, align=LOW)
    body += Pos(0, 0, d["tilt_z"]) * Rot(X=90) * Cylinder(d["tilt_pin"], d["eye_width"] + 17)

    return body, {
        "pan": {"o": (0, 0, -0.3), "z": (0, 0, 1), "x": (1, 0, 0)},
        "tilt": {"o": (0, 0, d["tilt_z"]), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
