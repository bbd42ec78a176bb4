from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    outside, inside, height, play = d["outside"], d["inside"], d["height"], d["play"]
    shape = Pos(0, 0, play) * (Cylinder(outside / 2, height, align=LOW) - Cylinder(inside / 2, 4 * height))
    return shape, {"body": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
