from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Cylinder(d["bolt_radius"], d["rod_length"], align=LOW) + Pos(0, 0, 220) * Rot(X=90) * Cylinder(5, 60, align=LOW)

    return body, {"bolt": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
