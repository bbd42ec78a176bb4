from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
BACK = (Align.CENTER, Align.MAX, Align.MIN)
NEAR = (Align.CENTER, Align.MIN, Align.CENTER)


def build(part):
    d = part.dimensions
    body = Pos(0, 0, 40) * Rot(Y=90) * Cylinder(10, 2 * d["inner"] + 4)
    for side in (-1, 1):
        x = side * (d["inner"] + d["plate"] / 2)
        body += (
            Pos(x, 0, 0) * Box(d["plate"], 60, d["handle_z"] + 20, align=LOW)
            + Pos(x, 0, d["wheel"]) * Box(d["plate"], 130, 30, align=NEAR)
            + Pos(side * (d["inner"] + 2), 120, d["wheel"]) * Rot(Y=90 * side) * Cylinder(d["wheel_axle"], d["plate"] + 40, align=LOW)
        )
        body += Pos(x, -20, 0) * Box(d["plate"], 60, 20, align=BACK)
    body -= Pos(0, 0, d["drum_z"]) * Rot(Y=90) * Cylinder(d["drum_axle"] + d["clearance"], 900) + Pos(0, 0, d["handle_z"]) * Rot(
        Y=90
    ) * Cylinder(d["handle_pin"] + d["clearance"], 900)

    return body, {
        "drum": {"o": (0, 0, d["drum_z"]), "z": (1, 0, 0), "x": (0, 1, 0)},
        "wheel": {"o": (d["inner"] + d["plate"] + 22, 120, d["wheel"]), "z": (1, 0, 0), "x": (0, 1, 0)},
        "left_wheel": {"o": (-d["inner"] - d["plate"] - 22, 120, d["wheel"]), "z": (1, 0, 0), "x": (0, 1, 0)},
        "handle": {"o": (0, 0, d["handle_z"]), "z": (-1, 0, 0), "x": (0, 1, 0)},
    }
