from build123d import Align, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Cylinder(d["knob_radius"], 30, align=LOW) - Cylinder(d["pin_radius"] + d["clearance"], 100)
    return body, {"knob": {"o": (0, 0, -0.5), "z": (0, 0, 1), "x": (1, 0, 0)}}
