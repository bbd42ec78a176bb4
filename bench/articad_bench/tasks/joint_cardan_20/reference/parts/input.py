from build123d import Box, Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    shaft, end, arm_in, arm_out, arm_width = d["shaft"], d["end"], d["arm_in"], d["arm_out"], d["arm_width"]
    tip, yoke, web, pin_hole, reach = d["tip"], d["yoke"], d["web"], d["pin_hole"], d["reach"]
    sign = -1
    shape = Pos(sign * (yoke + web / 2), 0, 0) * Box(web, arm_width, 2 * arm_out)
    for side in (-1, 1):
        middle = side * (arm_in + arm_out) / 2
        shape += Pos(sign * (yoke - tip) / 2, 0, middle) * Box(yoke + tip, arm_width, arm_out - arm_in)
    shape += Pos(sign * (yoke + end) / 2, 0, 0) * Rot(Y=90) * Cylinder(shaft / 2, end - yoke)
    shape -= Cylinder(pin_hole / 2, 4 * arm_out)
    return shape, {
        "bearing": {"o": (-reach, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)},
        "cross": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
