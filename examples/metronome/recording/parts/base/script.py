from build123d import Align, Axis, Box, fillet


def build(part):
    d = part.dimensions
    height = d["height"]
    block = Box(d["size"], d["size"], height, align=(Align.CENTER, Align.CENTER, Align.MIN))
    shape = fillet(block.edges().group_by(Axis.Z)[-1], radius=d["edge_radius"])
    connectors = {}
    for name in ("foot_1", "foot_2", "foot_3", "foot_4"):
        c = part.connectors[name]
        connectors[name] = {"o": (c.o[0], c.o[1], 0), "z": (0, 0, 1), "x": (1, 0, 0)}
    for name in ("housing", "movement"):
        connectors[name] = {"o": (0, 0, height), "z": (0, 0, 1), "x": (1, 0, 0)}
    return shape, connectors
