from build123d import Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    body = Cylinder(d["bar_radius"], d["bar_length"])
    for side in (-1, 1):
        body += Pos(0, 0, side * (d["bar_length"] - d["knob_length"]) / 2) * Cylinder(d["knob_radius"], d["knob_length"])
    body = Rot(Y=90) * body

    return body, {"bar": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
