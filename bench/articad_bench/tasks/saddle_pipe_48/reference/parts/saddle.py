from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    inside, strip, width, axis_z, foot = d["inside"], d["strip"], d["width"], d["axis_z"], d["foot"]
    hole = d["hole"]
    outside = inside + strip
    shape = Box(2 * (outside + foot), width, strip, align=LOW) + Box(2 * outside, width, axis_z, align=LOW)
    shape += Pos(0, 0, axis_z) * Rot(X=90) * Cylinder(outside, width)
    shape -= Box(2 * inside, 2 * width, 2 * axis_z) + Pos(0, 0, axis_z) * Rot(X=90) * Cylinder(inside, 2 * width)
    shape -= [Pos(x, 0, 0) * Cylinder(hole / 2, 6 * strip) for x in (-outside - foot / 2, outside + foot / 2)]
    return shape, {}
