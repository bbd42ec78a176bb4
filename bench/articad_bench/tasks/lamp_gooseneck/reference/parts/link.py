from math import radians, tan

from build123d import Align, Cone, Cylinder, Pos, Rot, Sphere

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    socket = Sphere(d["socket_radius"]) - Rot(X=180) * Cone(
        0, 2 * d["socket_radius"] * tan(radians(d["opening_deg"])), 2 * d["socket_radius"], align=LOW
    )
    body = socket + Cylinder(d["neck_radius"], d["pitch"], align=LOW) + Pos(0, 0, d["pitch"]) * Sphere(d["ball_radius"])
    body -= Sphere(d["ball_radius"] + d["clearance"])

    return body, {
        "ball_0": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "ball_1": {"o": (0, 0, d["pitch"]), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
