from math import radians, tan

from build123d import Align, Cylinder, Polygon, Pos, Rot, extrude

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    diameter, length, bore, web, jaw = d["diameter"], d["length"], d["bore"], d["web"], d["jaw"]
    jaw_deg, inner = d["jaw_deg"], d["inner"]
    shape = Cylinder(diameter / 2, length, align=HIGH) - Pos(0, 0, -web) * Cylinder(bore / 2, length, align=HIGH)
    ring = Cylinder(diameter / 2, jaw, align=LOW) - Cylinder(inner / 2, 4 * jaw)
    far = diameter
    half = radians(jaw_deg / 2)
    wedge = extrude(Polygon((0, 0), (far, -far * tan(half)), (far, far * tan(half)), align=None), jaw)
    shape += [Rot(Z=60 + 120 * i) * (ring & wedge) for i in range(3)]
    return shape, {"spider": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
