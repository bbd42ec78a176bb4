from build123d import Align, Box, Cylinder, GridLocations, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    length, width, height, wall, flange = d["length"], d["width"], d["height"], d["wall"], d["flange"]
    flange_thickness, small, large, apart, axis_z = d["flange_thickness"], d["small"], d["large"], d["apart"], d["axis_z"]
    hole = d["hole"]
    shape = Box(length, width, height, align=LOW)
    shape += Pos(0, 0, height) * Box(length + 2 * flange, width + 2 * flange, flange_thickness, align=HIGH)
    shape -= Pos(0, 0, wall) * Box(length - 2 * wall, width - 2 * wall, height, align=LOW)
    shape -= Pos(-apart / 2, 0, axis_z) * Rot(X=90) * Cylinder(small / 2, 2 * width) + Pos(apart / 2, 0, axis_z) * Rot(X=90) * Cylinder(large / 2, 2 * width)
    shape -= Pos(0, 0, height) * GridLocations((length + flange) / 2, width + flange, 3, 2) * Cylinder(hole / 2, 4 * flange_thickness)
    return shape, {}
