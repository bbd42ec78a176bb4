"""A flange with a bore and equal holes on a bolt circle

Shows: PolarLocations, Cylinder, fillet
Dimensions: {"radius": 40, "thickness": 8, "bore": 12, "circle": 28, "hole": 3, "hole_count": 6, "edge": 1.5}
"""

from build123d import Align, Axis, Cylinder, PolarLocations, Pos, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    shape = Cylinder(d["radius"], d["thickness"], align=UP)
    shape = fillet(shape.edges().sort_by(Axis.Z)[-1:], radius=d["edge"])
    drill = Pos(0, 0, -1) * Cylinder(d["hole"], d["thickness"] + 2, align=UP)
    shape -= Pos(0, 0, -1) * Cylinder(d["bore"], d["thickness"] + 2, align=UP)
    shape -= [place * drill for place in PolarLocations(d["circle"], d["hole_count"])]
    return shape, {"mount": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
