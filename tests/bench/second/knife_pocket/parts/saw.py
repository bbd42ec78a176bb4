from build123d import BuildLine, BuildSketch, Circle, Locations, Mode, Plane, Polyline, extrude, make_face


def saw(tail, sheet, pin_d, play, reach=67.8):
    """Flat in XZ, round about its pin, its tip towards +x."""
    with BuildSketch(Plane.XZ) as flat:
        Circle(tail)
        with BuildLine():
            Polyline((0, 3 - tail), (reach, 4.5 - tail), (reach, tail), (0, tail), close=True)
        make_face()
        for number in range(10):
            with Locations((20 + 4.5 * number, 3.5 - tail)):
                Circle(0.9, mode=Mode.SUBTRACT)
        Circle(pin_d / 2 + play, mode=Mode.SUBTRACT)
    return extrude(flat.sketch, sheet / 2, both=True)
