from build123d import Box, Cylinder, Rot, chamfer


def build(part):
    d = part.dimensions
    bead = Cylinder(d["radius"], d["width"])
    bead = chamfer(bead.edges(), 2) - Box(d["hole_size"], d["hole_size"], 2 * d["width"])
    return Rot(X=90) * bead, {"hole": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (-1, 0, 0)}}
