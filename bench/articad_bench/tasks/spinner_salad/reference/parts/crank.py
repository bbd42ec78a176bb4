from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)
LEFT_LOW = (Align.MIN, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Cylinder(d["shaft"], 14, align=HIGH)
        + Cylinder(12, 8, align=LOW)
        + Box(d["crank"], 16, 8, align=LEFT_LOW)
        + Pos(d["crank"], 0, 0) * (Cylinder(8, 8, align=LOW) + Cylinder(d["knob_pin"], 42, align=LOW))
    )
    return body, {
        "crank": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "knob": {"o": (d["crank"], 0, 8), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
