from build123d import Align, Box, Cylinder, Pos


def build(part):
    d = part.dimensions
    corner = (Align.MIN, Align.MIN, Align.MIN)
    panel = Pos(-d["inset"], -d["inset"], 0) * Box(d["width"], d["thickness"], d["height"], align=corner)
    for z in (0, d["height"]):
        panel -= Pos(0, 0, z) * Cylinder(d["bore_radius"], 2 * d["bore_depth"])
    return panel, {
        "hinge": {"o": (0, 0, -d["hinge_play"] / 2), "z": (0, 0, 1), "x": (1, 0, 0)},
        "handle": {"o": (d["handle_x"], -d["inset"], d["handle_z"]), "z": (0, -1, 0), "x": (0, 0, 1)},
    }
