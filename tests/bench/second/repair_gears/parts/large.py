from math import acos, cos, pi, radians, sin, tan

from build123d import Cylinder, Polygon, Rot, extrude


def build(part):
    d = part.dimensions
    module, teeth_count, width, backlash, phase_deg = d["module"], d["teeth_count"], d["width"], d["backlash"], d["phase_deg"]
    bore, gap = d["bore"], d["gap"]
    pitch, pressure = module * teeth_count / 2, radians(20)
    base, tip, root = pitch * cos(pressure), pitch + module, pitch - 1.25 * module
    half = pi / teeth_count / 2 - backlash / 4 / pitch
    low = max(base, root)
    flank = []
    for r in (low, (low + tip) / 2, tip):
        bend = [tan(a) - a for a in (pressure, acos(min(1.0, base / r)))]
        flank.append((r, half + bend[0] - bend[1]))
    flank = [(root, flank[0][1]), *flank] if root < base else flank
    points = []
    for tooth in range(teeth_count):
        middle = 2 * pi * tooth / teeth_count
        points += [(r * cos(middle - a), r * sin(middle - a)) for r, a in flank]
        points += [(r * cos(middle + a), r * sin(middle + a)) for r, a in reversed(flank)]
    shape = Rot(Z=phase_deg) * extrude(Polygon(*points, align=None), width)
    shape -= Cylinder(bore / 2, 4 * width)
    return shape, {"pin": {"o": (0, 0, -gap), "z": (0, 0, 1), "x": (1, 0, 0)}}
