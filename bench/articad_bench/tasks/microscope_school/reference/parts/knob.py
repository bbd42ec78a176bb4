from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(0.5, 0, 0) * Rot(Y=90) * (Cylinder(d["knob_radius"], 20, align=LOW) - Cylinder(d["knob_pin"] + d["play"], 100))
    return body, {"knob": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
