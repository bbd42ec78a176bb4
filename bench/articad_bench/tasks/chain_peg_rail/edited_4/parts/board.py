from math import cos, radians, sin

from build123d import Box, Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    length, height, thickness, hole, pitch = d["length"], d["height"], d["thickness"], d["hole"], d["pitch"]
    lean_deg, screw, screw_x = d["lean_deg"], d["screw"], d["screw_x"]
    shape = Pos(0, -thickness / 2, 0) * Box(length, thickness, height)
    shape -= [Pos((i - 2.5) * pitch, 0, 0) * Rot(X=90 - lean_deg) * Cylinder(hole / 2, 6 * thickness) for i in range(6)]
    shape -= [Pos(x, 0, 0) * Rot(X=90) * Cylinder(screw / 2, 4 * thickness) for x in (-screw_x, screw_x)]
    return shape, {
        "peg_1": {"o": (-2.5*pitch, 0, 0), "z": (0, -cos(radians(lean_deg)), sin(radians(lean_deg))), "x": (1, 0, 0)},
        "peg_2": {"o": (-1.5*pitch, 0, 0), "z": (0, -cos(radians(lean_deg)), sin(radians(lean_deg))), "x": (1, 0, 0)},
        "peg_3": {"o": (-0.5*pitch, 0, 0), "z": (0, -cos(radians(lean_deg)), sin(radians(lean_deg))), "x": (1, 0, 0)},
        "peg_4": {"o": (0.5*pitch, 0, 0), "z": (0, -cos(radians(lean_deg)), sin(radians(lean_deg))), "x": (1, 0, 0)},
        "peg_5": {"o": (1.5*pitch, 0, 0), "z": (0, -cos(radians(lean_deg)), sin(radians(lean_deg))), "x": (1, 0, 0)},
        "peg_6": {"o": (2.5*pitch, 0, 0), "z": (0, -cos(radians(lean_deg)), sin(radians(lean_deg))), "x": (1, 0, 0)},
    }
