from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(6, 0, -4) * Cylinder(d["tube"], 48, align=LOW)
    for z in (0, 40):
        body += Pos(8, 0, z) * Rot(Y=-90) * Cylinder(d["bore"], d["leg"], align=LOW)

    return body, {"main_slide": {"o": (-0.5, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
