from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    thickness, front, back_x, back, anvil = d["thickness"], d["front"], d["back_x"], d["back"], d["anvil"]
    arm_low, arm_high, bore = d["arm_low"], d["arm_high"], d["bore"]
    shape = Pos((front + back_x - back) / 2, 0, -anvil) * Box(front - back_x + back, thickness, arm_high + anvil, align=LOW)
    shape -= Pos(back_x, 0, 0) * Box(400, 2 * thickness, arm_low, align=(Align.MIN, Align.CENTER, Align.MIN))
    shape -= Pos(0, 0, arm_low) * Cylinder(bore / 2, 4 * anvil)
    return shape, {"thread": {"o": (0, 0, arm_high), "z": (0, 0, 1), "x": (1, 0, 0)}}
