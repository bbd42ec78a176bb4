from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, thickness, bore, handle, handle_length = d["diameter"], d["thickness"], d["bore"], d["handle"], d["handle_length"]
    handle_at = d["handle_at"]
    shape = Cylinder(diameter / 2, thickness, align=LOW) - Cylinder(bore / 2, 4 * thickness)
    shape += Pos(handle_at, 0, 0) * Cylinder(handle / 2, thickness + handle_length, align=LOW)
    return shape, {"worm": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (0, 1, 0)}}
