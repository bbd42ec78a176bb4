from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)
LEFT_LOW = (Align.MIN, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Cylinder(d["shaft_radius"], d["shaft_length"], align=HIGH)
        + Cylinder(9, 5, align=LOW)
        + Box(d["crank_length"], 12, 5, align=LEFT_LOW)
    )
    body += Pos(d["crank_length"], 0, 0) * (Cylinder(6, 5, align=LOW) + Cylinder(d["pin_radius"], 39, align=LOW))

    return body, {
        "crank": {"o": (0, 0, -10), "z": (0, 0, 1), "x": (1, 0, 0)},
        "knob": {"o": (d["crank_length"], 0, 5), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
