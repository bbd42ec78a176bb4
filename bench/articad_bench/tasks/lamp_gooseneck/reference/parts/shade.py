from math import radians, tan

from build123d import Align, Cone, Pos, Rot, Sphere

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    socket = Sphere(d["socket_radius"]) - Rot(X=180) * Cone(
        0, 2 * d["socket_radius"] * tan(radians(d["opening_deg"])), 2 * d["socket_radius"], align=LOW
    )
    cone = Pos(0, 0, 10) * (
        Cone(20, d["mouth_radius"], d["depth"], align=LOW)
        - Pos(0, 0, d["wall"]) * Cone(20 - d["wall"], d["mouth_radius"] - d["wall"], d["depth"], align=LOW)
    )
    body = socket + cone - Sphere(d["ball_radius"] + d["clearance"])

    return body, {"ball_4": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
