from build123d import Circle, Cylinder, Pos, Rot, extrude, make_hull


def build(part):
    d = part.dimensions
    spots = [(0, 0), (d["length"], 0)]
    outline = make_hull([edge for spot in spots for edge in (Pos(*spot) * Circle(d["eye"])).edges()])
    shape = Pos(0, 0, d["low"]) * extrude(outline, d["thickness"])
    shape += Rot(Z=-d["turn_deg"]) * Pos(1 * d["axle"] / 2, 0, d["low"] + d["thickness"] / 2) * Rot(Y=90) * Cylinder(3.5, d["axle"])
    shape += Rot(Z=-d["turn_deg"]) * Pos(1 * (d["axle"] + d["wheel_w"] / 2 - 1), 0, d["low"] + d["thickness"] / 2) * Rot(Y=90) * Cylinder(d["wheel_r"], d["wheel_w"])
    shape -= Pos(0, 0, 0) * Cylinder(d["bore_r"], 1000)
    shape -= Pos(d["length"], 0, 0) * Cylinder(d["bore_r"], 1000)
    return shape, {
        "k": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "d": {"o": (d["length"], 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
