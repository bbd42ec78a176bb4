from build123d import Align, Cylinder, Pos, Rot

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    body = Pos(0, 0, 30) * Cylinder(d["bar"], 265, align=HIGH) + Pos(0, 0, 40) * Rot(X=90) * Cylinder(11, d["grip"])
    return body, {"height": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
