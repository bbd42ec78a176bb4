from build123d import Align, Circle, Cylinder, Pos, extrude, make_hull

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    spots = [(0, 0), (d["length"], 0)]
    outline = make_hull([edge for spot in spots for edge in (Pos(*spot) * Circle(d["eye"])).edges()])
    shape = Pos(0, 0, d["low"]) * extrude(outline, d["thickness"])
    shape -= Pos(0, 0, 0) * Cylinder(d["bore_r"], 1000)
    shape += Pos(d["length"], 0, d["low"] + d["thickness"] / 2) * Cylinder(d["pin_r"], d["c_high"] - (d["low"] + d["thickness"] / 2), align=LOW)
    return shape, {
        "a": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "c": {"o": (d["length"], 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
