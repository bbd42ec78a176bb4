from build123d import Plane, Pos, Rectangle, extrude


def along(flat, long):
    """A section, drawn y to the right and z up, along x."""
    return extrude(Plane.YZ * flat, long)


def channel(high, deep, wall, mouth):
    flat = Pos(deep / 2, 0) * Rectangle(deep, high) - Pos(deep / 2, 0) * Rectangle(deep - 2 * wall, high - 2 * wall)
    return flat - Pos(deep, 0) * Rectangle(2 * wall, mouth)


def outer(long, outer_high, outer_deep, outer_wall, mouth=34):
    return along(channel(outer_high, outer_deep, outer_wall, mouth), long)


def middle(long, middle_high, middle_deep, middle_wall, neck, play):
    return along(channel(middle_high, middle_deep, middle_wall, neck + 2 * play), long)


def inner(long, inner_high, inner_deep, flange, neck):
    return along(Pos(flange / 2, 0) * Rectangle(flange, inner_high) + Pos(inner_deep / 2, 0) * Rectangle(inner_deep, neck), long)
