from build123d import Align, Box, Cylinder, Pos, Rot

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    body = (
        Rot(X=90) * Cylinder(5, 10)
        + Pos(2, 0, 0) * Box(6, 10, d["finger"], align=HIGH)
        - Rot(X=90) * Cylinder(d["trigger_pin"] + d["clearance"], 30)
    )
    return body, {"trigger": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)}}
