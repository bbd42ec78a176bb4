from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    body = Cylinder(d["stem_radius"], 22, align=LOW) + Pos(-d["trail"] / 2, 0, 0) * Box(
        d["trail"] + 18, d["wheel_width"] + 10, 8, align=HIGH
    )
    body += Pos(-d["trail"], 0, 0) * (
        Box(16, d["wheel_width"] + 10, d["axle_drop"] + 7, align=HIGH) - Pos(0, 0, -8) * Box(40, d["wheel_width"] + 2, 100, align=HIGH)
    )
    body += Pos(-d["trail"], 0, -d["axle_drop"]) * Rot(X=90) * Cylinder(d["axle_radius"], d["wheel_width"] + 10)

    return body, {
        "swivel_0": {"o": (0, 0, 0.5), "z": (0, 0, 1), "x": (1, 0, 0)},
        "roll_0": {"o": (-d["trail"], 0, -d["axle_drop"]), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
