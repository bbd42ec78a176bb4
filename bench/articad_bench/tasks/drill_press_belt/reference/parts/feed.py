from build123d import Align, Cylinder, Pos, Rot, Sphere

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    shape = Rot(X=90) * Cylinder(d["shaft_r"], d["length"], align=LOW) + Pos(0, -d["length"], 0) * Rot(X=90) * Cylinder(d["hub_r"], d["hub_h"], align=LOW) + Pos(0, -d["length"] - d["hub_h"] / 2, 0) * Cylinder(d["lever_r"], d["lever_l"], align=LOW) + Pos(0, -d["length"] - d["hub_h"] / 2, d["lever_l"]) * Sphere(2 * d["lever_r"])
    return shape, {
        "axis": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
