from build123d import Axis, BuildLine, BuildSketch, Plane, Polyline, make_face, revolve


def spindle(face_x, gap, spindle_d, barrel_d, barrel_end, thimble_end, stub_d, stub, thimble_d=18, thimble_long=48, snap=0.5, snap_long=2):
    """Turned about z: the measuring rod, the thimble with its closed end, and a stub with a snap rim."""
    rod, bore, outer, pin = spindle_d / 2, barrel_d / 2 + gap, thimble_d / 2, stub_d / 2
    end = thimble_end - face_x - gap
    web, open_end = barrel_end + 3 - face_x - gap, end - thimble_long
    with BuildSketch(Plane.XZ) as half:
        with BuildLine():
            Polyline(
                (0, 0),
                (rod, 0),
                (rod, web),
                (bore, web),
                (bore, open_end),
                (outer, open_end),
                (outer, end),
                (pin, end),
                (pin, end + stub - snap_long),
                (pin + snap, end + stub - snap_long),
                (pin, end + stub),
                (0, end + stub),
                close=True,
            )
        make_face()
    return revolve(half.sketch, Axis.Z)
