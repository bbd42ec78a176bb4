from build123d import Cylinder, Rot


def build(part):
    d = part.dimensions
    body = Rot(X=90) * (Cylinder(d["wheel_radius"], d["wheel_width"]) - Cylinder(d["axle_radius"] + d["clearance"], 2 * d["wheel_width"]))
    return body, {"roll_0": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)}}
