from math import acos, cos, degrees, pi, radians, sin, tan

from build123d import Align, Box, Cylinder, Plane, Polygon, Pos, Rot, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def involute(angle):
    return degrees(tan(angle)) - degrees(angle)


def build(part):
    d = part.dimensions
    m, n = d["module"], d["tooth_count"]
    rp = m * n / 2
    tip, root, rb = rp + m, rp - 1.25 * m, rp * cos(radians(20))

    def half(r):
        return 90 / n + involute(radians(20)) - involute(acos(min(1.0, rb / r))) - 3 / n

    def at(r, deg):  # angle from +Z towards +X; local (x, z)
        return (r * sin(radians(deg)), r * cos(radians(deg)))

    start = max(rb, root)
    steps = 8
    radii = [start + (tip - start) * i / steps for i in range(steps + 1)]
    inner = root - 0.3 * m
    side = [(inner, half(start))] + [(r, half(r)) for r in radii]
    shape = Rot(X=90) * Cylinder(root, d["face"])
    for i in range(n):
        mid = i * 360 / n
        pts = [at(r, mid - h) for r, h in side] + [at(tip, mid)] + [at(r, mid + h) for r, h in reversed(side)]
        shape += extrude(Plane.XZ * Polygon(*pts, align=None), amount=d["face"] / 2, both=True)
    shape += Rot(X=90) * Cylinder(d["collar_radius"], 2 * d["collar_end"])
    shape += Rot(X=90) * Cylinder(d["journal_radius"], d["journal_end"], align=UP)
    shape += Rot(X=-90) * Cylinder(d["shaft_radius"], d["shaft_end"], align=UP)
    rs = d["shaft_radius"]
    shape -= Pos(0, d["shaft_end"] - d["flat_length"], d["flat_z"]) * Box(
        2 * rs + 2, d["flat_length"] + 1, rs, align=(Align.CENTER, Align.MIN, Align.MIN))
    c = part.connectors["axis"]
    return shape, {"axis": {"o": (0, 0, 0), "z": c.z, "x": c.x}}
