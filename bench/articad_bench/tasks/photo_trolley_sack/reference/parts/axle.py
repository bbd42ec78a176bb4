from build123d import Cylinder, Pos


def build(part):
    d = part.dimensions
    diameter, length, head_diameter, head = d["diameter"], d["length"], d["head_diameter"], d["head"]
    shape = Cylinder(diameter / 2, length)
    for side in (-1, 1):
        shape += Pos(0, 0, side * (length + head) / 2) * Cylinder(head_diameter / 2, head)
    return shape, {
        "middle": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "left": {"o": (0, 0, -251), "z": (0, 0, 1), "x": (1, 0, 0)},
        "right": {"o": (0, 0, 251), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
