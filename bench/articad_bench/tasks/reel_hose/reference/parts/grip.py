from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(1, 0, 0) * Rot(Y=90) * Cylinder(d["grip_radius"], 74, align=LOW) - Rot(Y=90) * Cylinder(d["grip_pin"] + d["clearance"], 300)
    return body, {"grip": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
