from build123d import Align, Box


def build(part):
    d = part.dimensions
    shape = Box(2 * d["half_x"], 2 * d["half_y"], d["thickness"], align=(Align.CENTER, Align.CENTER, Align.MIN))
    return shape, {
        "front": {"o": (0, -d["half_y"], d["thickness"] / 2), "z": (0, -1, 0), "x": (1, 0, 0)},
        "frame": {"o": (0, d["frame_y"], d["thickness"]), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
