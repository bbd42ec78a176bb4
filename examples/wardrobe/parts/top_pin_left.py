from build123d import Align, Axis, Cylinder, chamfer


def build(part):
    d = part.dimensions
    head = Cylinder(d["head_radius"], d["head_thickness"], align=(Align.CENTER, Align.CENTER, Align.MIN))
    head = chamfer(head.edges().sort_by(Axis.Z)[-1], d["head_thickness"] / 2)
    pin = Cylinder(d["pin_radius"], d["length"], align=(Align.CENTER, Align.CENTER, Align.MAX))
    return head + pin, {"head": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
