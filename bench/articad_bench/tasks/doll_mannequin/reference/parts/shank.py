from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Rot(Y=90) * Cylinder(7, 6)
        + Box(6, 12, 24, align=LOW)
        + Pos(0, 0, 21) * Cylinder(d["leg_radius"], d["leg_length"] - 21, align=LOW)
        + Pos(0, 10, d["leg_length"] - 10) * Box(16, 40, 10, align=LOW)
        - Rot(Y=90) * Cylinder(d["hinge_pin"] + d["clearance"], 40)
    )
    return body, {"knee": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
