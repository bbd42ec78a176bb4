from build123d import Align, Box, Circle, Cylinder, Pos, Rot, extrude, make_hull

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    spots = [(0, 0), (d["length"], 0)]
    outline = make_hull([edge for spot in spots for edge in (Pos(*spot) * Circle(d["eye"])).edges()])
    shape = Pos(0, 0, d["low"]) * extrude(outline, d["thickness"])
    shape += Pos(d["slot_at"], 0, d["low"]) * Box(d["slot_len"] + 2 * d["wall"], d["slot"] + 2 * d["wall"], d["thickness"], align=LOW) - Pos(d["slot_at"], 0, d["low"] - 1) * Box(d["slot_len"], d["slot"], d["thickness"] + 2, align=LOW)
    shape -= Pos(d["slot_at"], 0, d["low"] - 1) * Box(d["slot_len"], d["slot"], d["thickness"] + 2, align=LOW)
    shape -= Pos(0, 0, 0) * Cylinder(d["bore_r"], 1000)
    shape += Pos(d["length"], 0, d["low"] + d["thickness"] / 2) * Cylinder(d["pin_r"], d["t_high"] - (d["low"] + d["thickness"] / 2), align=LOW)
    return FRONT * shape, {
        "slot": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, -1, 0)},
        "o": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "t": {"o": (d["length"], 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
