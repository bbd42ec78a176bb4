from build123d import Align, Box, Cylinder, Plane, Polygon, Pos, Rot, extrude

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, width, height, lift, neck = d["length"], d["width"], d["height"], d["lift"], d["neck"]
    head, rise, play, screw, screw_z = d["head"], d["rise"], d["play"], d["screw"], d["screw_z"]
    shape = Pos(0, 0, lift) * Box(length, width, height - lift, align=LOW)
    low, high = neck / 2 + play, head / 2 + play
    shape -= extrude(Plane.YZ * Polygon((-low, 0), (low, 0), (high, rise), (high, rise + lift), (-high, rise + lift), (-high, rise), align=None), length, both=True)
    shape -= Pos(0, 0, screw_z) * Rot(X=-90) * Cylinder(screw / 2, width, align=LOW)
    return shape, {
        "base": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)},
        "screw": {"o": (0, width/2, screw_z), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
