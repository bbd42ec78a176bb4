from build123d import Align, Cylinder, Pos, Sphere

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Cylinder(d["radius"], d["height"], align=LOW)
        + Pos(0, 0, d["height"]) * Cylinder(d["neck_radius"], d["stem"], align=LOW)
        + Pos(0, 0, d["height"] + d["stem"]) * Sphere(d["ball_radius"])
    )

    return body, {"ball_0": {"o": (0, 0, d["height"] + d["stem"]), "z": (0, 0, 1), "x": (1, 0, 0)}}
