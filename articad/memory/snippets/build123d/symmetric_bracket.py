"""One half of a bracket, mirrored to the whole, with holes for screws

Shows: mirror, CounterBoreHole, Cylinder
Dimensions: {"half": 25, "depth": 20, "thickness": 5, "wall": 18, "hole": 2.2, "head": 4, "sink": 2.5}
"""

from build123d import Align, Box, Cylinder, Plane, Pos, mirror

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    half = Box(d["half"], d["depth"], d["thickness"], align=(Align.MIN, Align.CENTER, Align.MIN))
    half += Pos(d["half"], 0, 0) * Box(d["thickness"], d["depth"], d["wall"], align=(Align.MIN, Align.CENTER, Align.MIN))
    screw = Pos(0, 0, -1) * Cylinder(d["hole"], d["thickness"] + 2, align=UP)
    screw += Pos(0, 0, d["thickness"] - d["sink"]) * Cylinder(d["head"], d["sink"] + 1, align=UP)
    half -= Pos(d["half"] / 2, 0, 0) * screw
    shape = half + mirror(half, about=Plane.YZ)
    return shape, {"mount": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
