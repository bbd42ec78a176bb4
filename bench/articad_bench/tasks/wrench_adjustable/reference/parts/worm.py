from build123d import Cylinder, Pos


def build(part):
    d = part.dimensions
    body = Cylinder(d["worm"], 15) - Cylinder(d["worm_pin"] + d["clearance"], 50)
    for i in range(-2, 3):
        body -= Pos(0, 0, 3 * i) * (Cylinder(d["worm"] + 1, 1.2) - Cylinder(d["worm"] - 0.8, 1.2))

    return body, {"worm": {"o": (0, 0, 0), "z": (0, 0, -1), "x": (1, 0, 0)}}
