from build123d import Align, Cone, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    diameter, length, taper, foot_diameter = d["diameter"], d["length"], d["taper"], d["foot_diameter"]
    shape = Cylinder(diameter / 2, length - taper, align=HIGH) + Pos(0, 0, taper - length) * Rot(X=180) * Cone(diameter / 2, foot_diameter / 2, taper, align=LOW)

    return shape, {"top": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
