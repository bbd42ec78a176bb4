from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    width, breadth, floor, top, back = d["width"], d["breadth"], d["floor"], d["top"], d["back"]
    bore = d["bore"]
    shape = Pos(back + width / 2, 0, floor) * Box(width, breadth, top - floor, align=LOW)
    shape -= Rot(Y=90) * Cylinder(bore / 2, 8 * breadth)
    return shape, {"shaft": {"o": (back, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
