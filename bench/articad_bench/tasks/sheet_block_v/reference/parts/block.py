import math

from build123d import Align, Box, Cylinder, Plane, Polygon, Pos, Rot, extrude

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    length, width, height, v_width, v_angle_deg, relief_width = d["length"], d["width"], d["height"], d["v_width"], d["v_angle_deg"], d["relief_width"]
    relief_depth, groove_height, groove_width, groove_depth, tapped_diameter, tapped_depth = d["relief_depth"], d["groove_height"], d["groove_width"], d["groove_depth"], d["tapped_diameter"], d["tapped_depth"]
    shape = Box(length, width, height, align=LOW)
    deep = v_width / 2 / math.tan(math.radians(v_angle_deg / 2))
    notch = Polygon((-v_width / 2, height), (0, height - deep), (v_width / 2, height), align=None)
    shape -= Pos(-length, 0, 0) * extrude(Plane.YZ * notch, 2 * length)
    shape -= Pos(0, 0, height) * Box(2 * length, relief_width, relief_depth, align=HIGH)
    for side in (-1, 1):
        shape -= Pos(0, side * (width / 2 - groove_depth / 2), groove_height + groove_width / 2) * Box(2 * length, groove_depth, groove_width)
    shape -= Pos(length / 2, 20, 14) * Rot(Y=-90) * Cylinder(tapped_diameter / 2, tapped_depth, align=LOW)
    return shape, {
        "groove": {"o": (0, 0, groove_height), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
