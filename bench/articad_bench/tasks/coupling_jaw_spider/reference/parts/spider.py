from math import radians, tan

from build123d import Align, Cylinder, Polygon, Rot, extrude

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    height, outside, ring, lobe_deg = d["height"], d["outside"], d["ring"], d["lobe_deg"]
    far, half = outside, radians(lobe_deg / 2)
    wedge = extrude(Polygon((0, 0), (far, -far * tan(half)), (far, far * tan(half)), align=None), height)
    star = Cylinder(ring / 2, height, align=LOW)
    star += [Rot(Z=30 + 60 * i) * (wedge & Cylinder(outside / 2, height, align=LOW)) for i in range(6)]
    shape = star
    return shape, {
        "driving": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "driven": {"o": (0, 0, height), "z": (0, 0, -1), "x": (1, 0, 0)},
    }
