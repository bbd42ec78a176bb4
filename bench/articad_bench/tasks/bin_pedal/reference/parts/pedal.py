from build123d import Align, Box, Circle, Cylinder, Pos, Rot, extrude, make_hull

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
CORNER = (Align.MIN, Align.MIN, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    spots = [(0, 0), (d["length"], 0)]
    outline = make_hull([edge for spot in spots for edge in (Pos(*spot) * Circle(d["eye"])).edges()])
    shape = Pos(0, 0, 0) * extrude(outline, d["thickness"])
    shape += Pos(d["length"], -2, 0) * Box(130, 8, d["thickness"], align=CORNER)
    shape += Pos(d["length"] + 108, -2, -30) * Box(30, 8, 60, align=CORNER)
    shape -= Pos(d["length"], 0, 0) * Cylinder(d["bore_r"], 1000)
    shape += Pos(0, 0, d["thickness"] / 2) * Cylinder(d["pin_r"], d["t_high"] - (d["thickness"] / 2), align=LOW)
    return FRONT * shape, {
        "o": {"o": (d["length"], 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "t": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
