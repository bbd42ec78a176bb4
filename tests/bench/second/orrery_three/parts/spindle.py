from build123d import Axis, BuildLine, BuildSketch, Plane, Polyline, make_face, revolve


def spindle(thick, level, sun_low, earth_z, venus_z, mercury_z, bore_e, bore_v, bore_m, tenon_d=14, tenon=10, neck_d=6):
    """Stepped column: each hub rests on the end of the next thicker piece."""
    steps = [
        (-tenon, tenon_d),
        (0, bore_e + 10),
        (earth_z - thick, bore_e),
        (venus_z - thick, bore_v),
        (mercury_z - thick, bore_m),
        (mercury_z - thick + 12, neck_d),
    ]
    points, ends = [(0, -tenon)], [z for z, _ in steps[1:]] + [level - sun_low - thick]
    for (low, across), high in zip(steps, ends):
        points += [(across / 2, low), (across / 2, high)]
    with BuildSketch(Plane.XZ) as half:
        with BuildLine():
            Polyline(*points, (0, level - sun_low - thick), close=True)
        make_face()
    return revolve(half.sketch, Axis.Z)
