from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    prong, thick, top, floor = d["prong"], d["prong_thickness"], d["top"], d["floor"]
    outside = d["prong_gap"] + thick
    leg = Pos(0, 0, d["bridge"]) * Box(2 * prong, 2 * outside, floor - d["bridge"], align=LOW)
    for side in (-1, 1):
        lug = Rot(X=90) * Cylinder(prong, thick) + Box(2 * prong, thick, floor, align=LOW)
        leg += Pos(0, side * (outside - thick / 2), 0) * lug
    leg -= Rot(X=90) * Cylinder(d["bore_radius"], 4 * outside)

    tube = Cylinder(d["tube_radius"], top - d["bridge"], align=LOW)
    bore = Cylinder(d["rod_bore"], top, align=LOW) & Box(2 * d["flat_bore"], 4 * d["rod_bore"], top, align=LOW)
    leg = leg + Pos(0, 0, d["bridge"]) * tube - Pos(0, 0, floor) * bore
    return leg, {
        "cross": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (0, 0, 1)},
        "tube": {"o": (0, 0, top), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
