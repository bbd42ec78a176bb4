from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Box(800, d["calf"], d["panel"], align=(Align.CENTER, Align.MAX, Align.CENTER)) + Rot(Y=90) * Cylinder(d["panel"] / 2, 800)
    for side in (-1, 1):
        body -= Pos(side * 410, 0, 0) * Rot(Y=-90 * side) * Cylinder(d["axle"] + d["clearance"], 46, align=LOW)

    return body, {"calf": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
