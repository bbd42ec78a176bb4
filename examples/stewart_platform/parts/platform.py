from math import cos, radians, sin, tan

from build123d import Align, Cone, Cylinder, Plane, Pos, Sphere

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    gap, hollow, lean = d["plate_gap"], d["hollow_radius"], radians(d["lean_deg"])
    plate = Pos(0, 0, gap) * (Cylinder(d["radius"], d["thickness"], align=LOW) - Cylinder(d["hole_radius"], d["thickness"], align=LOW))
    reach = 2 * d["socket_radius"]
    opening = Cone(0, reach * tan(radians(d["opening_deg"])), reach, align=LOW)

    sockets, connectors = [], {}
    for i, name in enumerate("abcdef"):
        side = -1 if i % 2 == 0 else 1
        place = radians(60 + side * d["spread_deg"] + 120 * (i // 2))
        turn = radians((d["turn_deg"] if i % 2 == 0 else 120 - d["turn_deg"]) + 120 * (i // 2))
        ball = (d["platform_radius"] * cos(place), d["platform_radius"] * sin(place), 0)
        leg = (sin(lean) * cos(turn), sin(lean) * sin(turn), cos(lean))

        socket = Pos(0, 0, -d["socket_low"]) * Cylinder(d["socket_radius"], d["socket_low"] + gap + d["thickness"] / 2, align=LOW)
        socket -= [Sphere(hollow), Plane((0, 0, 0), z_dir=tuple(-c for c in leg)) * opening]
        sockets.append(Pos(*ball) * socket)
        connectors[f"leg_{name}"] = {"o": ball, "z": leg}
    return plate + sockets, connectors
