from build123d import Circle, Plane, Pos, extrude, make_hull


def build(part):
    d = part.dimensions

    def bar(*ends):
        edges = [edge for x, z in ends for edge in (Pos(x, z) * Circle(d.eye)).edges()]
        return extrude(Plane.XZ * make_hull(edges), d.t / 2, both=True)

    return part.made(bar((0, 0), (0, d.p)) + bar((0, 0), (d.out, -d.down)))
