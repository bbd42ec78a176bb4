from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    cheek_diameter, cheek, gap, slot_depth, shoulder, bore_diameter = d["cheek_diameter"], d["cheek"], d["gap"], d["slot_depth"], d["shoulder"], d["bore_diameter"]
    shank_diameter, shank_end, tapped_diameter, tapped_depth = d["shank_diameter"], d["shank_end"], d["tapped_diameter"], d["tapped_depth"]
    height = gap + 2 * cheek
    shape = Cylinder(cheek_diameter / 2, height) + Box(shoulder, cheek_diameter, height, align=(Align.MAX, Align.CENTER, Align.CENTER))
    shape -= Pos(cheek_diameter / 2 - slot_depth, 0, 0) * Box(2 * shoulder, 2 * cheek_diameter, gap, align=(Align.MIN, Align.CENTER, Align.CENTER))
    shape += Pos(-shoulder, 0, 0) * Rot(Y=-90) * Cylinder(shank_diameter / 2, shank_end - shoulder, align=LOW)
    shape -= Cylinder(bore_diameter / 2, 2 * height)
    shape -= Pos(-shank_end, 0, 0) * Rot(Y=90) * Cylinder(tapped_diameter / 2, tapped_depth, align=LOW)
    return shape, {
        "axis": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "pin": {"o": (0, 0, gap/2+cheek), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
