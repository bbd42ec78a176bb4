from build123d import Box, Cylinder, Pos


def build(part):
    d = part.dimensions
    drum, width, stub, stubs, reach = d["drum"], d["width"], d["stub"], d["stubs"], d["reach"]
    arm = d["arm"]
    shape = Cylinder(drum / 2, width) + Cylinder(stub / 2, stubs) + Pos(reach / 2, 0, 0) * Box(reach, arm, width)
    return shape, {"cap": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
