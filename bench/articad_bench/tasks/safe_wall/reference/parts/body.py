from build123d import Align, Box, Cylinder, Pos, Rot

FRONT = (Align.CENTER, Align.MIN, Align.MIN)


def build(part):
    d = part.dimensions
    body = Box(d["width"], d["depth"], d["height"], align=FRONT) - Pos(0, -1, d["wall"]) * Box(
        d["width"] - 2 * d["wall"], d["depth"] - d["wall"] + 1, d["height"] - 2 * d["wall"], align=FRONT
    )
    body -= Pos(22 - d["width"] / 2, d["door"] / 2, 0) * Cylinder(d["pin"] + d["clearance"], 3 * d["height"])
    for z in (60, d["height"] - 60):
        body -= Pos(d["width"] / 2, d["door"] + 16, z) * Rot(Y=90) * Cylinder(d["bolt"] + 0.4, 60)

    return body, {"hinge": {"o": (22 - d["width"] / 2, d["door"] / 2, d["wall"]), "z": (0, 0, -1), "x": (1, 0, 0)}}
