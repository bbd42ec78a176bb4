from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
LEFT = (Align.MIN, Align.CENTER, Align.CENTER)


def build(part):
    d = part.dimensions
    body = Pos(-43, 0, 0) * Rot(Y=90) * (Cylinder(d["cup_radius"], 26, align=LOW) - Cylinder(d["cup_radius"] - 12, 18, align=LOW))
    body += (
        Rot(X=90) * Cylinder(6, d["lug"])
        + Pos(-18, 0, 0) * Box(18, d["lug"], 8, align=LEFT)
        - Rot(X=90) * Cylinder(d["pin"] + d["play"], 60)
        - Box(20, 60, d["mouth"], align=LEFT)
    )

    return body, {"tilt": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)}}
