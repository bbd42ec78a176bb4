from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Pos(0, -0.4, 0) * Rot(X=90) * (Cylinder(d["dial_radius"], 10, align=LOW) + Cylinder(12, 24, align=LOW))
        + Rot(X=-90) * Cylinder(d["shaft"], d["door"] - 2, align=LOW)
        + Pos(0, 1, 0) * Rot(X=90) * Cylinder(d["shaft"], 4, align=LOW)
    )
    return body, {"dial": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)}}
