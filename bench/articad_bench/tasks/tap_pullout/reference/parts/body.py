from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Cylinder(d["body_radius"], d["body_height"], align=LOW) + Cylinder(d["foot_radius"], 6, align=LOW)
    body += Pos(0, 0, d["body_height"]) * (
        Cylinder(d["post_radius"], d["post_height"], align=LOW) + Cylinder(8, d["post_height"] + 14, align=LOW)
    )

    return body, {
        "swivel": {"o": (0, 0, d["body_height"]), "z": (0, 0, 1), "x": (1, 0, 0)},
        "mix": {"o": (0, 0, d["body_height"] + d["post_height"]), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
