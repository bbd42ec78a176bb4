from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, width, bottom, top, bore = d["length"], d["width"], d["bottom"], d["top"], d["bore"]
    chamber_x, chamber_y, floor = d["chamber_x"], d["chamber_y"], d["floor"]
    shape = Pos(0, 0, bottom) * Box(length, width, top - bottom, align=LOW)
    shape -= Pos(0, 0, floor) * Box(chamber_x, chamber_y, 2 * top, align=LOW)
    shape -= Rot(Y=90) * Cylinder(bore / 2, 2 * length)
    return shape, {"gate": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}, "bonnet": {"o": (0, 0, top), "z": (0, 0, 1), "x": (1, 0, 0)}}
