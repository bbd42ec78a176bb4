from build123d import Align, Box, Cylinder, Pos


def build(part):
    d = part.dimensions
    body = Pos(-130, 0, 0) * Box(1200, d["depth"], 120, align=(Align.MIN, Align.CENTER, Align.MAX))
    body -= Pos(d["bolt_x"], d["bolt_y"], 0) * Cylinder(11, 210)

    return body, {
        "left_foot": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "right_foot": {"o": (975, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
