from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
LEFT_LOW = (Align.MIN, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    h, right = d["height"] - 2 * d["wall"] - 2, d["width"] - d["wall"] - 23
    body = Pos(0, 0, 1) * (Cylinder(d["door"] / 2, h, align=LOW) + Box(right, d["door"], h, align=LEFT_LOW)) + Pos(0, 0, -8) * Cylinder(
        d["pin"], h + 18, align=LOW
    )
    for z in (60 - d["wall"], d["height"] - 60 - d["wall"]):
        body += Pos(right - 70, d["door"] / 2, z) * Box(40, 30, 26, align=(Align.MIN, Align.MIN, Align.CENTER)) - Pos(
            right, d["door"] / 2 + 16, z
        ) * Rot(Y=90) * Cylinder(d["bolt"] + d["clearance"], 300)
    for z in (d["dial_z"] - d["wall"], d["handle_z"] - d["wall"]):
        body -= Pos(d["width"] / 2 - 22, 0, z) * Rot(X=90) * Cylinder(d["shaft"] + d["clearance"], 60)

    return body, {
        "hinge": {"o": (0, 0, 0), "z": (0, 0, -1), "x": (1, 0, 0)},
        "dial": {"o": (d["width"] / 2 - 22, -d["door"] / 2, d["dial_z"] - d["wall"]), "z": (0, -1, 0), "x": (1, 0, 0)},
        "handle": {"o": (d["width"] / 2 - 22, -d["door"] / 2, d["handle_z"] - d["wall"]), "z": (0, 1, 0), "x": (1, 0, 0)},
        "bolt": {"o": (d["width"] - d["wall"] - 26, d["door"] / 2 + 16, 60 - d["wall"]), "z": (1, 0, 0), "x": (0, 1, 0)},
        "upper_bolt": {
            "o": (d["width"] - d["wall"] - 26, d["door"] / 2 + 16, d["height"] - 60 - d["wall"]),
            "z": (1, 0, 0),
            "x": (0, 1, 0),
        },
    }
