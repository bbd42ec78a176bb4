from build123d import Align, Box, Cylinder, GridLocations, Plane, Polygon, Pos, extrude

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    length, width, plate, neck, top, rise = d["length"], d["width"], d["plate"], d["neck"], d["top"], d["rise"]
    screw_hole_diameter, counterbore_diameter, counterbore_depth, hole_pitch_x, hole_pitch_y, dowel_diameter = d["screw_hole_diameter"], d["counterbore_diameter"], d["counterbore_depth"], d["hole_pitch_x"], d["hole_pitch_y"], d["dowel_diameter"]
    dowel_depth = d["dowel_depth"]
    shape = Box(length, width, plate, align=LOW)
    profile = Polygon((-neck / 2, plate), (neck / 2, plate), (top / 2, plate + rise), (-top / 2, plate + rise), align=None)
    shape += Pos(-length / 2, 0, 0) * extrude(Plane.YZ * profile, length)
    screws = GridLocations(hole_pitch_x, hole_pitch_y, 2, 2)
    shape -= screws * Cylinder(screw_hole_diameter / 2, 4 * plate)
    shape -= Pos(0, 0, plate) * screws * Cylinder(counterbore_diameter / 2, counterbore_depth, align=HIGH)
    for x, y in ((-48, 12), (30, -24)):
        shape -= Pos(x, y, 0) * Cylinder(dowel_diameter / 2, dowel_depth, align=LOW)
    return shape, {
        "guide": {"o": (0, 0, plate), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
