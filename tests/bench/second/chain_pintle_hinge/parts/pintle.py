from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    width, height, thickness, hole, hole_x = d["width"], d["height"], d["thickness"], d["hole"], d["hole_x"]
    hole_z, out, shelf, boss, pin = d["hole_z"], d["out"], d["shelf"], d["boss"], d["pin"]
    pin_height = d["pin_height"]
    shape = Pos(0, -thickness / 2, 0) * Box(width, thickness, height)
    shape += Pos(0, -out / 2, 0) * Box(0.8 * boss, out, shelf, align=HIGH) + Pos(0, -out, 0) * Cylinder(boss / 2, shelf, align=HIGH)
    shape += Pos(0, -out, 0) * Cylinder(pin / 2, pin_height, align=LOW)
    shape -= [Pos(x, 0, z) * Rot(X=90) * Cylinder(hole / 2, 4 * thickness) for x in (-hole_x, hole_x) for z in (-hole_z, hole_z)]
    return shape, {"strap": {"o": (0, -out, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
