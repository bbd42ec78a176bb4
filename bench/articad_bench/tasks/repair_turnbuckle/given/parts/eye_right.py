from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    hole, ring, thickness, diameter, end = d["hole"], d["ring"], d["thickness"], d["diameter"], d["end"]
    thread = d["thread"]
    shape = Rot(X=90) * Cylinder(ring / 2, thickness) + Pos(-hole / 2 - 2, 0, 0) * Rot(Y=-90) * Cylinder(diameter / 2, end - hole / 2 - 2, align=LOW)
    shape -= Rot(X=90) * Cylinder(hole / 2, 2 * thickness)
    return shape, {"thread": {"o": (-thread, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
