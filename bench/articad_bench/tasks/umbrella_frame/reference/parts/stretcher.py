from build123d import Align, Box, Circle, Cylinder, Pos, Rot, extrude, make_hull

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    near = make_hull([edge for x in (0, d["elbow"]) for edge in (Pos(x, 0) * Circle(d["eye"])).edges()])
    far = make_hull([edge for x in (d["elbow"], d["length"]) for edge in (Pos(x, 0) * Circle(d["eye"])).edges()])
    shape = Pos(0, 0, -d["thickness"] / 2) * extrude(near, d["thickness"]) + Pos(0, 0, d["shift"] - d["thickness"] / 2) * extrude(far, d["thickness"]) + Pos(d["elbow"], 0, -d["thickness"] / 2 + 0.5) * Box(d["eye"], 2 * d["eye"] - 2, d["thickness"] + d["shift"] - 1, align=LOW)
    shape -= Cylinder(d["bore"], 100) + Pos(d["length"], 0, 0) * Cylinder(d["bore"], 100)
    return FRONT * shape, {
        "runner": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "rib": {"o": (d["length"], 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
