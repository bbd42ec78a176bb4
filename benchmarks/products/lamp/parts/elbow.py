from build123d import Circle, Plane, Pos, extrude, make_hull


def build(part):
    d = part.dimensions
    ends = ((0, 0), (d.p, 0), (d.p / 2, d.ez), (d.p / 2, d.ez + d.p))
    edges = [edge for x, z in ends for edge in (Pos(x, z) * Circle(d.eye)).edges()]
    return part.made(extrude(Plane.XZ * make_hull(edges), d.t / 2, both=True))
