from build123d import Align, Cone, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    foot, rim, height, wall, floor = d["foot"], d["rim"], d["height"], d["wall"], d["floor"]
    shape = Cone(foot / 2, rim / 2, height, align=LOW)
    low = foot / 2 + (rim - foot) / 2 * floor / height - wall
    shape -= Pos(0, 0, floor) * Cone(low, rim / 2 - wall, height - floor, align=LOW)
    return shape, {}
