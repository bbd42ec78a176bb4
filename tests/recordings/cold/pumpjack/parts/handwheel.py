from math import cos, radians, sin

from build123d import Align, Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    t, c = d["thickness"], d["hole_circle"]
    shape = Rot(X=-90) * Cylinder(d["radius"], t, align=(Align.CENTER, Align.CENTER, Align.MIN))
    shape -= Pos(0, t / 2, 0) * Rot(X=-90) * Cylinder(d["bore_radius"], t + 2)
    for angle in (0, 90, 180, 270):
        a = radians(angle)
        shape -= Pos(c * cos(a), t / 2, c * sin(a)) * Rot(X=-90) * Cylinder(d["hole_radius"], t + 2)
    return shape, {"seat": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)}}
