from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
CORNER = (Align.MIN, Align.MIN, Align.MIN)


def build(part):
    d = part.dimensions
    shape = Pos(-d["nose"], -d["wide"] / 2, -d["play"] - d["board"]) * Box(d["nose"] + d["tail"], d["wide"], d["board"], align=CORNER)
    shape += Pos(d["column_u"], 0, -d["column_h"]) * Cylinder(d["column_r"], d["column_h"] - d["play"] - 1, align=LOW) + Pos(d["column_u"] / 2, 0, -d["column_h"] - d["board"]) * Box(240, 150, d["board"], align=LOW)
    shape += Pos(0, 0, -d["play"] - d["board"] - d["sleeve"]) * Cylinder(d["quill_bore"] + 8, d["sleeve"] + 1, align=LOW)
    shape -= Cylinder(d["quill_bore"], 2 * (d["play"] + d["board"] + d["sleeve"] + 10))
    shape += Pos(d["m_u"], 0, -d["play"] - d["board"] / 2) * Cylinder(d["pin_r"], d["m_high"] - (-d["play"] - d["board"] / 2), align=LOW)
    shape += Pos(d["i_u"], d["i_v"], -d["play"] - d["board"] / 2) * Cylinder(d["pin_r"], d["i_high"] - (-d["play"] - d["board"] / 2), align=LOW)
    shape += Pos(d["feed_u"], -17, -d["feed_w"] - 14) * Box(28, 30, d["feed_w"] + 14 - d["play"] - 1, align=LOW) - Pos(d["feed_u"], 0, -d["feed_w"]) * Rot(X=90) * Cylinder(d["feed_bore"], 1000)
    return shape, {
        "m": {"o": (d["m_u"], 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "i": {"o": (d["i_u"], d["i_v"], 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "spindle": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "feed": {"o": (d["feed_u"], -1, -d["feed_w"]), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
