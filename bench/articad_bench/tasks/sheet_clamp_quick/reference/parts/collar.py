from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    outside_diameter, bore_diameter, lip_diameter, lip_height, height, lug_end = d["outside_diameter"], d["bore_diameter"], d["lip_diameter"], d["lip_height"], d["height"], d["lug_end"]
    lug_width, slit, rod_x, rod_hole_diameter, relief_diameter = d["lug_width"], d["slit"], d["rod_x"], d["rod_hole_diameter"], d["relief_diameter"]
    shape = Cylinder(outside_diameter / 2, height, align=LOW) + Box(lug_end, lug_width, height, align=(Align.MIN, Align.CENTER, Align.MIN))
    shape -= Cylinder(bore_diameter / 2, height - lip_height, align=LOW) + Cylinder(lip_diameter / 2, 4 * height)
    shape -= Box(2 * lug_end, slit, 4 * height, align=(Align.MIN, Align.CENTER, Align.CENTER))
    shape -= Pos(rod_x, 0, height / 2) * Rot(X=90) * Cylinder(rod_hole_diameter / 2, 4 * lug_width)
    shape -= Pos(-outside_diameter / 2 + 3, 0, 0) * Cylinder(relief_diameter / 2, 4 * height)
    return shape, {
        "rod": {"o": (rod_x, -lug_width/2, height/2), "z": (0, 1, 0), "x": (1, 0, 0)},
        "washer": {"o": (rod_x, lug_width/2, height/2), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
