from build123d import Align, Circle, Cylinder, Pos, Rot, extrude, make_hull

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    spots = [(0, 0), (d["length"], 0)]
    outline = make_hull([edge for spot in spots for edge in (Pos(*spot) * Circle(d["eye"])).edges()])
    shape = Pos(0, 0, d["low"]) * extrude(outline, d["thickness"])
    shape += Pos(0, 0, d["low"]) * Cylinder(d["big_r"], d["thickness"], align=LOW)
    shape -= Pos(0, 0, 0) * Cylinder(d["bore_r"], 1000)
    shape -= Pos(d["length"], 0, 0) * Cylinder(d["bore_r"], 1000)
    shape += Pos(d["k2_a"], d["k2_b"], d["low"] + d["thickness"] / 2) * Cylinder(d["pin_r"], d["k2_high"] - (d["low"] + d["thickness"] / 2), align=LOW)
    shape += Pos(d["k3_a"], d["k3_b"], d["low"] + d["thickness"] / 2) * Cylinder(d["pin_r"], d["k3_high"] - (d["low"] + d["thickness"] / 2), align=LOW)
    shape += Pos(d["k4_a"], d["k4_b"], d["low"] + d["thickness"] / 2) * Cylinder(d["pin_r"], d["k4_high"] - (d["low"] + d["thickness"] / 2), align=LOW)
    shape += Pos(d["k5_a"], d["k5_b"], d["low"] + d["thickness"] / 2) * Cylinder(d["pin_r"], d["k5_high"] - (d["low"] + d["thickness"] / 2), align=LOW)
    return FRONT * shape, {
        "b": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "n1": {"o": (d["length"], 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "k2": {"o": (d["k2_a"], 0, d["k2_b"]), "z": (0, -1, 0), "x": (1, 0, 0)},
        "k3": {"o": (d["k3_a"], 0, d["k3_b"]), "z": (0, -1, 0), "x": (1, 0, 0)},
        "k4": {"o": (d["k4_a"], 0, d["k4_b"]), "z": (0, -1, 0), "x": (1, 0, 0)},
        "k5": {"o": (d["k5_a"], 0, d["k5_b"]), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
