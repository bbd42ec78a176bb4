from math import radians, tan

from build123d import Align, Cone, Pos, Rot, Sphere

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    cap, mouth, wall, top = d["cap_radius"], d["mouth_radius"], d["wall"], d["cap_z"] - d["wall"]
    slope = (mouth - cap) / (d["depth"] + wall)
    shade = Pos(0, 0, top) * Cone(cap, mouth, d["depth"] + wall, align=LOW)
    shade -= Pos(0, 0, d["cap_z"]) * Cone(cap + slope * wall - wall, mouth - wall, d["depth"], align=LOW)

    inside, socket = d["ball_radius"] + d["clearance"], Sphere(d["socket_radius"])
    socket += Cone(d["socket_radius"], 0.8 * cap, top + wall / 2, align=LOW)
    mouth_cone = Cone(0, 2 * inside * tan(radians(d["opening_deg"])), 2 * inside, align=LOW)
    socket -= Rot(X=180) * mouth_cone
    return shade + socket - Sphere(inside), {
        "ball": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (0, 1, 0)},
        "lamp": {"o": (0, 0, d["cap_z"]), "z": (0, 0, 1), "x": (0, 1, 0)},
    }
