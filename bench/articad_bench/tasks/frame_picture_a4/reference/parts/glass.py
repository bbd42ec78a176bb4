from build123d import Align, Box, Pos


def build(part):
    d = part.dimensions
    width, height, thickness, play = d["width"], d["height"], d["thickness"], d["play"]
    shape = Pos(0, 0, play) * Box(width, thickness, height, align=(Align.CENTER, Align.MIN, Align.MIN))
    return shape, {
        "frame": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "back": {"o": (0, thickness, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
