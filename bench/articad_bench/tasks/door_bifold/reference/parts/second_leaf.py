from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
LEFT_LOW = (Align.MIN, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(d["start"], 0, 10) * Box(d["leaf"] - 2 * d["start"], d["thick"], d["leaf_height"], align=LEFT_LOW)
    for z in (160.5, 760.5):
        body += Pos(0, 0, z) * (
            Cylinder(10, 60, align=LOW) + Box(d["start"] + 5, 12, 60, align=LEFT_LOW) - Cylinder(d["hinge_pin"] + d["clearance"], 200)
        )
    body += Pos(d["leaf"], 0, d["leaf_height"] - 50) * (
        Cylinder(12, 60, align=LOW)
        + Pos(-d["start"] - 5, 0, 0) * Box(d["start"] + 5, 16, 60, align=LEFT_LOW)
        + Cylinder(d["pin"], 84, align=LOW)
        + Cylinder(9, d["lintel_z"] + 50.7 - d["leaf_height"], align=LOW)  # carries the shoe
    )

    return body, {
        "fold": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "shoe": {"o": (d["leaf"], 0, d["lintel_z"] + 1), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
