from build123d import Align, Box, Cylinder, Pos, Rot


def rung(outside, rung_d):
    return Rot(Y=90) * Cylinder(rung_d / 2, 2 * outside)


def rail(rail_long, rail_deep, rail_thick, rung_d, pitch, first, rungs_count=5):
    """From its outer face inwards along +x; the lowest hole's axis is the x axis."""
    body = Pos(0, 0, -first) * Box(rail_thick, rail_deep, rail_long, align=(Align.MIN, Align.CENTER, Align.MIN))
    for n in range(rungs_count):
        body -= Pos(0, 0, n * pitch) * Rot(Y=90) * Cylinder(rung_d / 2, 4 * rail_thick)
    return body
