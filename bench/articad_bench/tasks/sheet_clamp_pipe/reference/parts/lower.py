from build123d import Align, Box, Cylinder, GridLocations, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    foot_length, foot_width, foot, width, axis_height, saddle_width = d["foot_length"], d["foot_width"], d["foot"], d["width"], d["axis_height"], d["saddle_width"]
    pipe_diameter, parting, hinge_x, knuckle_diameter, pin_bore_diameter, middle = d["pipe_diameter"], d["parting"], d["hinge_x"], d["knuckle_diameter"], d["pin_bore_diameter"], d["middle"]
    bolt_x, bolt_height, cheek_end, cheek_top, slot_start, slot_floor = d["bolt_x"], d["bolt_height"], d["cheek_end"], d["cheek_top"], d["slot_start"], d["slot_floor"]
    foot_hole_diameter, foot_pitch_x, foot_pitch_y = d["foot_hole_diameter"], d["foot_pitch_x"], d["foot_pitch_y"]
    side = Rot(X=90)
    shape = Box(foot_length, foot_width, foot, align=LOW) + Box(saddle_width, width, axis_height - parting, align=LOW)
    shape += Box(cheek_end, width, cheek_top, align=(Align.MIN, Align.CENTER, Align.MIN))
    shape += Pos(-hinge_x, 0, axis_height) * side * Cylinder(knuckle_diameter / 2, width)
    shape += Pos(-hinge_x, 0, axis_height - parting) * Box(hinge_x, width, knuckle_diameter / 2 - parting, align=(Align.MIN, Align.CENTER, Align.MAX))
    shape -= Pos(0, 0, axis_height) * side * Cylinder(pipe_diameter / 2, 2 * width)
    shape -= Pos(-saddle_width / 2, 0, axis_height) * Box(foot_length, middle, 2 * knuckle_diameter, align=(Align.MAX, Align.CENTER, Align.CENTER))
    shape -= Pos(slot_start, 0, slot_floor) * Box(foot_length, middle, 2 * axis_height, align=(Align.MIN, Align.CENTER, Align.MIN))
    for x, z in ((-hinge_x, axis_height), (bolt_x, bolt_height)):
        shape -= Pos(x, 0, z) * side * Cylinder(pin_bore_diameter / 2, 2 * width)
    shape -= GridLocations(foot_pitch_x, foot_pitch_y, 2, 2) * Cylinder(foot_hole_diameter / 2, 2 * foot)
    return shape, {
        "hinge": {"o": (-hinge_x, 0, axis_height), "z": (0, 1, 0), "x": (1, 0, 0)},
        "hinge_pin": {"o": (-hinge_x, -width/2, axis_height), "z": (0, 1, 0), "x": (1, 0, 0)},
        "bolt": {"o": (bolt_x, 0, bolt_height), "z": (0, 1, 0), "x": (1, 0, 0)},
        "bolt_pin": {"o": (bolt_x, -width/2, bolt_height), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
