from build123d import Box, Cylinder, Rot


def build(part):
    d = part.dimensions
    bar = Box(2 * d["half_length"], d["thickness"], 2 * d["half_height"])
    bore = Rot(X=90) * Cylinder(d["bore_radius"], d["thickness"] + 2)
    return bar - bore, {
        "bore": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "slide": {"o": (0, 0, 0), "z": (-1, 0, 0), "x": (0, 0, 1)},
    }
