from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, thickness, spindle, cable, cable_x = d["diameter"], d["thickness"], d["spindle"], d["cable"], d["cable_x"]
    shape = Cylinder(diameter / 2, thickness, align=LOW) - Cylinder(spindle / 2, 4 * thickness)
    shape -= Pos(cable_x, 0, 0) * Cylinder(cable / 2, 4 * thickness)
    return shape, {
        "below": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "above": {"o": (0, 0, thickness), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
