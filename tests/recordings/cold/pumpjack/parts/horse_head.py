from math import cos, radians, sin

from build123d import Align, Box, Line, Plane, Pos, ThreePointArc, extrude, make_face


def build(part):
    d = part.dimensions
    r, half = d["face_radius"], radians(d["half_angle_deg"])
    back_x, back_half = d["back_x"], d["back_half"]
    upper, lower = (r * cos(half), r * sin(half)), (r * cos(half), -r * sin(half))
    face = make_face([
        ThreePointArc(lower, (r, 0), upper),
        Line(upper, (back_x, back_half)),
        Line((back_x, back_half), (back_x, -back_half)),
        Line((back_x, -back_half), lower),
    ])
    shape = extrude(Plane.XZ * face, amount=d["thickness"] / 2, both=True)
    pocket = Box(d["pocket_end"] - back_x + 1, d["pocket_width"], d["pocket_height"], align=(Align.MAX, Align.CENTER, Align.CENTER))
    shape -= Pos(d["pocket_end"], 0, 0) * pocket
    return shape, {"seat": {"o": (d["pocket_end"], 0, 0), "z": (1, 0, 0), "x": (0, 0, 1)}}
