from math import radians, tan

from build123d import Align, Cone, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    shank, shank_length, base, cone_deg = d["shank"], d["shank_length"], d["base"], d["cone_deg"]
    shape = Cylinder(shank / 2, shank_length, align=HIGH) + Cone(base / 2, 0.5, (base / 2 - 0.5) / tan(radians(cone_deg / 2)), align=LOW)
    return shape, {"quill": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (0, 1, 0)}}
