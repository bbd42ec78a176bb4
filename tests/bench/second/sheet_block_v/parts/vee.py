from math import radians, tan

from build123d import Align, Cylinder, Polyline, Pos, extrude, make_face

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def vee(groove_z, groove, long=80, wide=64, high=52, groove_deep=5, opening=44, vee_deg=90, relief=4, relief_deep=26, tapped=6.8, tapped_deep=16, tapped_y=20, tapped_z=14):
    half, inner, top = wide / 2, wide / 2 - groove_deep, groove_z + groove
    root = high - (opening - relief) / 2 / tan(radians(vee_deg / 2))
    right = [(half, 0), (half, groove_z), (inner, groove_z), (inner, top), (half, top), (half, high), (opening / 2, high)]
    right += [(relief / 2, root), (relief / 2, high - relief_deep)]
    left = [(-x, y) for x, y in reversed(right)]
    block = extrude(make_face(Polyline(*right, *left, right[0])), long)
    return block - Pos(tapped_y, tapped_z, long) * Cylinder(tapped / 2, tapped_deep, align=HIGH)
