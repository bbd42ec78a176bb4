from build123d import Plane, Polygon, extrude


def build(part):
    d = part.dimensions
    out, up, thickness = d["out"], d["up"], d["thickness"]
    corner = Plane.XZ * Polygon((0, 0), (out, 0), (0, up), align=None)
    shape = extrude(corner, thickness / 2, both=True)
    return shape, {"column": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
