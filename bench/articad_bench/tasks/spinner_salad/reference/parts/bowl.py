from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Cylinder(d["bowl_radius"], d["bowl_height"], align=LOW)
        - Pos(0, 0, d["wall"]) * Cylinder(d["bowl_radius"] - d["wall"], d["bowl_height"], align=LOW)
        + Cylinder(d["peg"], d["wall"] + 12, align=LOW)
    )
    return body, {
        "spin": {"o": (0, 0, d["wall"] + 0.4), "z": (0, 0, 1), "x": (1, 0, 0)},
        "rim": {"o": (0, 0, d["bowl_height"]), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
