from build123d import Align, Box, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    outside_diameter, inside_diameter, thickness, opening = d["outside_diameter"], d["inside_diameter"], d["thickness"], d["opening"]
    shape = Cylinder(outside_diameter / 2, thickness, align=LOW) - Cylinder(inside_diameter / 2, 4 * thickness)
    shape -= Box(outside_diameter, opening, 4 * thickness, align=(Align.MIN, Align.CENTER, Align.CENTER))
    return shape, {
        "seat": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
