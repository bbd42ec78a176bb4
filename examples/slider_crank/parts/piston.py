from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    radius, crown, skirt = d["radius"], d["crown"], d["skirt"]
    piston = Pos(0, 0, -skirt) * Cylinder(radius, crown + skirt, align=LOW)
    for i in range(d["ring_count"]):
        groove = Cylinder(2 * radius, 1.5) - Cylinder(radius - d["ring_depth"], 1.5)
        piston -= Pos(0, 0, crown - 3 - 3 * i) * groove
    piston -= Rot(X=90) * Cylinder(d["pin_bore"], 4 * radius)
    piston -= Pos(0, 0, -2 * skirt) * Box(d["slot_width"], d["slot_depth"], 2 * skirt + d["slot_top"], align=LOW)
    return piston, {
        "axis": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "gudgeon": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (0, 0, 1)},
    }
