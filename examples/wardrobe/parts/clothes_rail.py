from build123d import Align, Cylinder, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    tube = Cylinder(d["radius"], d["length"], align=LOW) - Cylinder(d["radius"] - d["wall"], d["length"], align=LOW)
    return Rot(Y=90) * tube, {"end": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 0, 1)}}
