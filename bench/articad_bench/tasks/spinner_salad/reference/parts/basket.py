from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Cylinder(d["basket_radius"], d["basket_height"], align=LOW)
        - Pos(0, 0, 2.5) * Cylinder(d["basket_radius"] - 2.5, d["basket_height"], align=LOW)
        + Cylinder(12, 15, align=LOW)
    )
    for i in range(6):
        body -= (
            Rot(Z=30 * i) * Pos(0, 0, 15) * Box(3 * d["basket_radius"], 8, d["basket_height"] - 30, align=LOW)
            if i % 2 == 0
            else Rot(Z=30 * i) * Pos(0, 0, 20) * Box(3 * d["basket_radius"], 6, d["basket_height"] - 40, align=LOW)
        )
    body += Cylinder(12, 15, align=LOW)
    body -= Cylinder(d["peg"] + d["clearance"], 12.5, align=LOW)

    return body, {"spin": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
