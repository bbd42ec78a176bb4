from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, -d["play"]) * Cylinder(d["case_r"], d["board"], align=HIGH)
    for i in range(5):
        shape += Rot(Z=90 + 72 * i) * (Pos(d["near"], 0, d["wm"]) * Rot(Y=90) * Cylinder(d["bore_r"] + d["wall"], d["far"] - d["near"], align=LOW) + Pos(d["far"] / 2, 0, -d["play"]) * Box(d["far"], d["rib"], d["board"], align=HIGH) + Pos(d["far"] - 6, 0, -d["play"] - d["board"]) * Box(12, d["rib"], d["wm"] - d["bore_r"] + d["play"] + d["board"], align=LOW) + Pos(d["near"] + 8, 0, -d["play"] - d["board"]) * Box(12, d["rib"], d["wm"] - d["bore_r"] + d["play"] + d["board"], align=LOW))
    for i in range(5):
        shape -= Rot(Z=90 + 72 * i) * (Pos(d["near"] - 1, 0, d["wm"]) * Rot(Y=90) * Cylinder(d["bore_r"], 2 * d["far"], align=LOW) + Pos(d["near"], 0, d["wm"]) * Box(2 * d["notch"], 4 * d["bore_r"], d["notch_w"]))
    shape -= Cylinder(d["shaft_r"], 100)
    return FRONT * shape, {
        "shaft": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "cylinder_1": {"o": (0, -d["wm"], 0), "z": (0.0, 0, 1.0), "x": (0, -1, 0)},
        "cylinder_2": {"o": (0, -d["wm"], 0), "z": (-0.951056516295, 0, 0.309016994375), "x": (0, -1, 0)},
        "cylinder_3": {"o": (0, -d["wm"], 0), "z": (-0.587785252292, 0, -0.809016994375), "x": (0, -1, 0)},
        "cylinder_4": {"o": (0, -d["wm"], 0), "z": (0.587785252292, 0, -0.809016994375), "x": (0, -1, 0)},
        "cylinder_5": {"o": (0, -d["wm"], 0), "z": (0.951056516295, 0, 0.309016994375), "x": (0, -1, 0)},
    }
