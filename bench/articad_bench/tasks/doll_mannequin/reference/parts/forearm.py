from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Rot(Y=90) * Cylinder(7, 6)
        + Box(6, 12, 22, align=LOW)
        + Pos(0, 0, 17) * Cylinder(d["arm_radius"], d["arm_length"] - 17, align=LOW)
        - Rot(Y=90) * Cylinder(d["hinge_pin"] + d["clearance"], 40)
    )
    return body, {"elbow": {"o": (0, 0, 0), "z": (-1, 0, 0), "x": (0, 1, 0)}}
