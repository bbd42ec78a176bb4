from build123d import Align, Axis, Box, Cylinder, Pos, Rot, Sphere, fillet


def build(part):
    d = part.dimensions
    w, l, h, wall = d["width"], d["length"], d["height"], d["wall"]
    up = (Align.CENTER, Align.CENTER, Align.MIN)
    shape = Box(w, l, h, align=up)
    shape = fillet(shape.edges().group_by(Axis.Z)[-1], radius=d["edge_radius"])
    shape = shape + Pos(0, -d["head_y"], d["head_z"]) * Sphere(d["head_radius"])
    for side in (-1, 1):
        shape = shape + Pos(side * d["eye_x"], -d["head_y"] - d["eye_forward"],
                            d["head_z"] + d["eye_up"]) * Sphere(d["eye_radius"])
    py, pz, end = d["pivot_y"], d["pivot_z"], d["pin_end"]
    start = w / 2 - wall / 2
    for side in (-1, 1):
        for y in (-py, py):
            shape = shape + Pos(side * (start + end) / 2, y, pz) * Rot(Y=90) * Cylinder(
                d["pin_radius"], end - start)
    shape = shape - Pos(0, 0, -1) * Box(w - 2 * wall, l - 2 * wall, h - wall + 1, align=up)
    s = d["shaft_y"]
    for y in (-s, 0, s):
        shape = shape - Pos(0, y, 0) * Rot(Y=90) * Cylinder(d["notch_radius"], w + 2)
    x = (0, 0, 1)
    return shape, {
        "rim": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "pivot_rear_right": {"o": (end, py, pz), "z": (1, 0, 0), "x": x},
        "pivot_front_right": {"o": (end, -py, pz), "z": (1, 0, 0), "x": x},
        "pivot_rear_left": {"o": (-end, py, pz), "z": (-1, 0, 0), "x": x},
        "pivot_front_left": {"o": (-end, -py, pz), "z": (-1, 0, 0), "x": x},
    }
