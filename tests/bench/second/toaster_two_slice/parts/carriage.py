from build123d import Align, Box, Pos

LOW = (Align.MIN, Align.MIN, Align.MIN)


def block(x0, x1, y0, y1, z0, z1):
    return Pos(x0, y0, z0) * Box(x1 - x0, y1 - y0, z1 - z0, align=LOW)


def carriage(wall, play, arm=10, knob_wide=30, knob_high=15, stem=5, knob_long=20, rack_long=132, rack_wide=20, rack_y=30, rack_end=-73):
    half = arm / 2
    lever = block(stem, stem + knob_long, -knob_wide / 2, knob_wide / 2, -knob_high / 2, knob_high / 2)
    lever += block(rack_end, stem + 1, -half, half, -half, half)
    lever += block(-wall - 8 + play, -wall - play, -15, 15, -20, half)
    lever += block(rack_end - 12, rack_end, -rack_y, rack_y, -half, 0)
    for side in (-1, 1):
        y = side * rack_y
        lever += block(rack_end - rack_long, rack_end, y - rack_wide / 2, y + rack_wide / 2, -half, 0)
    return lever
