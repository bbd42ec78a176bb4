import math

from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    width, seat_depth, seat, drop, back, eye = d["width"], d["seat_depth"], d["seat"], d["drop"], d["back"], d["eye"]
    bore_diameter, rod, arm_height = d["bore_diameter"], d["rod"], d["arm_height"]
    shape = Pos(0, 0, -drop) * Box(width, seat_depth, seat, align=LOW)
    shape += Pos(0, seat_depth / 2, -drop) * Box(width, seat, back, align=(Align.CENTER, Align.MAX, Align.MIN))
    for x in (-width / 2 + 30, width / 2 - 30):
        shape += Pos(x, 0, -drop + arm_height) * Box(60, seat_depth, 30, align=LOW)
        shape += Pos(x, -seat_depth / 2 + 30, -drop) * Box(50, 50, arm_height + 10, align=LOW)
        for y in (-seat_depth / 2 + 60, seat_depth / 2 - 60):
            lean, length = math.degrees(math.atan2(y, drop - seat)), math.hypot(y, drop - seat)
            shape += Pos(x, y, -drop + seat) * Rot(X=lean) * Cylinder(rod / 2, length, align=LOW)
        shape += Pos(x, 0, 0) * Rot(Y=90) * Cylinder(eye / 2, 40)
    shape -= Rot(Y=90) * Cylinder(bore_diameter / 2, 2 * width)
    return shape, {
        "eyes": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
