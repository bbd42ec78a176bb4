from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    r = d["bowl_radius"] - d["wall"] - 0.5
    body = (
        Cylinder(d["bowl_radius"], 4, align=LOW)
        + Pos(0, 0, 1) * (Cylinder(r, 9, align=HIGH) - Cylinder(r - 3, 20, align=HIGH))
        + Cylinder(16, 16, align=LOW)
    )
    body -= Cylinder(d["shaft"] + d["clearance"], 100)

    return body, {"rim": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}, "crank": {"o": (0, 0, 16.4), "z": (0, 0, 1), "x": (1, 0, 0)}}
