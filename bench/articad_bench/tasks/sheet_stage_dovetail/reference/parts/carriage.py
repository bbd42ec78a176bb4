from build123d import Align, Box, Cylinder, GridLocations, Plane, Polygon, Pos, Rot, extrude

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    length, width, height, neck, top, rise = d["length"], d["width"], d["height"], d["neck"], d["top"], d["rise"]
    recess_depth, play, gib, screw_hole_diameter, screw_height, bore_diameter = d["recess_depth"], d["play"], d["gib"], d["screw_hole_diameter"], d["screw_height"], d["bore_diameter"]
    bore_depth, tapped_diameter, tapped_depth, tapped_pitch = d["bore_depth"], d["tapped_diameter"], d["tapped_depth"], d["tapped_pitch"]
    slope, deep = (top - neck) / 2 / rise, recess_depth
    low, high = neck / 2 + play, neck / 2 + play + slope * deep
    shape = Box(length, width, height, align=LOW)
    profile = Polygon((-low, -0.001), (low + gib, -0.001), (high + gib, deep), (-high, deep), align=None)
    shape -= Pos(-length, 0, 0) * extrude(Plane.YZ * profile, 2 * length)
    shape -= Pos(0, 0, screw_height) * Rot(X=-90) * Cylinder(screw_hole_diameter / 2, width, align=LOW)
    shape -= Pos(0, 0, height) * Cylinder(bore_diameter / 2, bore_depth, align=HIGH)
    shape -= Pos(0, 0, height) * GridLocations(tapped_pitch, tapped_pitch, 2, 2) * Cylinder(tapped_diameter / 2, tapped_depth, align=HIGH)
    return shape, {
        "guide": {"o": (0, 0, -play), "z": (1, 0, 0), "x": (0, 1, 0)},
        "gib": {"o": (0, neck/2+play, 0), "z": (1, 0, 0), "x": (0, 1, 0)},
        "thread": {"o": (0, width/2, screw_height), "z": (0, 1, 0), "x": (0, 0, 1)},
    }
