from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    width, height, thickness, knuckle_diameter, knuckle_height, knuckle_room = d["width"], d["height"], d["thickness"], d["knuckle_diameter"], d["knuckle_height"], d["knuckle_room"]
    pin_bore_diameter, screw_hole_diameter, counterbore_diameter, counterbore_depth = d["pin_bore_diameter"], d["screw_hole_diameter"], d["counterbore_diameter"], d["counterbore_depth"]
    y = -knuckle_diameter / 2
    shape = Pos(0, y, 0) * Box(width, thickness, height, align=(Align.MAX, Align.MIN, Align.MIN)) + Cylinder(knuckle_diameter / 2, height, align=LOW)
    shape -= Pos(0, 0, knuckle_height) * Box(knuckle_room, 2 * knuckle_diameter, height - 2 * knuckle_height, align=LOW)
    shape -= Cylinder(pin_bore_diameter / 2, 4 * height)
    for x, z in ((-24, 10), (-24, 70), (-56, 25), (-56, 62)):
        shape -= Pos(x, y, z) * Rot(X=-90) * Cylinder(screw_hole_diameter / 2, thickness, align=LOW)
        shape -= Pos(x, y + thickness, z) * Rot(X=90) * Cylinder(counterbore_diameter / 2, counterbore_depth, align=LOW)
    return shape, {
        "axis": {"o": (0, 0, knuckle_height+3), "z": (0, 0, 1), "x": (1, 0, 0)},
        "head": {"o": (0, 0, height), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
