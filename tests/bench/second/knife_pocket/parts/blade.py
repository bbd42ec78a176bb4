from build123d import BuildLine, BuildSketch, Circle, Mode, Plane, Polyline, extrude, make_face


def blade(tail, sheet, pin_d, play, reach=70):
    """Flat in XZ, round about its pin, its tip towards +x."""
    with BuildSketch(Plane.XZ) as flat:
        Circle(tail)
        with BuildLine():
            Polyline((0, -tail), (reach - 24, -tail), (reach, tail - 3), (reach - 5, tail), (0, tail), close=True)
        make_face()
        Circle(pin_d / 2 + play, mode=Mode.SUBTRACT)
    return extrude(flat.sketch, sheet / 2, both=True)
