from build123d import Align, Box, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    thickness, depth, seat, height, bar = d["thickness"], d["depth"], d["seat"], d["height"], d["bar"]
    shape = Pos(-thickness / 2, -depth / 2, seat - bar) * Box(thickness, depth, bar, align=LOW)
    shape += Pos(-thickness / 2, -depth + bar / 2, 0) * Box(thickness, bar, seat, align=LOW)
    shape += Pos(-thickness / 2, -bar / 2, 0) * Box(thickness, bar, height, align=LOW)
    return shape, {
        "seat_1": {"o": (-thickness/2, -385, seat), "z": (0, 0, 1), "x": (1, 0, 0)},
        "seat_2": {"o": (-thickness/2, -260, seat), "z": (0, 0, 1), "x": (1, 0, 0)},
        "seat_3": {"o": (-thickness/2, -135, seat), "z": (0, 0, 1), "x": (1, 0, 0)},
        "back_1": {"o": (-thickness/2, -bar, 570), "z": (0, -1, 0), "x": (1, 0, 0)},
        "back_2": {"o": (-thickness/2, -bar, 730), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
