from build123d import Align, Circle, Cylinder, Pos, Rot, extrude, make_hull

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    spots = [(0, 0), (d["length"], 0)]
    outline = make_hull([edge for spot in spots for edge in (Pos(*spot) * Circle(d["eye"])).edges()])
    shape = Pos(0, 0, 0) * extrude(outline, d["thickness"])
    shape -= Pos(0, 0, 0) * Cylinder(d["bore_r"], 1000)
    shape += Pos(d["length"], 0, d["thickness"] / 2) * Cylinder(d["pin_r"], d["b_high"] - (d["thickness"] / 2), align=LOW)
    return FRONT * shape, {
        "a": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "b": {"o": (d["length"], 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
