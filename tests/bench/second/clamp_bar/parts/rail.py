from build123d import Align, Axis, Box, Pos, chamfer

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def rail(bar_wide, bar_thick, foot_long=108, foot_high=26, foot_wide=18, tall=330):
    """The bar upright through the origin, on a foot along +x."""
    foot = Pos(-bar_wide / 2, 0, 0) * Box(foot_long, foot_wide, foot_high, align=(Align.MIN, Align.CENTER, Align.MIN))
    foot = chamfer(foot.edges().filter_by(Axis.Y).group_by(Axis.X)[-1].sort_by(Axis.Z)[0], 6)
    return foot + Box(bar_wide, bar_thick, tall, align=UP)
