from build123d import Align, Box, Cylinder, Pos, Sphere

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(0, 0, d["low"]) * Cylinder(d["radius"], d["high"] - d["low"], align=LOW) + Pos(0, 0, d["high"]) * Box(
        d["plate_side"], d["plate_side"], 8, align=LOW
    )
    body -= Sphere(d["ball_radius"] + d["clearance"])

    return body, {"head": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
