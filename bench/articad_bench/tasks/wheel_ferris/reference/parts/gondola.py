from build123d import Align, Box, Cylinder, Pos, Rot

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    body = Pos(0, 0, -d["seat_drop"]) * Box(40, d["width"] - 8, 4, align=HIGH)
    for side in (-1, 1):
        body += Pos(0, side * (d["width"] / 2 - 6), 0) * (Box(16, 4, d["seat_drop"] + 2, align=HIGH) + Rot(X=90) * Cylinder(8, 4))
    body -= Rot(X=90) * Cylinder(d["pin"] + d["clearance"], 200)

    return body, {"pin_0": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)}}
