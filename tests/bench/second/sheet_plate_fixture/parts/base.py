from build123d import Align, Circle, Cylinder, Locations, Pos, Rectangle, Rot, extrude

LOW = (Align.CENTER, Align.CENTER, Align.MIN)

SCREWS = ((14, 88), (40, 14), (120, 88), (148, 14))
DOWELS = ((12, 12), (146, 80))
TAPPED = ((80, 40), (80, 70), (100, 40), (100, 70), (132, 54))
WINDOW = ((46, 62),)


def base(
    long=160, wide=100, thick=18, screw=6.6, head=11, head_depth=6.8, dowel=8, tapped=5, tapped_depth=12, window=26,
    side=7, side_depth=30, side_y=30, side_z=9, pocket_long=60, pocket_wide=12, pocket_deep=7, pocket_x=62, pocket_y=14,
):
    """Three layers of one outline: the heads' counterbores, the middle, and the pocket that opens below."""

    def at(x, y):
        return x - long / 2, wide / 2 - y

    def holes(sketch, places, diameter):
        return sketch - Locations(*(at(*place) for place in places)) * Circle(diameter / 2)

    outline = holes(holes(Rectangle(long, wide), DOWELS, dowel), WINDOW, window)
    x, y = at(pocket_x, pocket_y)
    corner = (Align.MIN, Align.MAX)
    layers = [
        (holes(outline, SCREWS, head), 0, head_depth),
        (holes(outline, SCREWS, screw), head_depth, thick - pocket_deep),
        (holes(outline, SCREWS, screw) - Pos(x, y) * Rectangle(pocket_long, pocket_wide, align=corner), thick - pocket_deep, thick),
    ]
    plate = None
    for sketch, low, high in layers:
        layer = Pos(Z=low) * extrude(sketch, high - low)
        plate = layer if plate is None else plate + layer
    for place in TAPPED:
        plate -= Pos(*at(*place), 0) * Cylinder(tapped / 2, tapped_depth, align=LOW)
    return plate - Pos(long / 2, at(0, side_y)[1], side_z) * Rot(Y=-90) * Cylinder(side / 2, side_depth, align=LOW)
