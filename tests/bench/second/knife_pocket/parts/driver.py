from build123d import BuildLine, BuildSketch, Circle, Mode, Plane, Polyline, extrude, make_face


def driver(tail, sheet, pin_d, play, reach=33.7):
    """Flat in XZ, round about its pin, its tip towards +x."""
    with BuildSketch(Plane.XZ) as flat:
        Circle(tail)
        with BuildLine():
            Polyline((0, -tail), (reach - 8, -2.5), (reach, -2.5), (reach, 2.5), (reach - 8, tail - 1), (0, tail - 1), close=True)
        make_face()
        Circle(pin_d / 2 + play, mode=Mode.SUBTRACT)
    return extrude(flat.sketch, sheet / 2, both=True)
