from build123d import Align, Box, Cylinder, Pos

LEFT = (Align.MIN, Align.CENTER, Align.CENTER)


def build(part):
    d = part.dimensions
    body = Pos(-24, 0, 0) * Box(d["reach"] + 26, 26, 30, align=LEFT) + Pos(d["reach"], 0, 0) * Cylinder(15, 30)
    body -= Box(d["bar_width"] + 2 * d["clearance"], d["bar_thick"] + 2 * d["clearance"], 100)
    body -= Pos(d["reach"], 0, 0) * Cylinder(d["spindle"] + d["clearance"], 100)

    return body, {
        "slide": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "spindle": {"o": (d["reach"], 0, 0), "z": (0, 0, -1), "x": (1, 0, 0)},
    }
