from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)
LEFT_LOW = (Align.MIN, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(d["start"], 0, 10) * Box(d["leaf"] - 2 * d["start"], d["thick"], d["leaf_height"], align=LEFT_LOW)
    body += Pos(0, 0, 10) * (
        Box(d["start"] + 5, 16, 60, align=LEFT_LOW)
        + Cylinder(12, 60, align=LOW)
        + Cylinder(d["pin"], 74, align=HIGH)
        - Pos(0, 0, -24) * Cylinder(40, 60, align=HIGH)
    )
    body += Pos(0, 0, 0.3) * Cylinder(12, 10, align=LOW)  # carries the leaf on the sill
    body += Pos(0, 0, d["leaf_height"] - 50) * (
        Box(d["start"] + 5, 16, 60, align=LEFT_LOW) + Cylinder(12, 60, align=LOW) + Cylinder(d["pin"], 84, align=LOW)
    )
    for z in (100, 700):
        body += Pos(d["leaf"], 0, z) * (
            Cylinder(10, 60, align=LOW)
            + Pos(-d["start"] - 5, 0, 0) * Box(d["start"] + 5, 12, 60, align=LEFT_LOW)
            + Cylinder(d["hinge_pin"], 110, align=LOW)
        )

    return body, {
        "pivot": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "fold": {"o": (d["leaf"], 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
