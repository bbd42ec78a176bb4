from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    flange = Cylinder(d["flange_radius"], d["flange_thickness"], align=LOW)
    length = d["seat_length"] + d["flange_thickness"] + d["pin_length"]
    pin = Pos(0, 0, -d["seat_length"]) * Cylinder(d["pin_radius"], length, align=LOW)
    return flange + pin, {
        "seat": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "pin": {"o": (0, 0, d["flange_thickness"] + d["hinge_play"] / 2), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
