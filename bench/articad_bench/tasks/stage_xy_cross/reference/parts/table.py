from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    side, low, high, stem, head = d["side"], d["low"], d["high"], d["stem"], d["head"]
    step, play, screw_x, screw_z, bore = d["step"], d["play"], d["screw_x"], d["screw_z"], d["bore"]
    shape = Pos(0, 0, low) * Box(side, side, high - low, align=LOW)
    under = low - play
    shape -= Pos(0, 0, under) * Box(stem + 2 * play, 2 * side, 2 * step, align=LOW) + Pos(0, 0, under + step - play) * Box(head + 2 * play, 2 * side, step + 2 * play, align=LOW)
    shape -= Pos(screw_x, 0, screw_z) * Rot(X=90) * Cylinder(bore / 2, 2 * side)
    return shape, {"saddle": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)}}
