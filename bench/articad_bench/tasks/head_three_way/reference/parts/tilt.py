from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    body = (
        Rot(X=90) * Cylinder(11, d["eye_width"])
        + Box(26, d["eye_width"], d["roll_z"] + 10, align=LOW)
        - Pos(0, 0, -6) * Box(60, 60, 6, align=HIGH)
    )
    body += Pos(0, 0, d["roll_z"]) * Rot(Y=90) * Cylinder(d["roll_pin"], 40, align=LOW)
    body -= Rot(X=90) * Cylinder(d["tilt_pin"] + d["clearance"], 60)

    return body, {
        "tilt": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
        "roll": {"o": (14, 0, d["roll_z"]), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
