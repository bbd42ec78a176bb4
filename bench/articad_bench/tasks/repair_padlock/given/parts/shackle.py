from build123d import Align, Cylinder, Pos, Rot, Sphere

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(0, 0, -45) * Cylinder(d["leg_radius"], d["rise"] + 45, align=LOW) + Pos(2 * d["leg_x"], 0, 1) * Cylinder(
        d["leg_radius"], d["rise"] - 1, align=LOW
    )
    body += Pos(0, 0, d["rise"]) * (
        Sphere(d["leg_radius"])
        + Rot(Y=90) * Cylinder(d["leg_radius"], 2 * d["leg_x"], align=LOW)
        + Pos(2 * d["leg_x"], 0, 0) * Sphere(d["leg_radius"])
    )

    return body, {"shackle": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
