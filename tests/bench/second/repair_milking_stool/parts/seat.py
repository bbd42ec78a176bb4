from math import sqrt

from build123d import Align, Cylinder, PolarLocations

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, thickness, leg_diameter, socket, circle = d["diameter"], d["thickness"], d["leg_diameter"], d["socket"], d["circle"]
    shape = Cylinder(diameter / 2, thickness, align=LOW)
    shape -= PolarLocations(circle / 2, 3) * Cylinder(leg_diameter / 2, socket, align=LOW)

    return shape, {
        "leg_1": {"o": (circle/2, 0, socket), "z": (0, 0, 1), "x": (1, 0, 0)},
        "leg_2": {"o": (-circle/4, circle/2*sqrt(0.75), socket), "z": (0, 0, 1), "x": (-0.5, sqrt(0.75), 0)},
        "leg_3": {"o": (-circle/4, -circle/2*sqrt(0.75), socket), "z": (0, 0, 1), "x": (-0.5, -sqrt(0.75), 0)},
    }
