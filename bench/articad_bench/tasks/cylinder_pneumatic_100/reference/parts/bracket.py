from build123d import Align, Box, Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    foot_x, plate, height, width, ear = d["foot_x"], d["plate"], d["height"], d["width"], d["ear"]
    ear_thickness, inside, pin = d["ear_thickness"], d["inside"], d["pin"]
    shape = Pos(-foot_x, 0, 0) * Box(plate, width, height, align=(Align.MIN, Align.CENTER, Align.CENTER))
    for side in (-1, 1):
        y = side * (inside + ear_thickness) / 2
        shape += Pos(-foot_x / 2, y, 0) * Box(foot_x, ear_thickness, 2 * ear) + Pos(0, y, 0) * Rot(X=90) * Cylinder(ear, ear_thickness)
    shape += Rot(X=90) * Cylinder(pin / 2, inside + 2 * ear_thickness)
    return shape, {"barrel": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)}}
