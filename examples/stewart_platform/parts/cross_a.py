from build123d import Box, Cylinder, Rot, chamfer


def build(part):
    d = part.dimensions
    cube = Box(2 * d["core"], 2 * d["core"], 2 * d["core"])
    pin = Cylinder(d["pin_radius"], 2 * d["pin_end"])
    cross = chamfer(cube.edges(), 1) + Rot(Y=90) * pin + Rot(X=90) * pin
    return cross, {
        "base": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 0, 1)},
        "leg": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (0, 0, 1)},
    }
