from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(0, -130, d["top_z"]) * Box(2 * d["half"], 225, d["panel"])
    for side in (-1, 1):
        body += Pos(side * d["half"], -150, d["top_z"] - 70) * Box(d["beam"], 1900, 90, align=LOW)
        for y in (-250, 250):
            body += Pos(side * d["post_x"], y, d["top_z"] - 60) * Box(52, 40, 60, align=LOW)
        for y in (-1075, 775):
            body += Pos(side * d["half"], y, 0) * Box(d["beam"], 50, d["top_z"] - 60, align=LOW)
    for y in (-1075, 775):
        body += Pos(0, y, 150) * Box(2 * d["half"], 50, 60, align=LOW)
    for side in (-1, 1):
        for y in (-250, 250):
            body -= Pos(side * d["post_x"], y, 0) * Cylinder(d["rail_post"] + d["clearance"], 3 * d["top_z"])
    for y in (0, -270):
        body -= Pos(0, y, d["top_z"]) * Rot(Y=90) * Cylinder(d["axle"] + d["clearance"], 3 * d["half"])

    return body, {
        "back": {"o": (0, 0, d["top_z"]), "z": (1, 0, 0), "x": (0, 1, 0)},
        "thigh": {"o": (0, -270, d["top_z"]), "z": (-1, 0, 0), "x": (0, 1, 0)},
        "rail": {"o": (d["post_x"], 0, d["top_z"]), "z": (0, 0, -1), "x": (1, 0, 0)},
        "left_rail": {"o": (-d["post_x"], 0, d["top_z"]), "z": (0, 0, -1), "x": (1, 0, 0)},
    }
