from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
CORNER = (Align.MIN, Align.MIN, Align.MIN)


def build(part):
    d = part.dimensions
    side, low, high, stem, head = d["side"], d["low"], d["high"], d["stem"], d["head"]
    step, play, rail, bracket, bracket_top = d["step"], d["play"], d["rail"], d["bracket"], d["bracket_top"]
    bracket_left, bracket_right, screw_y, screw_z, own_x = d["bracket_left"], d["bracket_right"], d["screw_y"], d["screw_z"], d["own_x"]
    own_z, bore = d["own_z"], d["bore"]
    shape = Pos(0, 0, low) * Box(side, side, high - low, align=LOW)
    under = low - play
    shape -= Pos(0, 0, under) * Box(2 * side, stem + 2 * play, 2 * step, align=LOW) + Pos(0, 0, under + step - play) * Box(2 * side, head + 2 * play, step + 2 * play, align=LOW)
    shape += Pos(0, 0, high) * Box(stem, rail, 2 * step, align=LOW) + Pos(0, 0, high + step) * Box(head, rail, step, align=LOW)
    shape += Pos(bracket_left, rail / 2, high) * Box(bracket_right - bracket_left, bracket, bracket_top - high, align=CORNER)
    shape -= Pos(0, screw_y, screw_z) * Rot(Y=90) * Cylinder(bore / 2, 2 * side)
    shape -= Pos(own_x, rail / 2, own_z) * Rot(X=90) * Cylinder(bore / 2, 4 * bracket)
    return shape, {
        "base": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)},
        "table": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
        "screw": {"o": (own_x, rail/2 + bracket, own_z), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
