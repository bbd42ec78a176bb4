from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, width, thickness, eye, bore = d["length"], d["width"], d["thickness"], d["eye"], d["bore"]
    play, hole, first, pitch = d["play"], d["hole"], d["first"], d["pitch"]
    shape = Pos(0, 0, play) * Cylinder(eye / 2, width, align=LOW)
    shape += Pos(0, -eye / 2 + thickness / 2, play) * Box(length - eye / 2, thickness, width, align=(Align.MIN, Align.CENTER, Align.MIN))
    shape -= Cylinder(bore / 2, 4 * width)
    shape -= [Pos(first + i * pitch, 0, play + width / 2) * Rot(X=90) * Cylinder(hole / 2, 4 * eye) for i in range(3)]
    return shape, {"pintle": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
