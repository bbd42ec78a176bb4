from build123d import Align, Box


def build(part):
    d = part.dimensions
    half, t, f = d["half"], d["thickness"], d["foot_pos"]
    shape = Box(2 * half, 2 * half, t, align=(Align.CENTER, Align.CENTER, Align.MIN))

    def frame(o):
        return {"o": o, "z": (0, 0, 1), "x": (1, 0, 0)}

    return shape, {
        "foot_front_left": frame((-f, -f, 0)),
        "foot_front_right": frame((f, -f, 0)),
        "foot_back_left": frame((-f, f, 0)),
        "foot_back_right": frame((f, f, 0)),
        "movement_seat": frame((0, d["movement_y"], t)),
        "case_seat": frame((d["seat_x"], 0, t)),
    }
