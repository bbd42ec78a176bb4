from build123d import Align, Box, Cylinder, Pos, Rot

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    inside, width, length, top = d["block_y"], d["block_width"], 2 * d["half"], d["block_top"]
    shoe = Pos(0, 0, top) * Box(length / 2, 2 * inside + width, d["bar_height"], align=HIGH)
    for side in (-1, 1):
        y = side * (inside + width / 2)
        shoe += Pos(0, y, top) * Box(length, width, top + d["block_bottom"], align=HIGH)
        shoe -= Pos(0, y, d["rail_z"]) * Box(2 * length, d["hole_size"], d["hole_size"])
        shoe -= Pos(0, y, 0) * Rot(X=90) * Cylinder(d["bore_radius"], 2 * width)
    return shoe, {
        "pivot": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "holes": {"o": (0, 0, d["rail_z"]), "z": (1, 0, 0), "x": (0, 0, 1)},
    }
