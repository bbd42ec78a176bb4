from build123d import Align, Box, Cylinder, Pos, Rot

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def ram(layer, pin_d, play, rail_x, rail_y, wide=31, tall=34, deep=11):
    """A block with a square bore, and a pin towards the back."""
    middle = -deep / 2
    block = Pos(0, middle, 0) * (Box(wide, deep, tall) - Box(rail_x + 2 * play, rail_y + 2 * play, 2 * tall))
    return block + Pos(0, middle + rail_y / 2 + 2 * play, 0) * Rot(X=-90) * Cylinder(pin_d / 2, layer + (deep - rail_y) / 2 - 2 * play, align=UP)
