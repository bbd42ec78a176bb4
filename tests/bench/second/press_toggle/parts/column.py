from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.MIN, Align.MIN, Align.MIN)
UP = (Align.CENTER, Align.CENTER, Align.MIN)


def column(
    ax, az, lx, lz, board_y, upper_y, pull_y, lever_y, pin_d, play, layer, rail_x, rail_y, ram=11, wide=190, deep=120, base=18, high=301, board=14
):
    """Base and board; pivot pins with riveted heads; the square rail of the ram on a bracket."""
    frame = Box(wide, deep, base, align=LOW) + Pos(0, board_y, base / 2) * Box(wide, board, high - base / 2, align=LOW)

    def pin(x, z, radius, back, front):
        return Pos(x, back, z) * Rot(X=90) * Cylinder(radius, back - front, align=UP)

    r, inside = pin_d / 2, board_y + board / 2
    frame += pin(ax, az, r, inside, upper_y - layer) + pin(ax, az, r + 2, upper_y - layer, upper_y - layer - 2)
    frame += pin(lx, lz, r, inside, lever_y - 10.3) + pin(lx, lz, r + 3, lever_y - 9.3, lever_y - 11)
    frame += pin(lx, lz, r + 3, inside, lever_y + 2 * play)
    rail = pull_y - ram / 2
    frame += Pos(ax - 6, rail - rail_y / 2, 52) * Box(12, inside - rail + rail_y / 2, 10, align=LOW)
    return frame + Pos(ax - rail_x / 2, rail - rail_y / 2, 55) * Box(rail_x, rail_y, 127, align=LOW)
