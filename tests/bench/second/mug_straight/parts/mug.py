from build123d import Align, Axis, BuildSketch, Cylinder, Locations, Mode, Plane, SlotCenterToCenter, extrude, fillet

DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def mug(across, wall, high, handle_high=54, bar=10, bar_wide=13, gap=28, rounding=3):
    """A mug whose brim is at z = 0."""
    r, end = across / 2, handle_high / 2
    far = r + gap + bar - end  # centre of the round end
    with BuildSketch(Plane.XZ) as outline:
        with Locations((far / 2, -high / 2)):
            SlotCenterToCenter(far, handle_high)
            SlotCenterToCenter(far, handle_high - 2 * bar, mode=Mode.SUBTRACT)
    grip = extrude(outline.sketch, bar_wide / 2, both=True)
    grip = fillet(grip.edges().filter_by(Axis.Y, reverse=True).filter_by(lambda e: abs(abs(e.center().Y) - bar_wide / 2) < 1e-6), rounding)
    inner = high - wall
    vessel = Cylinder(r, high, align=DOWN) + grip
    vessel -= Cylinder(r - wall, inner, align=DOWN)
    return vessel
