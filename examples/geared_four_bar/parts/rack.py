from math import pi, radians, tan

from build123d import Align, Box, Polygon, Pos, extrude


def build(part):
    d = part.dimensions
    module, count, thick, low = d["module"], d["teeth_count"], d["thickness"], d["play"] / 2
    pitch, tip, root = pi * module, module, -1.25 * module
    back, half_length, slope = root - d["body"], pi * module * count / 2, tan(radians(20))
    half = (pitch / 2 - d["backlash"] / 2) / 2  # half a tooth on the pitch line

    points = [(back, -half_length), (root, -half_length)]
    for k in range(count):
        y = (k + 0.5) * pitch - half_length
        points += [
            (root, y - half + root * slope),
            (tip, y - half + tip * slope),
            (tip, y + half - tip * slope),
            (root, y + half - root * slope),
        ]
    points += [(root, half_length), (back, half_length)]
    rack = Pos(0, 0, low) * extrude(Polygon(*points, align=None), thick)

    middle = low + thick / 2
    behind = (Align.MAX, Align.CENTER, Align.CENTER)
    rack += Pos(back, 0, middle) * Box(d["stem"] + d["tongue_head"], 2 * half_length, d["stem_height"], align=behind)
    rack += Pos(back - d["stem"], 0, middle) * Box(d["tongue_head"], 2 * half_length, d["head_height"], align=behind)
    return rack, {"tongue": {"o": (back, 0, middle), "z": (0, -1, 0), "x": (1, 0, 0)}}
