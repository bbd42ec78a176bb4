from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    width, leg, thickness, foot_height, foot_length, total_height = d["width"], d["leg"], d["thickness"], d["foot_height"], d["foot_length"], d["total_height"]
    bridge, boss_diameter, boss_height, thread_diameter = d["bridge"], d["boss_diameter"], d["boss_height"], d["thread_diameter"]
    shape = Box(thickness, width + 2 * leg, total_height, align=LOW)
    shape -= Box(2 * thickness, width, total_height - bridge, align=LOW)
    for side in (-1, 1):
        shape += Pos(0, side * (width / 2 - foot_length / 2), 0) * Box(thickness, foot_length, foot_height, align=LOW)
    shape += Pos(0, 0, total_height) * Cylinder(boss_diameter / 2, boss_height, align=LOW)
    shape -= Pos(0, 0, total_height) * Cylinder(thread_diameter / 2, 4 * bridge)
    return shape, {
        "feet": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "thread": {"o": (0, 0, total_height+boss_height), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
