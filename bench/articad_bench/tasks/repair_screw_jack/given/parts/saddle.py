from build123d import Align, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    radius, height, hole_radius, hole_depth, play = d["radius"], d["height"], d["hole_radius"], d["hole_depth"], d["play"]
    shape = Cylinder(radius, height, align=LOW) - Cylinder(hole_radius, hole_depth, align=LOW)

    return shape, {"neck": {"o": (0, 0, -play), "z": (0, 0, 1), "x": (1, 0, 0)}}
