from build123d import BuildSketch, Circle, Locations, Mode, Rectangle, extrude


def lever(pivot_d, play, hub_d=10, arm=20, arm_wide=5.5, sheet=3.4):
    """Flat lever in XY, its arm towards -y."""
    with BuildSketch() as outline:
        Circle(hub_d / 2)
        with Locations((0, -arm / 2)):
            Rectangle(arm_wide, arm)
        Circle(pivot_d / 2 + play, mode=Mode.SUBTRACT)
    return extrude(outline.sketch, sheet).translate((0, 0, 0.2))
