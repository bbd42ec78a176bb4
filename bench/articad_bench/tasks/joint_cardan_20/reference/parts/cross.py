from build123d import Box, Cylinder, Rot


def build(part):
    d = part.dimensions
    pin, reach, hub = d["pin"], d["reach"], d["hub"]
    shape = Box(hub, hub, hub) + Cylinder(pin / 2, 2 * reach) + Rot(X=90) * Cylinder(pin / 2, 2 * reach)
    return shape, {"input": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}, "output": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)}}
