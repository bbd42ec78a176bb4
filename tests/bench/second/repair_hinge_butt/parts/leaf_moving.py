from build123d import Box, Cylinder, GridLocations, Pos, Rot


def build(part):
    d = part.dimensions
    width, height, thickness, knuckle_radius, third = d["width"], d["height"], d["thickness"], d["knuckle_radius"], d["third"]
    pin, clearance, hole = d["pin"], d["clearance"], d["hole"]
    shape = Pos(width / 2, knuckle_radius - thickness / 2, 0) * Box(width, thickness, height)
    for side in (-1, 1):
        shape -= Pos(0, 0, side * (third + height) / 2) * Box(2 * knuckle_radius + 1, 6 * knuckle_radius, height)
    shape += Cylinder(knuckle_radius, third)
    shape -= Cylinder(pin / 2 + clearance, 2 * height)
    shape -= Pos(0.65 * width, 0, 0) * Rot(X=90) * GridLocations(1, height / 3, 1, 3) * Cylinder(hole / 2, 4 * knuckle_radius)

    return shape, {"pin": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
