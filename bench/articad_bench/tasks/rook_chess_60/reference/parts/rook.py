from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    height, foot, foot_height, shaft, head = d["height"], d["foot"], d["foot_height"], d["shaft"], d["head"]
    head_height, hollow, hollow_depth, slot = d["head_height"], d["hollow"], d["hollow_depth"], d["slot"]
    shape = Cylinder(foot / 2, foot_height, align=LOW) + Cylinder(shaft / 2, height - head_height, align=LOW)
    shape += Pos(0, 0, height - head_height) * Cylinder(head / 2, head_height, align=LOW)
    top = Pos(0, 0, height - hollow_depth)
    shape -= top * Cylinder(hollow / 2, height, align=LOW)
    shape -= [top * Box(2 * head, slot, height, align=LOW), top * Box(slot, 2 * head, height, align=LOW)]
    return shape, {}
