from build123d import Align, Circle, Cylinder, Pos, Rot, extrude, make_hull

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    spots = [(0, 0), (d["length"], 0)]
    outline = make_hull([edge for spot in spots for edge in (Pos(*spot) * Circle(d["eye"])).edges()])
    shape = Pos(0, 0, -d["thickness"] / 2) * extrude(outline, d["thickness"])
    shape -= Cylinder(d["bore"], 100)
    shape += Pos(d["hold"], 0, d["thickness"] / 2 - 1) * Cylinder(d["pin_r"], d["thickness"] + 1.3, align=LOW)
    return FRONT * shape, {
        "pivot": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "hold": {"o": (d["hold"], 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
