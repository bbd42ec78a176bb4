from build123d import Align, Box, Cylinder, Pos, Rot, Sphere

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Sphere(d["ball"])
        + Cylinder(d["neck"], 26, align=LOW)
        + Pos(0, 0, 24) * Cylinder(d["leg_radius"], d["upper"] - 34, align=LOW)
        + Pos(0, 0, d["upper"] - 2) * Box(2 * d["leg_radius"], 2 * d["leg_radius"], 24)
    )
    body -= Pos(0, 0, d["upper"] + 1) * Box(6.8, 40, 24)
    body += Pos(0, 0, d["upper"]) * Rot(Y=90) * Cylinder(d["hinge_pin"], 2 * d["leg_radius"])

    return body, {
        "hip": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "knee": {"o": (0, 0, d["upper"]), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
