from build123d import Align, Circle, Cylinder, GridLocations, Pos, RectangleRounded, extrude

DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def base(plate, king_d, head_d, crown, gap, side=60, square=45, hole=6.5, head=3):
    """Plate below z = 0 with a king pin, whose riveted head holds the fork."""
    flat = RectangleRounded(side, side, 4)
    for place in GridLocations(square, square, 2, 2):
        flat -= place * Circle(hole / 2)
    low = -plate - crown - 2 * gap
    body = extrude(flat, -plate) + Pos(0, 0, -plate / 2) * Cylinder(king_d / 2, -low - plate / 2 + 1, align=DOWN)
    return body + Pos(0, 0, low) * Cylinder(head_d / 2, head, align=DOWN)
