from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
BACK = (Align.CENTER, Align.MAX, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(8 + d["width"] / 2, -0.5, d["base"]) * Box(d["width"], d["lid_depth"], d["height"], align=BACK) - Pos(
        8 + d["width"] / 2, 0, d["base"] + d["wall"]
    ) * Box(d["width"] - 2 * d["wall"], d["lid_depth"] - d["wall"] + 0.5, d["height"] - 2 * d["wall"], align=BACK)
    for z in (150.5, 450.5):
        body += Pos(0, 0, z) * (
            Cylinder(6, 38, align=LOW)
            + Pos(0, -0.5, 0) * Box(11, 5.5, 38, align=(Align.MIN, Align.MAX, Align.MIN))
            - Cylinder(d["hinge_pin"] + d["clearance"], 400)
        )

    return body, {"book": {"o": (0, 0, 0), "z": (0, 0, -1), "x": (1, 0, 0)}}
