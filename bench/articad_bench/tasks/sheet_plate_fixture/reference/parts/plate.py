from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    length, width, thickness, bushing_diameter, dowel_diameter, screw_hole_diameter = d["length"], d["width"], d["thickness"], d["bushing_diameter"], d["dowel_diameter"], d["screw_hole_diameter"]
    counterbore_diameter, counterbore_depth, tapped_diameter, tapped_depth, slot_length, slot_width = d["counterbore_diameter"], d["counterbore_depth"], d["tapped_diameter"], d["tapped_depth"], d["slot_length"], d["slot_width"]
    slot_depth, slot_from_left, slot_from_front, side_hole_diameter, side_hole_depth = d["slot_depth"], d["slot_from_left"], d["slot_from_front"], d["side_hole_diameter"], d["side_hole_depth"]
    shape = Box(length, width, thickness, align=LOW)
    shape -= Pos(-34, 12, 0) * Cylinder(bushing_diameter / 2, 4 * thickness)
    for x, y in ((-68, -38), (66, 30)):
        shape -= Pos(x, y, 0) * Cylinder(dowel_diameter / 2, 4 * thickness)
    for x, y in ((-66, 38), (40, 38), (-40, -36), (68, -36)):
        shape -= Pos(x, y, 0) * Cylinder(screw_hole_diameter / 2, 4 * thickness)
        shape -= Pos(x, y, thickness) * Cylinder(counterbore_diameter / 2, counterbore_depth, align=HIGH)
    for x, y in ((0, 20), (20, 20), (0, -10), (20, -10), (52, 4)):
        shape -= Pos(x, y, thickness) * Cylinder(tapped_diameter / 2, tapped_depth, align=HIGH)
    corner = Pos(slot_from_left - length / 2, slot_from_front - width / 2, 0)
    shape -= corner * Box(slot_length, slot_width, slot_depth, align=(Align.MIN, Align.MIN, Align.MIN))
    shape -= Pos(length / 2, -20, thickness / 2) * Rot(Y=-90) * Cylinder(side_hole_diameter / 2, side_hole_depth, align=LOW)
    return shape, {
        "top": {"o": (0, 0, thickness), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
