from build123d import Circle, Cylinder, Pos, Rot, extrude, make_hull

FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    spots = [(0, 0), (d["length"], 0)]
    outline = make_hull([edge for spot in spots for edge in (Pos(*spot) * Circle(d["eye"])).edges()])
    shape = Pos(0, 0, d["low"]) * extrude(outline, d["thickness"])
    shape -= Pos(d["length"], 0, 0) * Cylinder(d["bore_r"], 1000)
    shape -= Pos(0, 0, 0) * Cylinder(d["bore_r"], 1000)
    return FRONT * shape, {
        "h": {"o": (d["length"], 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "y": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
