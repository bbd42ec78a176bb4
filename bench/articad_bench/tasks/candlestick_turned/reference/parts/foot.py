from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, height, step, step_height = d["diameter"], d["height"], d["step"], d["step_height"]
    shape = Cylinder(diameter / 2, height, align=LOW) + Pos(0, 0, height) * Cylinder(step / 2, step_height, align=LOW)
    return shape, {"stem": {"o": (0, 0, height + step_height), "z": (0, 0, 1), "x": (1, 0, 0)}}
