from build123d import Align, Cylinder, Pos, Sphere


def build(part):
    d = part.dimensions
    r, z = d["ball_radius"], d["ball_z"]
    ball = Pos(0, 0, z) * Sphere(r)
    hole = Cylinder(d["hole_radius"], r + abs(z) + 5, align=(Align.CENTER, Align.CENTER, Align.MAX))
    return ball - hole, {"seat": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
