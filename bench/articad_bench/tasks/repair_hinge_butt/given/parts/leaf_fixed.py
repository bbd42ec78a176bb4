from build123d import Box, Cylinder, GridLocations, Pos, Rot


def build(part):
    d = part.dimensions
    width, height, thickness, knuckle_radius, third = d["width"], d["height"], d["thickness"], d["knuckle_radius"], d["third"]
    play, pin, hole = d["play"], d["pin"], d["hole"]
    shape = Pos(-width / 2, knuckle_radius - thickness / 2, 0) * Box(width, thickness, height)
    shape += Cylinder(knuckle_radius, height)
    shape -= Cylinder(knuckle_radius + 0.4, third + play) + Pos(knuckle_radius, 0, 0) * Box(2 * knuckle_radius, 4 * knuckle_radius, third + play)
    shape -= Cylinder(pin / 2, 2 * height)
    shape -= Pos(-0.65 * width, 0, 0) * Rot(X=90) * GridLocations(1, height / 3, 1, 3) * Cylinder(hole / 2, 4 * knuckle_radius)

    return shape, {"pin": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}, "head": {"o": (0, 0, height/2), "z": (0, 0, 1), "x": (1, 0, 0)}}
