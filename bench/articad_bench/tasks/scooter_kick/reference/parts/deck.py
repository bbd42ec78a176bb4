from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
LEFT_LOW = (Align.MIN, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(0, 0, 52) * Box(d["board"], 110, 18, align=LOW)
    for side in (-1, 1):
        body += Pos(-180, side * (d["wheel_width"] / 2 + 6), 61) * Box(
            -d["rear_x"] - 172, 8, 18, align=(Align.MAX, Align.CENTER, Align.CENTER)
        ) + Pos(d["rear_x"], side * (d["wheel_width"] / 2 + 6), d["wheel"]) * Rot(X=90) * Cylinder(12, 8)
        body += Pos(-180, side * 20, 60) * Box(14, 8, 56, align=LOW)
        body += Pos(d["neck_x"] - 30, side * 19.5, 60) * Box(42, 10, d["neck_z"] - 48, align=LEFT_LOW)
    body += (
        Pos(-180, 0, 108) * Rot(X=90) * Cylinder(d["flap_pin"], 46)
        + Pos(d["neck_x"], 0, d["neck_z"]) * Rot(X=90) * Cylinder(d["neck_pin"], 48)
        + Pos(d["rear_x"], 0, d["wheel"]) * Rot(X=90) * Cylinder(d["axle"], d["wheel_width"] + 20)
    )

    return body, {
        "rear_wheel": {"o": (d["rear_x"], 0, d["wheel"]), "z": (0, 1, 0), "x": (1, 0, 0)},
        "flap": {"o": (-180, 0, 108), "z": (0, 1, 0), "x": (1, 0, 0)},
        "fold": {"o": (d["neck_x"], 0, d["neck_z"]), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
