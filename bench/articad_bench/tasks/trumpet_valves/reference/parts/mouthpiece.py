from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Pos(-4, 0, 0) * Rot(Y=90) * Cylinder(d["bore"], d["shank_length"] + 4, align=LOW)
        + Rot(Y=-90) * Cylinder(13, 20, align=LOW)
        - Pos(-20, 0, 0) * Rot(Y=90) * Cylinder(9, 8, align=LOW)
    )
    return body, {"mouthpiece": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
