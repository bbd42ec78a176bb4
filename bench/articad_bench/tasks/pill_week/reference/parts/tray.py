from build123d import Align, Box, Cylinder, Pos, Rot

CORNER = (Align.MIN, Align.MIN, Align.MIN)
FRONT = (Align.CENTER, Align.MIN, Align.MIN)


def build(part):
    d = part.dimensions
    body = Box(7 * d["cell"], d["depth"], d["height"], align=CORNER)
    for i in range(7):
        body -= Pos(i * d["cell"] + d["wall"] / 2, d["wall"], d["wall"]) * Box(
            d["cell"] - d["wall"], d["depth"] - 2 * d["wall"], d["height"], align=CORNER
        )
    for i in range(8):
        body += Pos(i * d["cell"], d["depth"] - d["wall"] / 2, d["height"] - 6) * Box(d["ear"], d["wall"] / 2 + 8, 11.5, align=FRONT)
    body -= Pos(0, d["depth"] + 4, d["height"] + 2) * Rot(Y=90) * Cylinder(d["pin_radius"] + d["clearance"], 20 * d["cell"])

    return body, {
        "hinge": {"o": (d["cell"] / 2, d["depth"] + 4, d["height"] + 2), "z": (-1, 0, 0), "x": (0, 1, 0)},
        "hinge_2": {"o": ((0.5 + 1) * d["cell"], d["depth"] + 4, d["height"] + 2), "z": (-1, 0, 0), "x": (0, 1, 0)},
        "hinge_3": {"o": ((0.5 + 2) * d["cell"], d["depth"] + 4, d["height"] + 2), "z": (-1, 0, 0), "x": (0, 1, 0)},
        "hinge_4": {"o": ((0.5 + 3) * d["cell"], d["depth"] + 4, d["height"] + 2), "z": (-1, 0, 0), "x": (0, 1, 0)},
        "hinge_5": {"o": ((0.5 + 4) * d["cell"], d["depth"] + 4, d["height"] + 2), "z": (-1, 0, 0), "x": (0, 1, 0)},
        "hinge_6": {"o": ((0.5 + 5) * d["cell"], d["depth"] + 4, d["height"] + 2), "z": (-1, 0, 0), "x": (0, 1, 0)},
        "hinge_7": {"o": ((0.5 + 6) * d["cell"], d["depth"] + 4, d["height"] + 2), "z": (-1, 0, 0), "x": (0, 1, 0)},
    }
