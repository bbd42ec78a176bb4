from build123d import Align, Cylinder, Pos, Sphere

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Cylinder(d["column_radius"], d["length"], align=LOW)
        + Pos(0, 0, d["length"]) * Cylinder(d["neck_radius"], d["ball_z"], align=LOW)
        + Pos(0, 0, d["length"] + d["ball_z"]) * Sphere(d["ball_radius"])
    )

    return body, {
        "column": {"o": (0, 0, 220), "z": (0, 0, 1), "x": (1, 0, 0)},
        "head": {"o": (0, 0, d["length"] + d["ball_z"]), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
