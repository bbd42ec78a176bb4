"""A handle of round wire: a circle swept along a bent path

Shows: sweep, FilletPolyline, Plane
Dimensions: {"span": 60, "reach": 25, "bend": 8, "radius": 3}
"""

from build123d import Circle, FilletPolyline, Plane, sweep


def build(part):
    d = part.dimensions
    half = d["span"] / 2
    path = FilletPolyline((-half, 0, 0), (-half, 0, d["reach"]), (half, 0, d["reach"]), (half, 0, 0), radius=d["bend"])
    shape = sweep(Plane(origin=path @ 0, z_dir=path % 0) * Circle(d["radius"]), path=path)
    return shape, {"mount": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
