from build123d import Align, Box, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Box(d["length"], d["track"] - 1, 15, align=LOW) - Cylinder(d["pin"] + d["clearance"], 50)
    return body, {"shoe": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}, "track": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
