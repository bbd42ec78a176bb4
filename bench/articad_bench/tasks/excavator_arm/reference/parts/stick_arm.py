from build123d import Align, Circle, Cylinder, Pos, Rot, extrude, make_hull

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    spots = [(0, 0), (d["length"], 0), (d["v_a"], d["v_b"]), (d["w_a"], d["w_b"]), (d["x_a"], d["x_b"])]
    outline = make_hull([edge for spot in spots for edge in (Pos(*spot) * Circle(d["eye"])).edges()])
    shape = Pos(0, 0, d["low"]) * extrude(outline, d["thickness"])
    shape -= Pos(0, 0, 0) * Cylinder(d["bore_r"], 1000)
    shape += Pos(d["length"], 0, d["low"] + d["thickness"] / 2) * Cylinder(d["pin_r"], d["k_high"] - (d["low"] + d["thickness"] / 2), align=LOW)
    shape += Pos(d["x_a"], d["x_b"], d["low"] + d["thickness"] / 2) * Cylinder(d["pin_r"], d["x_high"] - (d["low"] + d["thickness"] / 2), align=LOW)
    shape += Pos(d["v_a"], d["v_b"], d["low"] + d["thickness"] / 2) * Cylinder(d["pin_r"], d["v_high"] - (d["low"] + d["thickness"] / 2), align=LOW)
    shape += Pos(d["w_a"], d["w_b"], d["low"] + d["thickness"] / 2) * Cylinder(d["pin_r"], d["w_high"] - (d["low"] + d["thickness"] / 2), align=LOW)
    return FRONT * shape, {
        "s": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "k": {"o": (d["length"], 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "x": {"o": (d["x_a"], 0, d["x_b"]), "z": (0, -1, 0), "x": (1, 0, 0)},
        "v": {"o": (d["v_a"], 0, d["v_b"]), "z": (0, -1, 0), "x": (1, 0, 0)},
        "w": {"o": (d["w_a"], 0, d["w_b"]), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
