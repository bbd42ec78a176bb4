"""A transition from a square below to a circle above

Shows: loft, Rectangle, Circle, Plane
Dimensions: {"side": 40, "radius": 10, "height": 30}
"""

from build123d import Circle, Plane, Rectangle, loft


def build(part):
    d = part.dimensions
    shape = loft([Plane.XY * Rectangle(d["side"], d["side"]), Plane.XY.offset(d["height"]) * Circle(d["radius"])])
    return shape, {"mount": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
