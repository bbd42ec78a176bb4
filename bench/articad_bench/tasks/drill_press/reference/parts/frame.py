from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = (Align.CENTER, Align.MIN, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Pos(0, 20, 0) * Box(200, 300, 20, align=LOW)
        + Pos(0, d["column_y"], 19) * Cylinder(d["column"], d["head_z"] - 18, align=LOW)
        + Pos(0, -75, d["head_z"]) * Box(110, 205, d["head_top"] - d["head_z"], align=FRONT)
    )
    body += Pos(54, d["quill_y"], d["handle_z"]) * Rot(Y=90) * Cylinder(d["handle_pin"], 31, align=LOW)
    for side in (-1, 1):
        body += Pos(side * 45, 129, d["head_top"] - 10) * Box(8, 13, 18, align=FRONT)
    body -= Pos(0, 136, d["head_top"] + 3) * Rot(Y=90) * Cylinder(d["cover_pin"] + d["clearance"], 200)
    body -= Pos(0, d["quill_y"], 0) * Pos(0, 0, d["head_z"] - 1) * Cylinder(d["quill"] + d["clearance"], 2 * d["head_top"], align=LOW)

    return body, {
        "table": {"o": (0, d["column_y"], 200), "z": (0, 0, 1), "x": (1, 0, 0)},
        "feed": {"o": (0, d["quill_y"], d["head_z"]), "z": (0, 0, -1), "x": (1, 0, 0)},
        "handle": {"o": (55, d["quill_y"], d["handle_z"]), "z": (1, 0, 0), "x": (0, 1, 0)},
        "cover": {"o": (0, 136, d["head_top"] + 3), "z": (-1, 0, 0), "x": (0, 1, 0)},
    }
