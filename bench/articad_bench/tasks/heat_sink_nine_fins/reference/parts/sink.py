from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    width, length, height, base, fin = d["width"], d["length"], d["height"], d["base"], d["fin"]
    fin_count, hole, apart = d["fin_count"], d["hole"], d["apart"]
    shape = Box(width, length, base, align=LOW)
    step = (width - fin) / (fin_count - 1)
    shape += [Pos(-(width - fin) / 2 + i * step, 0, 0) * Box(fin, length, height, align=LOW) for i in range(fin_count)]
    shape -= [Pos(step / 2, y, 0) * Cylinder(hole / 2, 3 * base) for y in (-apart / 2, apart / 2)]
    return shape, {}
