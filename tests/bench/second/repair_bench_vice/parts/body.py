from build123d import Align, Box, Cylinder, Pos, Rot

FRONT = (Align.CENTER, Align.MIN, Align.MIN)


def build(part):
    d = part.dimensions
    body = Box(d["width"], d["body_length"], 60, align=FRONT) + Box(d["jaw_width"], 25, d["jaw_top"], align=FRONT)
    body -= Pos(0, d["body_length"] / 2, d["beam_z"]) * Box(
        d["beam"] + 2 * d["clearance"], d["body_length"] + 2, d["beam"] + 2 * d["clearance"]
    )
    body -= Pos(0, d["body_length"] / 2, d["spindle_z"]) * Rot(X=90) * Cylinder(d["spindle_radius"] + d["clearance"], d["body_length"] + 2)

    return body, {
        "slide": {"o": (0, 0, d["beam_z"]), "z": (0, -1, 0), "x": (1, 0, 0)},
        "spindle": {"o": (0, 0, d["spindle_z"]), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
