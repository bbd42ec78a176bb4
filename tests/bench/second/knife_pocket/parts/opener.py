from build123d import BuildLine, BuildSketch, Circle, Locations, Mode, Plane, Polyline, extrude, make_face


def opener(tail, sheet, pin_d, play, reach=32):
    """Flat in XZ, round about its pin, its tip towards +x."""
    with BuildSketch(Plane.XZ) as flat:
        Circle(tail)
        with BuildLine():
            Polyline((0, -tail), (reach - 6, -tail), (reach, 0), (reach, tail - 1), (0, tail - 1), close=True)
        make_face()
        with Locations((reach - 8, tail - 1)):
            Circle(3, mode=Mode.SUBTRACT)
        Circle(pin_d / 2 + play, mode=Mode.SUBTRACT)
    return extrude(flat.sketch, sheet / 2, both=True)
