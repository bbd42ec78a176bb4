from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    diameter, inside, nose, screw_bore, screw_depth = d["diameter"], d["inside"], d["nose"], d["screw_bore"], d["screw_depth"]
    centre, centre_depth = d["centre"], d["centre_depth"]
    shape = Pos(0, 0, -inside) * (Cylinder(diameter / 2, inside + nose, align=LOW) - Cylinder(screw_bore / 2, screw_depth, align=LOW))
    shape -= Pos(0, 0, nose) * Cylinder(centre / 2, centre_depth, align=HIGH)
    return shape, {"body": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (0, 1, 0)}, "centre": {"o": (0, 0, nose), "z": (0, 0, 1), "x": (0, 1, 0)}}
