from build123d import Align, Cylinder, PolarLocations, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    flange_diameter, flange_thickness, collar_diameter, collar_end, journal_diameter, journal_end = d["flange_diameter"], d["flange_thickness"], d["collar_diameter"], d["collar_end"], d["journal_diameter"], d["journal_end"]
    tail_diameter, total, groove_diameter, groove_start, groove_width, tail_groove_diameter = d["tail_diameter"], d["total"], d["groove_diameter"], d["groove_start"], d["groove_width"], d["tail_groove_diameter"]
    tail_groove_start, tail_groove_width, cross_hole_diameter, cross_hole_height, centre_bore_diameter, centre_bore_depth = d["tail_groove_start"], d["tail_groove_width"], d["cross_hole_diameter"], d["cross_hole_height"], d["centre_bore_diameter"], d["centre_bore_depth"]
    flange_hole_diameter, flange_circle = d["flange_hole_diameter"], d["flange_circle"]
    shape = Cylinder(flange_diameter / 2, flange_thickness, align=LOW) + Cylinder(collar_diameter / 2, collar_end, align=LOW)
    shape += Cylinder(journal_diameter / 2, journal_end, align=LOW) + Cylinder(tail_diameter / 2, total, align=LOW)
    for start, width, bottom in ((groove_start, groove_width, groove_diameter), (tail_groove_start, tail_groove_width, tail_groove_diameter)):
        shape -= Pos(0, 0, start) * (Cylinder(flange_diameter, width, align=LOW) - Cylinder(bottom / 2, width, align=LOW))
    shape -= Pos(0, 0, cross_hole_height) * Rot(Y=90) * Cylinder(cross_hole_diameter / 2, 2 * tail_diameter)
    shape -= Pos(0, 0, total) * Cylinder(centre_bore_diameter / 2, centre_bore_depth, align=HIGH)
    shape -= PolarLocations(flange_circle / 2, 3) * Cylinder(flange_hole_diameter / 2, 4 * flange_thickness)
    return shape, {
        "journal": {"o": (0, 0, collar_end), "z": (0, 0, 1), "x": (1, 0, 0)},
        "groove": {"o": (0, 0, groove_start+0.1), "z": (0, 0, 1), "x": (1, 0, 0)},
        "tail": {"o": (0, 0, journal_end), "z": (0, 0, 1), "x": (1, 0, 0)},
        "tail_groove": {"o": (0, 0, tail_groove_start), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
