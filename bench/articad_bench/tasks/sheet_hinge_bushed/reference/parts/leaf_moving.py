from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    width, height, thickness, knuckle_diameter, knuckle_start, knuckle_height = d["width"], d["height"], d["thickness"], d["knuckle_diameter"], d["knuckle_start"], d["knuckle_height"]
    knuckle_room, bushing_bore_diameter, screw_hole_diameter, counterbore_diameter, counterbore_depth = d["knuckle_room"], d["bushing_bore_diameter"], d["screw_hole_diameter"], d["counterbore_diameter"], d["counterbore_depth"]
    y = -knuckle_diameter / 2
    shape = Pos(0, y, 0) * Box(width, thickness, height, align=(Align.MIN, Align.MIN, Align.MIN))
    for low, high in ((-height, knuckle_start), (knuckle_start + knuckle_height, 2 * height)):
        shape -= Pos(0, 0, low) * Box(knuckle_room, 2 * knuckle_diameter, high - low, align=LOW)
    shape += Pos(0, 0, knuckle_start) * Cylinder(knuckle_diameter / 2, knuckle_height, align=LOW)
    shape -= Cylinder(bushing_bore_diameter / 2, 4 * height)
    for x, z in ((26, 14), (56, 40), (26, 62)):
        shape -= Pos(x, y, z) * Rot(X=-90) * Cylinder(screw_hole_diameter / 2, thickness, align=LOW)
        shape -= Pos(x, y + thickness, z) * Rot(X=90) * Cylinder(counterbore_diameter / 2, counterbore_depth, align=LOW)
    return shape, {
        "lower": {"o": (0, 0, knuckle_start), "z": (0, 0, 1), "x": (1, 0, 0)},
        "upper": {"o": (0, 0, knuckle_start+knuckle_height), "z": (0, 0, -1), "x": (1, 0, 0)},
    }
