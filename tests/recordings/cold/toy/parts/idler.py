import math

from build123d import Cylinder, Plane, Polyline, Rot, extrude, make_face


def gear(d, first_deg):
    """Spur gear round the X axis; the first tooth's middle at first_deg from +Y."""
    m, n, play = d["gear_module"], d["teeth_count"], d["tooth_play_deg"]
    pressure = math.radians(20)
    rp = m * n / 2
    tip, root = rp + m, rp - 1.25 * m
    rb = rp * math.cos(pressure)

    def v(a):
        return math.degrees(math.tan(a) - a)

    def half(r):
        return 90 / n + v(pressure) - v(math.acos(min(1.0, rb / r))) - play

    low = max(rb, root)
    steps = 5
    radii = [low + (tip - low) * i / steps for i in range(steps + 1)]
    flank = [(r, half(r)) for r in radii]
    if root < low:
        flank.insert(0, (root, half(low)))
    pts = []
    for k in range(n):
        mid = first_deg + 360 * k / n
        polar = [(r, mid - a) for r, a in flank] + [(r, mid + a) for r, a in reversed(flank)]
        for r, a in polar:
            pts.append((r * math.cos(math.radians(a)), r * math.sin(math.radians(a))))
    face = make_face(Polyline(*pts, close=True))
    return extrude(Plane.YZ * face, amount=d["gear_width"] / 2, both=True)


def build(part):
    d = part.dimensions
    shape = gear(d, 180 / d["teeth_count"])
    shape = shape + Rot(Y=90) * Cylinder(d["hub_radius"], d["hub_length"])
    shape = shape + Rot(Y=90) * Cylinder(d["shaft_radius"], d["shaft_length"])
    return shape, {"axis": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 0, 1)}}
