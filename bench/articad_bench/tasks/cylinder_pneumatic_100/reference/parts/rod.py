from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, inside, out, piston, piston_width = d["diameter"], d["inside"], d["out"], d["piston"], d["piston_width"]
    shape = Pos(0, 0, -inside) * Cylinder(diameter / 2, inside + out, align=LOW) + Pos(0, 0, -inside) * Cylinder(piston / 2, piston_width, align=LOW)
    return shape, {"barrel": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (0, 1, 0)}, "clevis": {"o": (0, 0, out), "z": (0, 0, 1), "x": (0, 1, 0)}}
