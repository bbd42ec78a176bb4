from build123d import Align, Box, Plane, Polygon, extrude

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, width, thickness, neck, head = d["length"], d["width"], d["thickness"], d["neck"], d["head"]
    rise = d["rise"]
    shape = Box(length, width, thickness, align=LOW)
    tail = Plane.YZ * Polygon((-neck / 2, thickness), (neck / 2, thickness), (head / 2, thickness + rise), (-head / 2, thickness + rise), align=None)
    shape += extrude(tail, length / 2, both=True)
    return shape, {"saddle": {"o": (0, 0, thickness), "z": (1, 0, 0), "x": (0, 1, 0)}}
