from build123d import Align, Box, Cylinder, GridLocations, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    flange, flange_thickness, boss_diameter, height, seat_diameter, seat_depth = d["flange"], d["flange_thickness"], d["boss_diameter"], d["height"], d["seat_diameter"], d["seat_depth"]
    shaft_hole_diameter, screw_hole_diameter, counterbore_diameter, counterbore_depth, square_pitch, dowel_hole_diameter = d["shaft_hole_diameter"], d["screw_hole_diameter"], d["counterbore_diameter"], d["counterbore_depth"], d["square_pitch"], d["dowel_hole_diameter"]
    dowel_hole_depth, oil_hole_diameter, oil_hole_height = d["dowel_hole_depth"], d["oil_hole_diameter"], d["oil_hole_height"]
    shape = Box(flange, flange, flange_thickness, align=LOW) + Cylinder(boss_diameter / 2, height, align=LOW)
    shape -= Cylinder(shaft_hole_diameter / 2, 4 * height)
    shape -= Pos(0, 0, height) * Cylinder(seat_diameter / 2, seat_depth, align=HIGH)
    screws = GridLocations(square_pitch, square_pitch, 2, 2)
    shape -= screws * Cylinder(screw_hole_diameter / 2, 4 * height)
    shape -= Pos(0, 0, flange_thickness) * screws * Cylinder(counterbore_diameter / 2, counterbore_depth, align=HIGH)
    for x, y in ((40, 8), (-40, -20)):
        shape -= Pos(x, y, 0) * Cylinder(dowel_hole_diameter / 2, dowel_hole_depth, align=LOW)
    shape -= Pos(0, 0, oil_hole_height) * Rot(Y=90) * Cylinder(oil_hole_diameter / 2, boss_diameter, align=LOW)
    return shape, {
        "seat": {"o": (0, 0, height), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
