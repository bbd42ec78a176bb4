from build123d import Align, Cylinder, Pos

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    body = Cylinder(d["rod_radius"], d["rod_length"], align=HIGH) + Pos(0, 0, -d["rod_length"]) * Cylinder(
        d["tip_radius"], d["tip_length"], align=HIGH
    )

    return body, {"extend": {"o": (0, 0, -d["rod_length"] + 10), "z": (0, 0, -1), "x": (1, 0, 0)}}
