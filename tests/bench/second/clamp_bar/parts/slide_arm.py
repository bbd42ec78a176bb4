from build123d import Circle, Pos, Rectangle, extrude


def slide_arm(bar_wide, bar_thick, play, arm_high, spindle_x, spindle_d, bar_x=24.5, wide=26, boss=30):
    """The bar's slot is at the origin, the spindle's bore in the round end."""
    reach = spindle_x - bar_x
    outline = Pos((reach - bar_x) / 2, 0) * Rectangle(reach + bar_x, wide) + Pos(reach, 0) * Circle(boss / 2)
    outline -= Rectangle(bar_wide + 2 * play, bar_thick + 2 * play) + Pos(reach, 0) * Circle(spindle_d / 2 + play)
    return extrude(outline, arm_high / 2, both=True)
