from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FROM_INSIDE = (Align.CENTER, Align.MIN, Align.MIN)


def build(part):
    d = part.dimensions
    inside, width, length, low = d["block_y"], d["block_width"], 2 * d["half"], -d["block_bottom"]
    shoe = Pos(0, 0, low) * Box(length / 2, 2 * inside + width, d["bar_height"], align=LOW)
    for turn in (0, 180):  # the two sides are the same, turned about z
        block = Pos(0, inside, low) * Box(length, width, d["block_top"] - low, align=FROM_INSIDE)
        block += Pos(0, inside - d["pin_length"], 0) * Rot(X=-90) * Cylinder(d["pin_radius"], d["pin_length"], align=LOW)
        shoe += Rot(Z=turn) * block
    for side in (-1, 1):
        shoe -= Pos(0, side * (inside + width / 2), -d["rail_z"]) * Box(2 * length, d["hole_size"], d["hole_size"])
    return shoe, {
        "pivot": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "holes": {"o": (0, 0, -d["rail_z"]), "z": (1, 0, 0), "x": (0, 0, 1)},
    }
