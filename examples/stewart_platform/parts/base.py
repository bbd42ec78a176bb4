from math import cos, radians, sin

from build123d import Align, Axis, Box, Cylinder, Pos, Rot, chamfer

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    floor, prong, thick = -d["pivot_height"], d["prong"], d["prong_thickness"]
    plate = Cylinder(d["radius"], d["thickness"], align=HIGH)
    base = Pos(0, 0, floor) * chamfer(plate.edges().sort_by(Axis.Z)[-1], 2)

    fork = None
    for side in (-1, 1):
        lug = Rot(Y=90) * Cylinder(prong, thick) + Box(thick, 2 * prong, -floor, align=HIGH)
        lug = Pos(side * (d["prong_gap"] + thick / 2), 0, 0) * lug
        fork = lug if fork is None else fork + lug
    fork -= Rot(Y=90) * Cylinder(d["bore_radius"], 4 * (d["prong_gap"] + thick))

    forks, connectors = [], {}
    for i, name in enumerate("abcdef"):
        place, lean = (d["spread_deg"], d["turn_deg"]) if i % 2 == 0 else (120 - d["spread_deg"], 120 - d["turn_deg"])
        place, lean = radians(place + 120 * (i // 2)), lean + 120 * (i // 2)
        x, y = d["base_radius"] * cos(place), d["base_radius"] * sin(place)
        forks.append(Pos(x, y, 0) * Rot(Z=lean) * fork)
        connectors[f"leg_{name}"] = {"o": (x, y, 0), "z": (cos(radians(lean)), sin(radians(lean)), 0), "x": (0, 0, 1)}
    return base + forks, connectors
