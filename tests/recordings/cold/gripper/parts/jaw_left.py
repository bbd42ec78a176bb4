from math import pi, radians, tan

from build123d import Align, Box, Cylinder, Plane, Polygon, Pos, extrude

SIDE = (Align.MIN, Align.CENTER, Align.MIN)
UP = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    xi, xo, leg = -d["inner"], -d["outer"], d["leg"]
    m, zp, rh = d["module"], d["pitch_z"], d["rack_half"]
    fb, ft, pb = d["foot_bottom"], d["foot_top"], d["plate_bottom"]
    st, back = d["slot_top"], d["rack_back"]
    top = pb + d["plate_thickness"]
    length = xi - xo
    root = -(zp + 1.25 * m)
    shape = Pos(xo, 0, pb) * Box(length, 2 * d["plate_half"], d["plate_thickness"], align=SIDE)
    shape += Pos(xo, 0, fb) * Box(length, 2 * d["neck_half"], pb - fb + 1, align=SIDE)
    shape += Pos(xo, 0, fb) * Box(length, 2 * d["foot_half"], ft - fb, align=SIDE)
    shape -= Pos(xo + leg, 0, fb - 1) * Box(length - leg + 1, 2 * d["slot_half"], st - fb + 1, align=SIDE)
    shape += Pos(xo, 0, -back) * Box(leg, 2 * d["neck_half"], back + st, align=SIDE)
    shape += Pos(xo, 0, -back) * Box(d["rack_end"] - xo, 2 * rh, root + back, align=SIDE)
    half = pi * m / 4 - 0.025 * m
    t = tan(radians(20))
    tip, sunk = -(zp - m), root - 0.25 * m
    a, b = half - m * t, half + 1.25 * m * t
    for i in range(d["tooth_count"]):
        x = -d["first_tooth"] + i * pi * m
        pts = [(x - b, sunk), (x + b, sunk), (x + b, root), (x + a, tip), (x - a, tip), (x - b, root)]
        shape += extrude(Plane.XZ * Polygon(*pts, align=None), amount=rh, both=True)
    for x in (-d["screw_in"], -d["screw_out"]):
        shape -= Pos(x, 0, top - d["hole_depth"]) * Cylinder(d["hole_radius"], d["hole_depth"] + 1, align=UP)
    c = part.connectors
    return shape, {
        "slide": {"o": (0, 0, 0), "z": c["slide"].z, "x": c["slide"].x},
        "finger": {"o": (-d["finger_x"], 0, top), "z": c["finger"].z, "x": c["finger"].x},
    }
