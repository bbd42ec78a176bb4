from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, rim, hub, height, hole = d["diameter"], d["rim"], d["hub"], d["height"], d["hole"]
    spoke = d["spoke"]
    shape = Cylinder(diameter / 2, height, align=LOW) - Cylinder(diameter / 2 - rim, 3 * height)
    shape += Cylinder(hub / 2, height, align=LOW)
    shape += [Rot(Z=120 * i) * Pos(diameter / 4, 0, height / 2) * Box(diameter / 2 - rim, spoke, height / 2) for i in range(3)]
    shape -= Cylinder(hole / 2, 3 * height)
    return shape, {"stem": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
