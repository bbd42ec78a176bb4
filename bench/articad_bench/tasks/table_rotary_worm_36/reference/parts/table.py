from build123d import Align, Cylinder, PolarLocations, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    diameter, thickness, play, pivot, pivot_length = d["diameter"], d["thickness"], d["play"], d["pivot"], d["pivot_length"]
    hole, circle = d["hole"], d["circle"]
    shape = Pos(0, 0, play) * (Cylinder(diameter / 2, thickness, align=LOW) + Cylinder(pivot / 2, pivot_length, align=HIGH))
    shape -= PolarLocations(circle / 2, 4) * Cylinder(hole / 2, 8 * thickness)
    return shape, {"base": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
