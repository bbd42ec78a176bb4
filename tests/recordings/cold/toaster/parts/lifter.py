from build123d import *

BOTTOM = (Align.CENTER, Align.CENTER, Align.MIN)
CORNER = (Align.MIN, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    cl, ch = d["carriage_length"], d["carriage_height"]
    start, end, n = d["rest_start"], d["rest_end"], d["rib_count"]
    step = (end - start - d["rib_thickness"]) / (n - 1)
    shape = Box(cl, d["carriage_width"], ch, align=BOTTOM)
    for s in (-1, 1):
        y = s * d["arm_y"]
        shape += Pos(start, y, 0) * Box(-cl / 2 + 1 - start, d["arm_width"], d["arm_height"], align=CORNER)
        for i in range(n):
            shape += Pos(start + i * step, y, d["arm_height"] - d["rib_height"]) * Box(
                d["rib_thickness"], d["rib_width"], d["rib_height"], align=CORNER)
    for s in (-1, 1):
        shape -= Pos(0, s * d["rod_y"], -1) * Cylinder(d["bore_radius"], ch + 2, align=BOTTOM)
    shape -= Pos(cl / 2 - d["socket_depth"], 0, ch / 2) * Rot(Y=90) * Cylinder(
        d["socket_radius"], d["socket_depth"] + 1, align=BOTTOM)
    return shape, {
        "slide": {"o": (0, 0, 0), "z": (0, 0, -1), "x": (1, 0, 0)},
        "lever_socket": {"o": (cl / 2, 0, ch / 2), "z": (1, 0, 0), "x": (0, 0, 1)},
    }
