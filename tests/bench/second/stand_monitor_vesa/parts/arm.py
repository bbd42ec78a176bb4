from build123d import BuildSketch, Mode, Plane, RectangleRounded, extrude


def arm(arm_wide, arm_high, arm_long, sheet=2.5, corner=3):
    """A rectangular tube along -y from the origin."""
    with BuildSketch(Plane.XZ) as tube:
        RectangleRounded(arm_wide, arm_high, corner)
        RectangleRounded(arm_wide - 2 * sheet, arm_high - 2 * sheet, 0.3, mode=Mode.SUBTRACT)
    return extrude(tube.sketch, arm_long)
