from build123d import Align, Circle, Cylinder, Pos, extrude, make_hull

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    outline = make_hull([edge for x in (0, d["length"]) for edge in (Pos(x, 0) * Circle(d["eye"])).edges()])
    shape = extrude(outline, d["thickness"]) + Pos(0, 0, -d["shaft"]) * Cylinder(d["shaft_r"], d["shaft"] + 1, align=LOW)
    shape += Pos(d["length"], 0, d["thickness"] / 2) * Cylinder(d["pin_r"], d["p_high"] - (d["thickness"] / 2), align=LOW)
    return shape, {
        "shaft": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "p": {"o": (d["length"], 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
