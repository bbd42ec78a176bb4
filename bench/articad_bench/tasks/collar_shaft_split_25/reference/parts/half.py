from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    outside, width, bore, slit, screw = d["outside"], d["width"], d["bore"], d["slit"], d["screw"]
    pitch, seat, seat_y = d["pitch"], d["seat"], d["seat_y"]
    shape = Cylinder(outside / 2, width) - Cylinder(bore / 2, 4 * width) - Pos(0, slit / 2, 0) * Box(4 * outside, 4 * outside, 4 * width, align=(Align.CENTER, Align.MAX, Align.CENTER))
    for x in (-pitch / 2, pitch / 2):
        shape -= Pos(x, 0, 0) * Rot(X=-90) * (Cylinder(screw / 2, outside, align=LOW) + Pos(0, 0, seat_y) * Cylinder(seat / 2, outside, align=LOW))
    return shape, {
        "shaft": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "screw_1": {"o": (pitch/2, seat_y, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
        "screw_2": {"o": (-pitch/2, seat_y, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
