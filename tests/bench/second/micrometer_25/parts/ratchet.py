from build123d import Axis, BuildLine, BuildSketch, Plane, Polyline, make_face, revolve


def ratchet(gap, play, stub_d, stub, across=12, long=15.6, snap=0.5, snap_long=2):
    """A cap turned about z, with a cavity behind the snap rim of the stub."""
    neck, cavity = stub_d / 2 + play, stub_d / 2 + snap + play
    rim = stub - snap_long - gap - play
    with BuildSketch(Plane.XZ) as half:
        with BuildLine():
            Polyline(
                (neck, 0), (across / 2, 0), (across / 2, long), (0, long), (0, stub + gap), (cavity, stub + gap), (cavity, rim), (neck, rim), close=True
            )
        make_face()
    return revolve(half.sketch, Axis.Z)
