import math

from build123d import Line, ThreePointArc, extrude, make_face


def outline(big, small, dist, s, c):
    return make_face([
        Line((c * big, s * big), (c * small, dist + s * small)),
        ThreePointArc((c * small, dist + s * small), (0, dist + small), (-c * small, dist + s * small)),
        Line((-c * small, dist + s * small), (-c * big, s * big)),
        ThreePointArc((-c * big, s * big), (0, -big), (c * big, s * big)),
    ])


def build(part):
    d = part.dimensions
    big, small, dist, t = d["large_radius"], d["small_radius"], d["distance"], d["thickness"]
    s = (big - small) / dist
    c = math.sqrt(1 - s * s)
    outer = extrude(outline(big + t, small + t, dist, s, c), amount=d["height"] / 2, both=True)
    inner = extrude(outline(big, small, dist, s, c), amount=d["height"] / 2 + 1, both=True)
    return outer - inner, {"loop": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
