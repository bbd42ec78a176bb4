from build123d import BuildLine, BuildSketch, Plane, Polyline, extrude, make_face


def hook(bar_high, wide=24, thick=6, deep=24, lip=12):
    """A strip bent to a J: flat on the post, under the bar and up again before it."""
    low = -bar_high / 2
    with BuildSketch(Plane.YZ) as profile:
        with BuildLine():
            Polyline(
                (0, low - 40), (0, low), (thick - deep, low), (thick - deep, low + lip), (-deep, low + lip), (-deep, low - thick),
                (-thick, low - thick), (-thick, low - 40), close=True,
            )
        make_face()
    return extrude(profile.sketch, wide / 2, both=True)
