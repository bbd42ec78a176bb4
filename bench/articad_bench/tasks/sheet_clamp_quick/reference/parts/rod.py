from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, pivot_height, barrel_diameter, barrel_length = d["diameter"], d["pivot_height"], d["barrel_diameter"], d["barrel_length"]
    shape = Cylinder(diameter / 2, pivot_height, align=LOW) + Pos(0, 0, pivot_height) * Rot(X=90) * Cylinder(barrel_diameter / 2, barrel_length)
    return shape, {
        "thread": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "pivot": {"o": (0, 0, pivot_height), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
