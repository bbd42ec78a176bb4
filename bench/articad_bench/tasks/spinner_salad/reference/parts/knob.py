from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(0, 0, 0.4) * Cylinder(d["knob_radius"], 32, align=LOW) - Cylinder(d["knob_pin"] + d["clearance"], 100)
    return body, {"knob": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
