from build123d import Circle, Cylinder, Pos, Rectangle, Rot, extrude, make_hull

FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    outline = make_hull([*Circle(d["hub_r"] - 2).edges(), *(Pos(d["length"] - d["tip"], 0) * Circle(d["tip"])).edges()]) + Circle(d["hub_r"]) + Pos(-d["tail"] / 2, 0) * Rectangle(d["tail"], 5)
    shape = Pos(0, 0, d["low"]) * extrude(outline, d["thickness"]) - Cylinder(d["bore"], 1000)
    return FRONT * shape, {
        "hub": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
