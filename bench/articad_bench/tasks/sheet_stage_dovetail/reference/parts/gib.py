from build123d import Plane, Polygon, Pos, extrude


def build(part):
    d = part.dimensions
    length, thickness, height, lean = d["length"], d["thickness"], d["height"], d["lean"]
    profile = Polygon((0, 0), (thickness, 0), (thickness + lean * height, height), (lean * height, height), align=None)
    shape = Pos(-length / 2, 0, 0) * extrude(Plane.YZ * profile, length)
    return shape, {
        "side": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
