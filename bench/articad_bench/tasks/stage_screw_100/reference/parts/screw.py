from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    diameter, length, end, collar, collar_width = d["diameter"], d["length"], d["end"], d["collar"], d["collar_width"]
    block, play = d["block"], d["play"]
    shape = Pos(0, 0, -length) * Cylinder(diameter / 2, length + end, align=LOW)
    shape += Pos(0, 0, play) * Cylinder(collar / 2, collar_width, align=LOW)
    shape += Pos(0, 0, -block - play) * Cylinder(collar / 2, collar_width, align=HIGH)
    return shape, {"bearing": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (0, 1, 0)}, "knob": {"o": (0, 0, 8), "z": (0, 0, 1), "x": (0, 1, 0)}}
