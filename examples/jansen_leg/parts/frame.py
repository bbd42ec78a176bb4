from build123d import Align, Box, Cylinder, Pos, Rot

CORNER = (Align.MIN, Align.MIN, Align.MIN)
LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FORWARD = Rot(X=90)  # turns +Z to -Y


def build(part):
    d = part.dimensions
    board, left, right, floor, play = d["board"], d["left"], d["right"], d["floor"], d["play"]
    frame = Pos(left, 0, floor) * Box(right - left, board, d["top"] - floor, align=CORNER)
    foot = Box(right - d["foot_left"], d["foot_depth"], d["foot_height"], align=CORNER)
    frame += Pos(d["foot_left"], (board - d["foot_depth"]) / 2, floor - d["foot_height"]) * foot
    frame -= FORWARD * Cylinder(d["shaft_radius"] + d["clearance"], 4 * board)

    pivot = Pos(d["pivot_x"], 0, d["pivot_z"])
    frame += pivot * FORWARD * Cylinder(d["pin_radius"], d["pin_length"], align=LOW)
    frame += pivot * FORWARD * Cylinder(d["spigot_radius"], d["pin_length"] + d["spigot_length"], align=LOW)
    forward = {"z": (0, -1, 0), "x": (1, 0, 0)}
    x, z = d["pivot_x"], d["pivot_z"]
    return frame, {
        "crank": {"o": (0, -play / 2, 0), **forward},
        "pivot_c": {"o": (x, -play / 2, z), **forward},
        "pivot_upper": {"o": (x, -play / 2 - d["level"], z), **forward},
        "cap": {"o": (x, -d["pin_length"], z), "z": (0, -1, 0)},
    }
