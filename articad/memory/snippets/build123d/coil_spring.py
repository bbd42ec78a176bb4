"""A coil spring: a circle swept along a helix

Shows: Helix, sweep
Dimensions: {"pitch": 6, "height": 30, "radius": 10, "wire": 1.2}
"""

from build123d import Circle, Helix, Plane, sweep


def build(part):
    d = part.dimensions
    path = Helix(d["pitch"], d["height"], d["radius"])
    shape = sweep(Plane(origin=path @ 0, z_dir=path % 0) * Circle(d["wire"]), path=path)
    return shape, {"mount": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
