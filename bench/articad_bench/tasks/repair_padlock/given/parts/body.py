from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = (Align.CENTER, Align.MIN, Align.MIN)


def build(part):
    d = part.dimensions
    body = Box(d["width"], d["depth"], d["height"], align=LOW)
    body -= Pos(-d["leg_x"], 0, d["height"] - 62) * Cylinder(d["leg_radius"] + d["clearance"], 100, align=LOW) + Pos(
        d["leg_x"], 0, d["height"] - d["throw"] - 4
    ) * Cylinder(d["leg_radius"] + d["clearance"], 100, align=LOW)
    for i in range(3):
        window = Pos(0, -20, 0) * Box(2 * d["dial_radius"] + 1, 20, d["dial_height"] + 0.8, align=FRONT) + Cylinder(
            d["dial_radius"] + 0.5, d["dial_height"] + 0.8, align=LOW
        )
        body -= Pos(0, d["dial_y"], 9.6 + i * d["dial_pitch"]) * window
    body += Pos(0, d["dial_y"], 5) * Cylinder(d["pin_radius"], 2.5 * d["dial_pitch"] + 15, align=LOW)

    return body, {
        "shackle": {"o": (-d["leg_x"], 0, d["height"]), "z": (0, 0, 1), "x": (1, 0, 0)},
        "dial_0": {"o": (0, d["dial_y"], 10 + 0 * d["dial_pitch"]), "z": (0, 0, 1), "x": (1, 0, 0)},
        "dial_1": {"o": (0, d["dial_y"], 10 + 1 * d["dial_pitch"]), "z": (0, 0, 1), "x": (1, 0, 0)},
        "dial_2": {"o": (0, d["dial_y"], 10 + 2 * d["dial_pitch"]), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
