from build123d import Circle, Cylinder, Pos, extrude, make_hull


def build(part):
    d = part.dimensions
    spots = [(0, 0), (d["length"], 0)]
    outline = make_hull([edge for spot in spots for edge in (Pos(*spot) * Circle(d["eye"])).edges()])
    shape = Pos(0, 0, d["low"]) * extrude(outline, d["thickness"])
    shape -= Pos(0, 0, 0) * Cylinder(d["bore_r"], 1000)
    shape -= Pos(d["length"], 0, 0) * Cylinder(d["bore_r"], 1000)
    return shape, {
        "b3": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "c3": {"o": (d["length"], 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
