from build123d import Align, Box, Cylinder, GridLocations, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    length, width, foot, axis_height, back_diameter, bore_diameter = d["length"], d["width"], d["foot"], d["axis_height"], d["back_diameter"], d["bore_diameter"]
    foot_hole_diameter, counterbore_diameter, counterbore_depth, foot_pitch, oil_hole_diameter, oil_hole_y = d["foot_hole_diameter"], d["counterbore_diameter"], d["counterbore_depth"], d["foot_pitch"], d["oil_hole_diameter"], d["oil_hole_y"]
    shape = Box(length, width, foot, align=LOW) + Box(back_diameter, width, axis_height, align=LOW)
    shape += Pos(0, 0, axis_height) * Rot(X=90) * Cylinder(back_diameter / 2, width)
    shape -= Pos(0, 0, axis_height) * Rot(X=90) * Cylinder(bore_diameter / 2, 2 * width)
    feet = GridLocations(foot_pitch, 0, 2, 1)
    shape -= feet * Cylinder(foot_hole_diameter / 2, 4 * foot)
    shape -= Pos(0, 0, foot) * feet * Cylinder(counterbore_diameter / 2, counterbore_depth, align=HIGH)
    shape -= Pos(0, oil_hole_y, axis_height) * Cylinder(oil_hole_diameter / 2, back_diameter, align=LOW)
    return shape, {
        "shaft": {"o": (0, 0, axis_height), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
