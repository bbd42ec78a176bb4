from build123d import Align, Cylinder, Pos, Rot

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    total = d["shank_length"] + d["head_thickness"]
    shank = Rot(X=-90) * Cylinder(d["shank_radius"], d["shank_length"] + d["head_thickness"] / 2, align=UP)
    head = Pos(0, d["shank_length"], 0) * Rot(X=-90) * Cylinder(d["head_radius"], total - d["shank_length"], align=UP)
    return shank + head, {
        "seat": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "journal": {"o": (0, d["journal_y"], 0), "z": (0, -1, 0), "x": part.connectors["journal"].x},
    }
