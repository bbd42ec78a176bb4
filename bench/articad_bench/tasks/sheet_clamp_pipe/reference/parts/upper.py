from build123d import Align, Box, Cylinder, Pos, Rot

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    width, outside_diameter, pipe_diameter, parting, hinge_x, knuckle_diameter = d["width"], d["outside_diameter"], d["pipe_diameter"], d["parting"], d["hinge_x"], d["knuckle_diameter"]
    bore_diameter, knuckle_width, ear_end, ear_height, slot_width, slot_start = d["bore_diameter"], d["knuckle_width"], d["ear_end"], d["ear_height"], d["slot_width"], d["slot_start"]
    side = Rot(X=90)
    shape = side * Cylinder(outside_diameter / 2, width) + Box(ear_end, width, ear_height, align=(Align.MIN, Align.CENTER, Align.MIN))
    shape -= Pos(0, 0, parting) * Box(4 * hinge_x, 2 * width, outside_diameter, align=HIGH)
    shape += Pos(-hinge_x, 0, 0) * side * Cylinder(knuckle_diameter / 2, knuckle_width)
    shape += Pos(-hinge_x, 0, parting) * Box(hinge_x, knuckle_width, knuckle_diameter / 2 - parting, align=(Align.MIN, Align.CENTER, Align.MIN))
    shape -= side * Cylinder(pipe_diameter / 2, 2 * width)
    shape -= Pos(-hinge_x, 0, 0) * side * Cylinder(bore_diameter / 2, 2 * width)
    shape -= Pos(slot_start, 0, 0) * Box(hinge_x, slot_width, 4 * ear_height, align=(Align.MIN, Align.CENTER, Align.CENTER))
    return shape, {
        "hinge": {"o": (-hinge_x, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
