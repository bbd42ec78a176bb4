from build123d import Cylinder, Rot


def build(part):
    d = part.dimensions
    body = Rot(Y=90) * (Cylinder(d["wheel"], 30) - Cylinder(d["wheel_axle"] + d["clearance"], 100))
    return body, {"wheel": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
