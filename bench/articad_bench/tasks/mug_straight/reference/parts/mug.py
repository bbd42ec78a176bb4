from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, height, wall, grip, reach = d["diameter"], d["height"], d["wall"], d["grip"], d["reach"]
    gap = d["gap"]
    cup = Cylinder(diameter / 2, height, align=LOW)
    outside = Pos(diameter / 2 + (reach - wall) / 2, 0, height / 2) * Box(reach + wall, grip, gap + 2 * grip)
    inside = Pos(diameter / 2 + (reach - wall - 2 * grip) / 2, 0, height / 2) * Box(reach + wall, 2 * grip, gap)
    shape = cup + (outside - inside) - Pos(0, 0, wall) * Cylinder(diameter / 2 - wall, height, align=LOW)

    return shape, {}
