from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, width, thickness, floor, block = d["length"], d["width"], d["thickness"], d["floor"], d["block"]
    block_x, block_top, bore, offset = d["block_x"], d["block_top"], d["bore"], d["offset"]
    shape = Pos(0, 0, floor) * Box(length, width, thickness, align=LOW)
    for x, y in ((-block_x, 0), (block_x, offset)):
        shape += Pos(x, 0, floor) * Box(block, width, block_top - floor, align=LOW)
        shape -= Pos(x, y, 0) * Rot(Y=90) * Cylinder(bore / 2, 2 * block)
    return shape, {
        "first": {"o": (-block_x, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)},
        "second": {"o": (block_x, offset, 0), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
