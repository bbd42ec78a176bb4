from math import cos, radians, sin

from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, width, floor, thickness, block = d["length"], d["width"], d["floor"], d["thickness"], d["block"]
    reach, bore, bend_deg = d["reach"], d["bore"], d["bend_deg"]
    shape = Pos(0, 0, floor) * Box(length, width, thickness, align=LOW)
    far = Pos(reach * cos(radians(bend_deg)), 0, -reach * sin(radians(bend_deg)))
    for place, turn in ((Pos(-reach, 0, 0), 90), (far, 90 + bend_deg)):
        top = place.position.Z + bore
        shape += Pos(place.position.X, 0, floor) * Box(block, width, top - floor, align=LOW)
        shape -= place * Rot(Y=turn) * Cylinder(bore / 2, 4 * block)
    return shape, {
        "input": {"o": (-reach, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)},
        "output": {"o": (reach*cos(radians(bend_deg)), 0, -reach*sin(radians(bend_deg))), "z": (cos(radians(bend_deg)), 0, -sin(radians(bend_deg))), "x": (0, 1, 0)},
    }
