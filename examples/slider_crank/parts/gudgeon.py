from build123d import Cylinder, Rot


def build(part):
    d = part.dimensions
    pin = Rot(X=90) * (Cylinder(d["radius"], d["length"]) - Cylinder(d["hole_radius"], d["length"]))
    middle = {"o": (0, 0, 0), "z": (0, -1, 0), "x": (0, 0, 1)}
    return pin, {"seat": middle, "journal": middle}
