from build123d import Cylinder, Rot


def build(part):
    d = part.dimensions
    body = Rot(X=90) * (Cylinder(d["wheel"], d["wheel_width"]) - Cylinder(d["axle"] + d["clearance"], 100))
    return body, {"rear_wheel": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)}}
