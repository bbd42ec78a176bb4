from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Rot(X=90) * Cylinder(d["head_radius"], d["head_length"], align=LOW) + Rot(X=-90) * Cylinder(
        d["spindle_radius"], d["thread_end"], align=LOW
    )
    body -= Pos(0, -d["head_length"] / 2, 0) * Rot(Y=90) * Cylinder(d["bar_radius"] + d["clearance"], 4 * d["head_radius"])

    return body, {
        "spindle": {"o": (0, 21.3, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "bar": {"o": (0, -d["head_length"] / 2, 0), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
