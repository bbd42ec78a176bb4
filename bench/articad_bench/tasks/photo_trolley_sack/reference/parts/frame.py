from build123d import Align, Box, Cylinder, Pos, Rot, Sphere

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    rail_x, tube, bottom, height, grip, bar_pitch = d["rail_x"], d["tube"], d["bottom"], d["height"], d["grip"], d["bar_pitch"]
    first_bar, axle_y, axle_z, bracket, axle = d["first_bar"], d["axle_y"], d["axle_z"], d["bracket"], d["axle"]
    shape = Pos(0, 0, height) * Rot(Y=90) * Cylinder(tube / 2, 2 * rail_x)
    for side in (-1, 1):
        shape += Pos(side * rail_x, 0, bottom) * Cylinder(tube / 2, height - bottom, align=LOW) + Pos(side * rail_x, 0, height) * Sphere(tube / 2)
        shape += Pos(side * rail_x, 0, height) * Rot(X=-90) * Cylinder(tube / 2, grip, align=LOW)
        shape += Pos(side * rail_x, 0, axle_z) * Box(tube / 2, axle_y + 1.5 * axle, bracket, align=(Align.CENTER, Align.MIN, Align.CENTER))
    for row in range(4):
        shape += Pos(0, 0, first_bar + row * bar_pitch) * Rot(Y=90) * Cylinder(0.35 * tube, 2 * rail_x)
    shape -= Pos(0, axle_y, axle_z) * Rot(Y=90) * Cylinder(axle / 2, 4 * rail_x)
    return shape, {
        "toe": {"o": (0, 0, bottom), "z": (0, 0, 1), "x": (1, 0, 0)},
        "axle": {"o": (0, axle_y, axle_z), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
