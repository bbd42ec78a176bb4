from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Cylinder(d["dial_radius"], d["dial_height"], align=LOW) - Cylinder(d["pin_radius"] + 0.2, 50)
    for i in range(10):
        body -= Rot(Z=36 * i) * Pos(d["dial_radius"], 0, 0) * Cylinder(d["notch_radius"], 50)

    return body, {"dial_0": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
