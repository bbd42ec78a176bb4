from build123d import Cylinder, Rot


def build(part):
    d = part.dimensions
    body = Rot(X=90) * Cylinder(d["disc_radius"], 4) + Rot(Y=90) * Cylinder(7, 40) - Rot(Y=90) * Cylinder(d["mirror_pin"] + d["play"], 100)
    return body, {"mirror": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
