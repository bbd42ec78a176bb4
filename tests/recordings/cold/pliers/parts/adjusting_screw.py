import math

from build123d import Align, Cylinder, Pos, Rot


def build(part):
    d = part.dimensions

    def rod(radius, start, end):
        return Pos(start, 0, 0) * Rot(Y=90) * Cylinder(
            radius, end - start, align=(Align.CENTER, Align.CENTER, Align.MIN))

    shank, knob_r = d["shank"], d["knob_radius"]
    knob_end = -(shank + d["knob_length"])
    body = rod(knob_r, knob_end, -shank)
    count = d["flute_count"]
    for i in range(count):
        a = 2 * math.pi * i / count
        body -= Pos(0, knob_r * math.sin(a), knob_r * math.cos(a)) * rod(
            d["flute_radius"], knob_end - 1, -shank + 1)
    neck_end, head = d["neck_end"], d["head_length"]
    body += rod(d["shank_radius"], -shank - d["knob_length"] / 2, -d["shoulder"])
    body += rod(d["neck_radius"], -d["shoulder"] - 1, neck_end + head / 2)
    body += rod(d["head_radius"], neck_end, neck_end + head)
    return body, {
        "thread": {"o": (-d["thread_x"], 0, 0), "z": (-1, 0, 0), "x": (0, 1, 0)},
        "tip": {"o": (0, 0, 0), "z": (-1, 0, 0), "x": (0, 1, 0)},
    }
