from build123d import Align, Box, Cylinder, Pos


def plate(side, thick, pilot=22.5, small=3.4, small_square=31, large=5.5, large_square=48):
    """Plate towards +x, -y, -z; every hole is drilled from above."""
    body = Box(side, side, thick, align=(Align.MIN, Align.MAX, Align.MAX))
    holes = [(0, 0, pilot)]
    for square, diameter in ((small_square, small), (large_square, large)):
        holes += [(a * square / 2, b * square / 2, diameter) for a in (-1, 1) for b in (-1, 1)]
    for x, y, diameter in holes:
        body -= Pos(side / 2 + x, y - side / 2, 0) * Cylinder(diameter / 2, 4 * thick)
    return body
