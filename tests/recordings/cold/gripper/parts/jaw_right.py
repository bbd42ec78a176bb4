from math import pi, radians, tan

from build123d import Align, Box, Cylinder, Plane, Polygon, Pos, extrude

SIDE = (Align.MIN, Align.CENTER, Align.MIN)
UP = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    x0, x1 = d["inner"], d["outer"]
    m, zp, rh = d["module"], d["pitch_z"], d["rack_half"]
    fb, ft, pb = d["foot_bottom"], d["foot_top"], d["plate_bottom"]
    top = pb + d["plate_thickness"]
    root = zp + 1.25 * m
    shape = Pos(x0, 0, pb) * Box(x1 - x0, 2 * d["plate_half"], d["plate_thickness"], align=SIDE)
    shape += Pos(x0, 0, fb) * Box(x1 - x0, 2 * d["neck_half"], pb - fb + 1, align=SIDE)
    shape += Pos(x0, 0, fb) * Box(x1 - x0, 2 * d["foot_half"], ft - fb, align=SIDE)
    shape += Pos(-d["rack_end"], 0, root) * Box(x1 + d["rack_end"], 2 * rh, ft - root, align=SIDE)
    half = pi * m / 4 - 0.025 * m
    t = tan(radians(20))
    tip, sunk = zp - m, root + 0.25 * m
    a, b = half - m * t, half + 1.25 * m * t
    for i in range(d["tooth_count"]):
        x = -d["first_tooth"] + i * pi * m
        pts = [(x - a, tip), (x + a, tip), (x + b, root), (x + b, sunk), (x - b, sunk), (x - b, root)]
        shape += extrude(Plane.XZ * Polygon(*pts, align=None), amount=rh, both=True)
    for x in (d["screw_in"], d["screw_out"]):
        shape -= Pos(x, 0, top - d["hole_depth"]) * Cylinder(d["hole_radius"], d["hole_depth"] + 1, align=UP)
    c = part.connectors
    return shape, {
        "slide": {"o": (0, 0, 0), "z": c["slide"].z, "x": c["slide"].x},
        "finger": {"o": (d["finger_x"], 0, top), "z": c["finger"].z, "x": c["finger"].x},
    }
