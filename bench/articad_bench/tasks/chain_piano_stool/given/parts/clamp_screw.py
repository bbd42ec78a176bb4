from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Rot(Y=90) * Cylinder(d["head_radius"], 14, align=LOW) + Pos(1, 0, 0) * Rot(Y=-90) * Cylinder(d["clamp"], 12, align=LOW)
    return body, {"clamp": {"o": (-2, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
