from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Cylinder(d["foot_radius"], 34, align=LOW)
        + Cylinder(14, d["post_top"] - 30, align=LOW)
        + Cylinder(d["post"], d["post_top"], align=LOW)
    )
    for x in (-24, 0, 24):
        body -= Pos(x, -65, 22) * Cylinder(d["button"] + d["clearance"], 50, align=LOW)

    return body, {
        "swing": {"o": (0, 0, d["post_top"] - 30), "z": (0, 0, 1), "x": (1, 0, 0)},
        "button_0": {"o": (-24, -65, 34), "z": (0, 0, -1), "x": (1, 0, 0)},
        "button_1": {"o": (0, -65, 34), "z": (0, 0, -1), "x": (1, 0, 0)},
        "button_2": {"o": (24, -65, 34), "z": (0, 0, -1), "x": (1, 0, 0)},
    }
