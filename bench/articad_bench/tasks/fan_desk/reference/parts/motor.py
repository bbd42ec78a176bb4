from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Rot(Y=90) * Cylinder(8.5, d["eye"])
        + Box(d["eye"], 15, 40, align=LOW)
        + Pos(0, 45, 60) * Rot(X=90) * Cylinder(d["housing"], 85, align=LOW)
        + Pos(0, 0, 60) * Rot(X=90) * Cylinder(d["shaft"], 80, align=LOW)
    )
    body -= Rot(Y=90) * Cylinder(d["tilt_pin"] + d["clearance"], 200)

    return body, {
        "tip": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)},
        "spin": {"o": (0, -68, 60), "z": (0, 1, 0), "x": (1, 0, 0)},
        "guard": {"o": (0, -40, 60), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
