from build123d import Align, Box, Cylinder, Pos

LEFT = (Align.MIN, Align.CENTER, Align.CENTER)


def build(part):
    d = part.dimensions
    body = (
        Cylinder(16, d["eye"])
        + Box(d["arm"] - 24, 24, d["eye"] - 4, align=LEFT)
        + Pos(d["arm"] - 34, 0, 0) * Box(12, 32, d["eye"] + 21, align=LEFT)
    )
    for side in (-1, 1):
        body += Pos(d["arm"] - 30, 0, side * (d["eye"] / 2 + 5.5)) * (Box(30, 32, 10, align=LEFT) + Pos(30, 0, 0) * Cylinder(16, 10))
    body += Pos(d["arm"], 0, 0) * Cylinder(d["pin"], d["eye"] + 20)
    body -= Cylinder(d["pin"] + d["clearance"], 2 * d["eye"])

    return body, {
        "shoulder": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "elbow": {"o": (d["arm"], 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
