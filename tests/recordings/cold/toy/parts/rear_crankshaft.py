import math

from build123d import Cylinder, Plane, Polyline, Pos, Rot, extrude, make_face


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
    dx, dt, c, end = d["disc_x"], d["disc_t"], d["crank"], d["pin_end"]
    root = dx + dt / 2  # shaft and pins are rooted in the discs
    shape = gear(d, 0) + Rot(Y=90) * Cylinder(d["shaft_radius"], 2 * root)
    for side in (-1, 1):
        shape = shape + Pos(side * root, 0, 0) * Rot(Y=90) * Cylinder(d["disc_radius"], dt)
        shape = shape + Pos(side * (root + end) / 2, side * c, 0) * Rot(Y=90) * Cylinder(
            d["crank_pin_radius"], end - root)
    x = (0, 0, 1)
    return shape, {
        "axis": {"o": (0, 0, 0), "z": (1, 0, 0), "x": x},
        "pin_right": {"o": (d["leg_x"], c, 0), "z": (1, 0, 0), "x": x},
        "pin_left": {"o": (-d["leg_x"], -c, 0), "z": (-1, 0, 0), "x": x},
        "hand_seat": {"o": (d["arm_x"], c, 0), "z": (1, 0, 0), "x": x},
    }
