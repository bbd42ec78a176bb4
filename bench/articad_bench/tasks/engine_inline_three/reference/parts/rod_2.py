from build123d import Circle, Pos, Rot, extrude, make_hull

FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    outline = make_hull([*(Circle(d["eye"])).edges(), *(Pos(d["length"], 0) * Circle(d["eye"])).edges()]) + Circle(d["big"])
    outline -= Circle(d["big_bore"]) + Pos(d["length"], 0) * Circle(d["small_bore"])
    shape = Pos(0, 0, -d["thickness"] / 2) * extrude(outline, d["thickness"])
    return FRONT * shape, {
        "big": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "small": {"o": (d["length"], 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
