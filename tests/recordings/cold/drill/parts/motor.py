from build123d import Align, Box, Cylinder, Pos

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    r, length = d["radius"], d["length"]
    shape = Cylinder(r, length, align=(Align.CENTER, Align.CENTER, Align.MAX))
    width = d["groove_width"]
    ring = Cylinder(r + 5, width) - Cylinder(r - d["groove_depth"], width + 2)
    for k in range(3):
        shape -= Pos(0, 0, -length + d["groove_start"] + k * d["groove_pitch"]) * ring
    inner = 0.8 * r
    shape += Pos(-d["box_out"], 0, d["box_low"]) * Box(
        d["box_out"] - inner, 2 * d["box_half"], d["box_high"] - d["box_low"], align=(Align.MIN, Align.CENTER, Align.MIN)
    )
    depth = d["bore_depth"]
    shape -= Pos(0, 0, -depth) * Cylinder(d["bore_radius"], depth + 1, align=UP)
    return shape, {
        "flange": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "shaft": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
