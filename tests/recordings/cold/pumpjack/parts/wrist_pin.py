from build123d import Cylinder, Rot


def build(part):
    d = part.dimensions
    shape = Rot(X=90) * Cylinder(d["radius"], d["length"])
    return shape, {
        "seat": {"o": (0, -d["length"] / 2, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "journal": {"o": (0, 0, 0), "z": (0, -1, 0), "x": part.connectors["journal"].x},
    }
