from build123d import Align, Box, Cylinder, Pos, Rot

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    body = Pos(0, 0, 0) * Box(d["arm_thick"], d["arm_width"], d["drop"] - 10, align=HIGH) + Pos(0, 0, 12 - d["drop"]) * Box(
        d["arm_thick"], d["lug"] + 9, 6, align=HIGH
    )
    for side in (-1, 1):
        body += Pos(0, side * (d["lug"] / 2 + 2.5), 12 - d["drop"]) * Box(d["arm_thick"], 4, 18, align=HIGH)
    body += Pos(0, 0, -d["drop"]) * Rot(X=90) * Cylinder(d["pin"], d["lug"] + 9)

    return body, {
        "size": {"o": (0, 0, 0), "z": (0, 0, -1), "x": (1, 0, 0)},
        "tilt": {"o": (0, 0, -d["drop"]), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
